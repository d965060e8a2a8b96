// Adaptive schemes: accuracy follows the tolerance; looking into a step changes nothing.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "../../validation/schemes/problems.hpp"
#include "carom/integrators/make_stepper.hpp"
#include "steppers.hpp"

namespace carom {
namespace {

using problems::CoulombParticles;
using problems::HenonHeiles;
using problems::Problem;

/// Hénon–Heiles as a law of its own.
struct HenonHeilesLaw : ForceLaw<double> {
  void accelerations(std::span<const geometry::Vector> x,
                     std::span<geometry::Vector> a) const override {
    problem.accelerations(x, a);
  }
  std::span<const double> masses() const override { return problem.masses(); }
  double potential_energy(std::span<const geometry::Vector> x) const override {
    return problem.potential(x);
  }
  HenonHeiles<double> problem{"0"};
};

class Adaptive : public testing::TestWithParam<std::string> {
 protected:
  static std::unique_ptr<Stepper<double>> stepper(const Problem<double>& problem,
                                                  double tolerance) {
    IntegratorPlan plan;
    plan.scheme = GetParam();
    plan.tolerance = tolerance;
    return make_stepper(plan, problem, problem.omega);
  }
  static Phase<double> until(Stepper<double>& s, const Problem<double>& problem, double time) {
    Phase<double> phase = problem.start, next;
    for (double t = 0.0; t < time;) {
      t += s.step(phase, time - t, next);
      std::swap(phase, next);
    }
    return phase;
  }
};

TEST_P(Adaptive, ErrorFollowsTheTolerance) {
  for (const char* omega : {"0", "1.5"}) {
    const CoulombParticles<double> problem(omega);
    const auto fine = stepper_of<double>(find_scheme("kahan-li-8"), problem, problem.omega);
    const Phase<double> truth = walk(*fine, problem.start, 1.0 / 128, 10 * 128);
    double previous = 1.0;
    for (const double tolerance : {1e-6, 1e-8, 1e-10, 1e-12}) {
      const double error = distance(until(*stepper(problem, tolerance), problem, 10.0), truth);
      EXPECT_LT(error, 200 * tolerance) << omega;
      EXPECT_LT(error, previous / 5) << omega;
      previous = error;
    }
  }
}

TEST_P(Adaptive, ParallelsOfOneMotionAreAlike) {
  // The same motion on a larger scale takes the same steps: no length is built in.
  struct Scaled final : ForceLaw<double> {
    explicit Scaled(double factor) : scale(factor) {}
    void accelerations(std::span<const geometry::Vector> x,
                       std::span<geometry::Vector> a) const override {
      const std::vector<geometry::Vector> unit{(1.0 / scale) * x[0]};
      law.accelerations(unit, a);
      a[0] = scale * a[0];
    }
    double scale;
    HenonHeiles<double> law{"0"};
  };
  std::vector<long> counts;
  for (const double scale : {1.0, 0x1p-40, 0x1p40}) {
    const Scaled law(scale);
    const std::vector<double> omega{0.0};
    const auto s = make_stepper(IntegratorPlan{.scheme = GetParam()}, law, omega);
    Phase<double> phase{{scale * law.law.start.position[0]}, {scale * law.law.start.velocity[0]}},
        next;
    for (double t = 0.0; t < 5.0;) {
      t += s->step(phase, 5.0 - t, next);
      std::swap(phase, next);
    }
    counts.push_back(law.law.evaluations);
  }
  EXPECT_EQ(counts[1], counts[0]);
  EXPECT_EQ(counts[2], counts[0]);
}

TEST_P(Adaptive, LookingIntoStepsChangesNothing) {
  const CoulombParticles<double> problem("1.5");
  const auto alone = stepper(problem, 1e-10), watched = stepper(problem, 1e-10);
  Phase<double> a = problem.start, b = problem.start, next_a, next_b, seen, again;
  const double far = std::numeric_limits<double>::max();
  for (int k = 0; k < 100; ++k) {
    const double duration = alone->step(a, far, next_a);
    ASSERT_GT(duration, 0.0);
    ASSERT_EQ(watched->step(b, far, next_b), duration);
    for (const double part : {0.3, 0.9999, 0.01}) {
      ASSERT_EQ(watched->step(b, part * duration, seen), part * duration);
      ASSERT_EQ(alone->step(a, part * duration, again), part * duration);
      ASSERT_TRUE(distance(seen, again) == 0.0);
    }
    ASSERT_EQ(watched->step(b, far, seen), duration);
    ASSERT_TRUE(distance(seen, next_b) == 0.0);
    ASSERT_TRUE(distance(next_a, next_b) == 0.0) << k;
    std::swap(a, next_a);
    std::swap(b, next_b);
  }
}

TEST_P(Adaptive, PathWithinAStepIsTheMotion) {
  const HenonHeiles<double> problem("1.5");
  const auto s = stepper(problem, 1e-11);
  const auto fine = stepper_of<double>(find_scheme("kahan-li-8"), problem, problem.omega);
  Phase<double> phase = problem.start, next, part;
  for (int k = 0; k < 50; ++k) {
    const double duration = s->step(phase, 100.0, next);
    for (const double share : {0.25, 0.5, 0.75}) {
      s->step(phase, share * duration, part);
      EXPECT_LT(distance(part, walk(*fine, phase, share * duration / 16, 16)), 2e-9);
    }
    std::swap(phase, next);
  }
}

TEST_P(Adaptive, TinyPartsAndStepsAreTaken) {
  // A hit just after a step's start, or the clock's next multiple just ahead.
  const CoulombParticles<double> problem("1.5");
  for (const double tiny : {1e-8, 1e-17, 1e-30, 1e-300}) {
    const auto s = stepper(problem, 1e-10);
    Phase<double> phase = problem.start, next, part;
    for (int k = 0; k < 3; ++k) {
      const double duration = s->step(phase, 1.0, next);
      ASSERT_EQ(s->step(phase, tiny * duration, part), tiny * duration);
      EXPECT_LT(distance(part, phase), 10 * tiny * duration + 1e-15);
      std::swap(phase, next);
      ASSERT_EQ(s->step(phase, tiny, next), tiny);
      EXPECT_LT(distance(phase, next), 10 * tiny + 1e-15);
      std::swap(phase, next);
    }
    double t = 0.0;
    int steps = 0;
    for (; t < 1.0 && steps < 1000; ++steps) {  // the tiny one has not made the next ones so
      t += s->step(phase, 1.0 - t, next);
      std::swap(phase, next);
    }
    EXPECT_EQ(t, 1.0);
  }
}

TEST_P(Adaptive, StepsDoNotGrowOverTheNextForce) {
  // Nothing acts between soft walls at |x| = 1: the error control alone would jump over them.
  struct SoftBox final : ForceLaw<double> {
    void accelerations(std::span<const geometry::Vector> x,
                       std::span<geometry::Vector> a) const override {
      const double beyond = std::max(std::fabs(x[0].x) - 1.0, 0.0);
      a[0] = {-std::copysign(100.0 * beyond * beyond * beyond, x[0].x), 0.0};
    }
  } law;
  const std::vector<double> omega{0.0};
  const auto s = make_stepper(IntegratorPlan{.scheme = GetParam(), .tolerance = 1e-9}, law, omega);
  Phase<double> phase{{{0.1, 0.0}}, {{1.0, 0.0}}}, next;
  for (double t = 0.0; t < 100.0;) {
    t += s->step(phase, std::numeric_limits<double>::max(), next);
    std::swap(phase, next);
    ASSERT_LT(std::fabs(phase.position[0].x), 2.0) << t;
  }
}

TEST_P(Adaptive, RestMovesOn) {
  const HenonHeiles<double> problem("0");
  const auto s = stepper(problem, 1e-10);
  Phase<double> rest{{{0.0, 0.0}}, {{0.0, 0.0}}}, next;  // the bottom: nothing moves, but time does
  double t = 0.0;
  int steps = 0;
  for (; t < 10.0 && steps < 10000; ++steps) {
    t += s->step(rest, 10.0 - t, next);
    std::swap(rest, next);
  }
  EXPECT_EQ(t, 10.0);
  EXPECT_EQ(rest.position[0].x, 0.0);
}

TEST_P(Adaptive, NotANumberIsSeenAndErrorsOfTheLawGetThrough) {
  struct Bad final : ForceLaw<double> {
    void accelerations(std::span<const geometry::Vector>,
                       std::span<geometry::Vector> a) const override {
      if (throws) throw std::runtime_error("law");
      a[0] = {std::nan(""), 0.0};
    }
    bool throws = false;
  } law;
  const std::vector<double> omega{0.0};
  Phase<double> from{{{0.1, 0.2}}, {{1.0, 0.0}}}, to;
  const auto s = make_stepper({.scheme = GetParam(), .tolerance = 1e-10}, law, omega);
  for (int k = 0; k < 2; ++k) {
    EXPECT_GT(s->step(from, 1.0, to), 0.0);
    EXPECT_TRUE(std::isnan(to.position[0].x));
  }
  law.throws = true;
  from.position[0].x = 0.2;
  EXPECT_THROW(s->step(from, 1.0, to), std::runtime_error);
}

/// One particle of mass 1 without magnetic field in V, over a given time.
struct Ride {
  double time = 0.0, energy_error = 0.0;
  Phase<double> end;
  std::string failure;
  std::vector<double> steps;
};

Ride ride(const std::string& scheme, const ForceLaw<double>& law, Phase<double> phase, double until,
          double tolerance, long most = 1'000'000) {
  const std::vector<double> omega{0.0};
  const auto s = make_stepper({.scheme = scheme, .tolerance = tolerance}, law, omega);
  const auto energy = [&](const Phase<double>& p) {
    return law.potential_energy(p.position) + 0.5 * dot(p.velocity[0], p.velocity[0]);
  };
  const double before = energy(phase);
  Ride r;
  for (long k = 0; r.time < until && k < most; ++k) {
    Phase<double> next;
    const double duration = s->step(phase, until - r.time, next);
    r.failure = s->failure();
    if (!r.failure.empty()) break;
    r.steps.push_back(duration);
    r.time += duration;
    r.energy_error = std::max(r.energy_error, std::fabs(energy(next) - before));
    phase = next;
  }
  r.end = phase;
  return r;
}

/// A law of one particle that knows its potential, and may know a longest step.
struct OneParticle : ForceLaw<double> {
  std::span<const double> masses() const override { return mass; }
  std::vector<double> mass{1.0};
};

/// height exp(-r^2/(2 width^2)) about the origin.
struct Bump : OneParticle {
  Bump(double h, double w) : height(h), width(w) {}
  void accelerations(std::span<const geometry::Vector> x,
                     std::span<geometry::Vector> a) const override {
    a[0] = (potential_energy(x) / (width * width)) * x[0];
  }
  double potential_energy(std::span<const geometry::Vector> x) const override {
    return height * std::exp(-dot(x[0], x[0]) / (2.0 * width * width));
  }
  double height, width;
};

/// As `Bump`; no step may lead through more than a width of it.
struct KnownBump : Bump {
  using Bump::Bump;
  double longest_step(const Phase<double>& from, const double& asked) const override {
    const double distance = std::sqrt(dot(from.position[0], from.position[0]));
    const double speed = std::sqrt(dot(from.velocity[0], from.velocity[0]) + 2.0 * height);
    return std::min(asked, std::max(distance - 9.0 * width, width) / speed);
  }
};

TEST_P(Adaptive, NoStepEndsInABumpThatItsStagesMissed) {
  // Energies were off by thousands where a step ended on such a bump.
  const Bump bump(50.0, 0.03);
  for (int k = 0; k < 200; ++k) {
    const double far = 0.4 + 0.01 * k;
    const Ride r = ride(GetParam(), bump, {{{-far, 0.01}}, {{1.0, 0.0}}}, 2.0 * far, 1e-12);
    EXPECT_EQ(r.failure, "") << far;
    EXPECT_LT(r.energy_error, 1e-8) << far;
  }
}

TEST_P(Adaptive, TheLongestStepIsKept) {
  struct Limited final : HenonHeilesLaw {
    double longest_step(const Phase<double>&, const double& asked) const override {
      return std::min(asked, 0.01);
    }
  } limited;
  const HenonHeilesLaw free;
  const Phase<double> start = HenonHeiles<double>("0").start;
  const Ride a = ride(GetParam(), free, start, 20.0, 1e-8),
             b = ride(GetParam(), limited, start, 20.0, 1e-8);
  EXPECT_GT(*std::max_element(a.steps.begin(), a.steps.end()), 0.02);
  EXPECT_LE(*std::max_element(b.steps.begin(), b.steps.end()), 0.01 * (1.0 + 1e-12));
  EXPECT_LT(b.steps.size(), 2100U);  // steps stay as long as they may be
  EXPECT_LT(distance(a.end, b.end), 2e-6);
}

TEST_P(Adaptive, StepsGrowAgainBehindALimit) {
  // Short ones in the middle only.
  struct Limited final : HenonHeilesLaw {
    double longest_step(const Phase<double>& from, const double& asked) const override {
      return std::fabs(from.position[0].x) < 0.05 ? std::min(asked, 0.002) : asked;
    }
  } limited;
  const HenonHeilesLaw free;
  const Phase<double> start = HenonHeiles<double>("0").start;
  const Ride a = ride(GetParam(), free, start, 20.0, 1e-9),
             b = ride(GetParam(), limited, start, 20.0, 1e-9);
  EXPECT_LT(distance(a.end, b.end), 1e-6);
  EXPECT_GT(*std::max_element(b.steps.begin(), b.steps.end()),
            0.5 * *std::max_element(a.steps.begin(), a.steps.end()));
  EXPECT_LT(b.energy_error, 1e-7);
}

TEST_P(Adaptive, NarrowBumpsReflectWhereTheirWidthIsKnown) {
  const KnownBump bump(1000.0, 0.022);
  for (int k = 0; k < 50; ++k) {
    const double far = 0.9 + 0.01 * k;
    const Ride r = ride(GetParam(), bump, {{{-far, 0.0}}, {{1.0, 0.0}}}, 2.0 * far, 1e-12);
    EXPECT_EQ(r.failure, "");
    EXPECT_NEAR(r.end.velocity[0].x, -1.0, 1e-8) << far;
    EXPECT_LT(r.energy_error, 1e-8);
  }
}

TEST_P(Adaptive, PathThroughALimitIsAFunctionOfItsBeginning) {
  const KnownBump bump(1000.0, 0.022);
  const std::vector<double> omega{0.0};
  const IntegratorPlan plan{.scheme = GetParam(), .tolerance = 1e-10};
  const auto alone = make_stepper(plan, bump, omega), watched = make_stepper(plan, bump, omega);
  Phase<double> a{{{-1.0, 0.005}}, {{1.0, 0.0}}}, b = a, next_a, next_b, seen;
  const double far = std::numeric_limits<double>::max();
  for (double t = 0.0; t < 2.0;) {
    const double duration = alone->step(a, far, next_a);
    ASSERT_EQ(watched->step(b, far, next_b), duration);
    for (const double part : {0.3, 0.9999, 0.01})
      ASSERT_EQ(watched->step(b, part * duration, seen), part * duration);
    ASSERT_TRUE(distance(next_a, next_b) == 0.0) << t;
    t += duration;
    std::swap(a, next_a);
    std::swap(b, next_b);
  }
}

TEST_P(Adaptive, AForceThatNoStepResolvesIsAFailure) {
  struct Singular final : HenonHeilesLaw {
    double longest_step(const Phase<double>& from, const double& asked) const override {
      return from.position[0].x > 0.2 ? least : asked;
    }
    double least = 0.0;
  } law;
  const Phase<double> start{{{0.0, 0.0}}, {{0.4, 0.1}}};
  for (const double least : {0.0, 1e-13, std::nan("")}) {
    law.least = least;
    const Ride r = ride(GetParam(), law, start, 20.0, 1e-9);
    EXPECT_NE(r.failure.find("(0."), std::string::npos) << r.failure;
    EXPECT_GT(r.end.position[0].x, 0.2);
    EXPECT_LT(r.time, 2.0);
    // Another start is another matter.
    EXPECT_EQ(ride(GetParam(), law, {{{0.0, 0.0}}, {{0.05, 0.1}}}, 1.0, 1e-9).failure, "");
  }
}

TEST_P(Adaptive, APotentialThatJumpsIsAFailure) {
  // No force says so: the angle about the origin, which jumps by 2 pi.
  struct Angle final : OneParticle {
    void accelerations(std::span<const geometry::Vector> x,
                       std::span<geometry::Vector> a) const override {
      a[0] = (strength / dot(x[0], x[0])) * right(x[0]);
      a[0] = -a[0];
    }
    double potential_energy(std::span<const geometry::Vector> x) const override {
      return -strength * std::atan2(x[0].y, x[0].x);
    }
    double strength = 0.1;
  } law;
  const Ride before = ride(GetParam(), law, {{{-1.0, 0.5}}, {{0.0, -1.0}}}, 0.3, 1e-9);
  EXPECT_EQ(before.failure, "");
  const Ride r = ride(GetParam(), law, {{{-1.0, 0.5}}, {{0.0, -1.0}}}, 2.0, 1e-9);
  EXPECT_NE(r.failure, "");
  EXPECT_GT(r.time, 0.3);
  EXPECT_LT(r.time, 0.7);
  EXPECT_LT(r.energy_error, 1e-7);
}

TEST_P(Adaptive, KinksAndRoundedPotentialsAreNone) {
  struct Kink final : OneParticle {
    void accelerations(std::span<const geometry::Vector> x,
                       std::span<geometry::Vector> a) const override {
      a[0] = {x[0].x > 0.0 ? -1.0 : 1.0, 0.0};
    }
    double potential_energy(std::span<const geometry::Vector> x) const override {
      return std::fabs(x[0].x);
    }
  } kink;
  // Computed with an error of 1e-7, a thousand times the change that the tolerance allows: the sum
  // is large.
  struct Offset final : OneParticle {
    void accelerations(std::span<const geometry::Vector> x,
                       std::span<geometry::Vector> a) const override {
      a[0] = {-x[0].x, 0.0};
    }
    double potential_energy(std::span<const geometry::Vector> x) const override {
      return 1e9 + 0.5 * x[0].x * x[0].x;
    }
  } offset;
  // The same with an error of 1e-9: its terms are large.
  struct Cancelled final : OneParticle {
    void accelerations(std::span<const geometry::Vector> x,
                       std::span<geometry::Vector> a) const override {
      a[0] = {-std::sin(1e-3 * x[0].x) * 1e3, 0.0};
    }
    double potential_energy(std::span<const geometry::Vector> x) const override {
      return 1e6 + 1e6 * (1e1 - std::cos(1e-3 * x[0].x)) - 1e7;
    }
  } cancelled;
  const Phase<double> start{{{0.3, 0.0}}, {{0.7, 0.2}}};
  const Ride a = ride(GetParam(), kink, start, 20.0, 1e-9);
  EXPECT_EQ(a.failure, "");
  EXPECT_LT(a.energy_error, 1e-6);
  for (const ForceLaw<double>* law :
       {static_cast<ForceLaw<double>*>(&offset), static_cast<ForceLaw<double>*>(&cancelled)}) {
    const Ride b = ride(GetParam(), *law, start, 20.0, 1e-12);
    EXPECT_EQ(b.failure, "");
    EXPECT_LT(b.steps.size(), 2000U);
    EXPECT_NEAR(b.end.position[0].x, 0.3 * std::cos(20.0) + 0.7 * std::sin(20.0), 2e-6);
  }
}

TEST_P(Adaptive, GoodStepsKeepTheEnergyByFar) {
  // With and without the check of the energy the steps are the same: it rejects no good one.
  struct Blind final : ForceLaw<double> {
    explicit Blind(const Problem<double>& p) : problem(p) {}
    void accelerations(std::span<const geometry::Vector> x,
                       std::span<geometry::Vector> a) const override {
      problem.accelerations(x, a);
    }
    const Problem<double>& problem;
  };
  for (const char* omega : {"0", "1.5", "20"})
    for (const double tolerance : {1e-2, 1e-4, 1e-8, 1e-12, 1e-15}) {
      const CoulombParticles<double> problem(omega);
      const Blind blind(problem);
      const auto with = stepper(problem, tolerance);
      const auto without =
          make_stepper({.scheme = GetParam(), .tolerance = tolerance}, blind, problem.omega);
      Phase<double> a = problem.start, b = problem.start, next_a, next_b;
      for (int k = 0; k < 2000; ++k) {
        ASSERT_EQ(with->step(a, 100.0, next_a), without->step(b, 100.0, next_b))
            << omega << ' ' << tolerance << ' ' << k;
        std::swap(a, next_a);
        std::swap(b, next_b);
      }
    }
}

INSTANTIATE_TEST_SUITE_P(Schemes, Adaptive, testing::Values("arkode", "cvode"),
                         [](const auto& made) { return made.param; });

}  // namespace
}  // namespace carom
