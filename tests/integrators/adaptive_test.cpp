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

class Adaptive : public testing::TestWithParam<std::string> {
 protected:
  static std::unique_ptr<Stepper<double>> stepper(const Problem<double>& problem, double tolerance) {
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
    void accelerations(std::span<const geometry::Vector> x, std::span<geometry::Vector> a) const override {
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
    Phase<double> phase{{scale * law.law.start.position[0]}, {scale * law.law.start.velocity[0]}}, next;
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
    void accelerations(std::span<const geometry::Vector> x, std::span<geometry::Vector> a) const override {
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
    void accelerations(std::span<const geometry::Vector>, std::span<geometry::Vector> a) const override {
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

INSTANTIATE_TEST_SUITE_P(Schemes, Adaptive, testing::Values("arkode", "cvode"),
                         [](const auto& made) { return made.param; });

}  // namespace
}  // namespace carom
