// Steps in double precision: exact free motion, forces computed once, bits that depend on the start
// alone.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "../../validation/schemes/problems.hpp"
#include "carom/integrators/make_stepper.hpp"
#include "high_precision.hpp"
#include "steppers.hpp"

namespace carom {

using namespace integrators;

namespace {

using geometry::Vector;
using problems::CoulombParticles;
using problems::HenonHeiles;

template <class Real>
struct NoForce final : ForceLaw<Real> {
  void accelerations(std::span<const geometry::BasicVector<Real>>,
                     std::span<geometry::BasicVector<Real>> a) const override {
    for (auto& each : a) each = {};
  }
};

TEST(LarmorDrift, IsAccurateForAnyFrequency) {
  const Vector v{0.6, -0.7};
  const double time = 0.8125;
  double omega = 20.0;
  for (; omega > 1e-320; omega *= 0.37) {
    for (const double sign : {1.0, -1.0}) {
      Vector x{}, u = v;
      LarmorDrift<double>(sign * omega, time).move(x, u);
      geometry::BasicVector<HighPrecision> exact_x{}, exact_u{v.x, v.y};
      LarmorDrift<HighPrecision>(sign * omega, time).move(exact_x, exact_u);
      EXPECT_NEAR(static_cast<double>(HighPrecision(x.x) - exact_x.x), 0.0, 5e-16) << omega;
      EXPECT_NEAR(static_cast<double>(HighPrecision(x.y) - exact_x.y), 0.0, 5e-16) << omega;
      EXPECT_NEAR(static_cast<double>(HighPrecision(u.x) - exact_u.x), 0.0, 5e-16 + 1e-16 * omega)
          << omega;
      EXPECT_NEAR(static_cast<double>(HighPrecision(u.y) - exact_u.y), 0.0, 5e-16 + 1e-16 * omega)
          << omega;
    }
  }
}

TEST(LarmorDrift, IsTheCircle) {
  // B > 0 turns clockwise about x + J v/omega.
  const double omega = 0.7, time = 2.3;
  const Vector x0{0.3, -0.1}, v0{1.1, 0.4};
  const Vector centre = x0 + (1.0 / omega) * right(v0);
  Vector x = x0, v = v0;
  LarmorDrift<double>(omega, time).move(x, v);
  const double c = std::cos(omega * time), s = std::sin(omega * time);
  EXPECT_NEAR(v.x, c * v0.x + s * v0.y, 1e-15);
  EXPECT_NEAR(v.y, c * v0.y - s * v0.x, 1e-15);
  EXPECT_NEAR(x.x, centre.x - v.y / omega, 1e-15);
  EXPECT_NEAR(x.y, centre.y + v.x / omega, 1e-15);
}

TEST(LarmorDrift, KeepsTheSpeedOverManyTurns) {
  for (double angle = 0.05; angle < 7.0; angle += 0.31) {
    const LarmorDrift<double> drift(angle, 1.0);
    Vector v{0.6, 0.8};
    for (int k = 0; k < 1000000; ++k) drift.turn(v);
    EXPECT_NEAR(dot(v, v), 1.0, 1e-12)
        << angle;  // by chance 2e-13; a rounded sine and cosine: 1e-10
  }
}

TEST(Splitting, FliesFreeParticlesExactly) {
  const NoForce<HighPrecision> none;
  const std::vector<HighPrecision> omega{HighPrecision("1.5"), HighPrecision(0)};
  const Phase<HighPrecision> from{{{1, 2}, {3, 4}},
                                  {{HighPrecision("0.3"), HighPrecision("-0.9")}, {1, -1}}};
  Phase<HighPrecision> exact = from;
  LarmorDrift<HighPrecision>(omega[0], 10).move(exact.position[0], exact.velocity[0]);
  LarmorDrift<HighPrecision>(omega[1], 10).move(exact.position[1], exact.velocity[1]);
  for (const Scheme& scheme : schemes()) {
    if (scheme.form == Scheme::Form::he) continue;  // straight and turn apart: not exact
    Phase<HighPrecision> to;
    stepper_of<HighPrecision>(scheme, none, omega)->step(from, HighPrecision(10), to);
    EXPECT_LT(distance(to, exact), HighPrecision("1e-36")) << scheme.name;
  }
}

TEST(SpreiterWalter, IsExactInAUniformForce) {
  struct Uniform final : ForceLaw<HighPrecision> {
    void accelerations(std::span<const geometry::BasicVector<HighPrecision>>,
                       std::span<geometry::BasicVector<HighPrecision>> a) const override {
      a[0] = {HighPrecision("0.4"), HighPrecision("-1.1")};
    }
  } law;
  for (const char* frequency : {"1.7", "0.02", "0"}) {
    const std::vector<HighPrecision> omega{HighPrecision(frequency)};
    const Phase<HighPrecision> from{{{0, 0}}, {{1, HighPrecision("0.5")}}};
    Phase<HighPrecision> to;
    SpreiterWalterStepper<HighPrecision>(law, omega).step(from, HighPrecision(2), to);
    const auto fine = stepper_of<HighPrecision>(find_scheme("kahan-li-8"), law, omega);
    EXPECT_LT(distance(to, walk(*fine, from, HighPrecision(2) / 2000, 2000)),
              HighPrecision("1e-28"))
        << frequency;
  }
}

TEST(SpreiterWalter, IsVelocityVerletWithoutAField) {
  const HenonHeiles<HighPrecision> problem("0");
  const HighPrecision step = HighPrecision(1) / 20;
  const auto ours =
      stepper_of<HighPrecision>(find_scheme("spreiter-walter"), problem, problem.omega);
  const auto verlet =
      stepper_of<HighPrecision>(find_scheme("velocity-verlet"), problem, problem.omega);
  EXPECT_LT(
      distance(walk(*ours, problem.start, step, 100), walk(*verlet, problem.start, step, 100)),
      HighPrecision("1e-36"));
}

bool same(const Phase<double>& a, const Phase<double>& b) {
  return std::memcmp(a.position.data(), b.position.data(), a.position.size() * sizeof(Vector)) ==
             0 &&
         std::memcmp(a.velocity.data(), b.velocity.data(), a.velocity.size() * sizeof(Vector)) == 0;
}

TEST(Steps, DependOnTheirStartAlone) {
  const CoulombParticles<double> problem("1.5");
  for (const Scheme& scheme : schemes()) {
    const auto kept = stepper_of<double>(scheme, problem, problem.omega);
    Phase<double> phase = problem.start, next, part, fresh;
    for (int k = 0; k < 20; ++k) {
      kept->step(phase, 0.05, next);
      kept->step(phase, 0.013, part);  // a look into the step
      kept->step(phase, 0.031, part);
      stepper_of<double>(scheme, problem, problem.omega)->step(phase, 0.031, fresh);
      ASSERT_TRUE(same(part, fresh)) << scheme.name;
      stepper_of<double>(scheme, problem, problem.omega)->step(phase, 0.05, fresh);
      ASSERT_TRUE(same(next, fresh)) << scheme.name;
      if (k % 7 == 6) next = part;  // a hit: the step ends early
      std::swap(phase, next);
    }
  }
}

TEST(Steps, ComputeNoForceTwice) {
  const std::vector<std::pair<std::string, long>> kicks{{"velocity-verlet", 1},
                                                        {"spreiter-walter", 1},
                                                        {"he-2", 1},
                                                        {"ruth-3", 3},
                                                        {"forest-ruth-4", 3},
                                                        {"he-4", 3},
                                                        {"mclachlan-s5", 5},
                                                        {"blanes-moan-srkn6b", 6},
                                                        {"kahan-li-8", 17},
                                                        {"mclachlan-atela-5", 6},
                                                        {"blanes-moan-srkn14a", 14}};
  for (const auto& [name, count] : kicks) {
    const HenonHeiles<double> problem("1.5");
    const auto stepper = stepper_of<double>(find_scheme(name), problem, problem.omega);
    const Phase<double> end = walk(*stepper, problem.start, 0.01, 100);
    EXPECT_GE(problem.evaluations, 100 * count) << name;
    EXPECT_LE(problem.evaluations, 100 * count + 1) << name;
    const long before = problem.evaluations;
    Phase<double> to;
    stepper->step(end, 0.01, to);
    stepper->step(end, 0.005, to);  // the first kick of a part is that of the whole
    EXPECT_EQ(problem.evaluations - before,
              2 * count - (name == "ruth-3" || name == "mclachlan-atela-5" ? 1 : 0))
        << name;
  }
}

TEST(Plan, IsChecked) {
  const HenonHeiles<double> problem("0");
  const auto refused = [&](const IntegratorPlan& plan, const std::string& key) {
    try {
      make_stepper(plan, problem, problem.omega);
    } catch (const InputError& error) {
      EXPECT_EQ(error.place().key, key);
      return;
    }
    ADD_FAILURE() << "accepted: " << plan.scheme;
  };
  refused({.scheme = "verlet"}, "scheme");
  refused({.scheme = "velocity-verlet"}, "step");
  refused({.scheme = ""}, "step");
  refused({.scheme = "", .step = -0.1}, "step");
  refused({.scheme = "", .step = std::nan("")}, "step");
  refused({.scheme = "", .step = HUGE_VAL}, "step");
  refused({.scheme = "kahan-li-8", .step = 0.1, .tolerance = 1e-10}, "tolerance");
  refused({.scheme = "arkode", .tolerance = 1e-17}, "tolerance");
  refused({.scheme = "arkode", .tolerance = -1.0}, "tolerance");
  refused({.scheme = "cvode", .step = -1.0}, "step");
  EXPECT_NE(make_stepper({.scheme = "", .step = 0.1}, problem, problem.omega), nullptr);
  EXPECT_NE(make_stepper({.scheme = "cvode"}, problem, problem.omega), nullptr);
}

TEST(Plan, FieldsThatTurnTooFarInAStepAreSeen) {
  const IntegratorPlan plan{.scheme = "velocity-verlet", .step = 0.1};
  EXPECT_EQ(check_turn(plan, 10.0, true), "");
  EXPECT_THROW(check_turn(plan, -10.1, true), InputError);
  EXPECT_EQ(check_turn(plan, 20.0, false), "");
  EXPECT_NE(check_turn(plan, -20.1, false), "");
  EXPECT_EQ(check_turn(IntegratorPlan{.scheme = "arkode", .step = 0.1}, 1000.0, true), "");
}

}  // namespace
}  // namespace carom
