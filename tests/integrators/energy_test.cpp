// The energy of symplectic schemes oscillates and has no trend: over 10^5 steps, with CAROM_SOAK=1
// over 10^7.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <string>
#include <vector>

#include "../../validation/schemes/problems.hpp"
#include "soak.hpp"
#include "steppers.hpp"

namespace carom {

using namespace integrators;

namespace {

constexpr int blocks = 100;

struct Drift {
  double oscillation;  ///< largest less smallest energy
  double change;  ///< what the least squares line through the means of blocks gains over the whole
                  ///< time
};

Drift energy_drift(const Scheme& scheme, const problems::Problem<double>& problem, double step,
                   long steps) {
  const auto stepper = stepper_of<double>(scheme, problem, problem.omega);
  Phase<double> phase = problem.start, next;
  const double start = problem.energy(phase);
  double low = 0.0, high = 0.0, moment = 0.0;
  for (int b = 0; b < blocks; ++b) {
    double sum = 0.0;
    for (long k = 0; k < steps / blocks; ++k) {
      stepper->step(phase, step, next);
      std::swap(phase, next);
      const double error = problem.energy(phase) - start;
      low = std::min(low, error);
      high = std::max(high, error);
      sum += error;
    }
    moment += sum * blocks / static_cast<double>(steps) * (b - 0.5 * (blocks - 1));
  }
  // Sum of (b - mean)^2 is n (n^2 - 1)/12; the line runs over n blocks.
  return {high - low, moment * 12.0 / (static_cast<double>(blocks) * blocks - 1.0)};
}

class Energy : public testing::TestWithParam<std::string> {};

TEST_P(Energy, OscillatesWithoutTrend) {
  const long steps = tests::soak() ? 10000000 : 100000;
  const Scheme& scheme = find_scheme(GetParam());
  const auto stages = stages_of<double>(scheme);
  const auto kicks = std::count_if(stages.begin(), stages.end(), [](const auto& s) {
    return s.kind == Stage<double>::Kind::kick;
  });
  const double step = static_cast<double>(kicks) / 32.0;  // equal work for all
  // Without field the energy has slow waves as well, which only a long run sees to their end.
  const std::vector<const char*> fields =
      tests::soak() ? std::vector{"0", "1.5"} : std::vector{"1.5"};
  for (const char* omega : fields) {
    const problems::HenonHeiles<double> problem(omega);
    const Drift drift = energy_drift(scheme, problem, step, steps);
    EXPECT_LT(std::fabs(drift.change), 0.1 * drift.oscillation) << "omega = " << omega;
    EXPECT_GT(drift.oscillation, 1e-12);  // far above rounding, else nothing was shown
    EXPECT_LT(drift.oscillation, 0.05);
    if (tests::soak()) {
      std::cout << "| " << scheme.name << " | " << step << " | " << omega << " | "
                << drift.oscillation << " | " << drift.change / drift.oscillation << " |\n";
    }
  }
}

TEST(EnergyDrift, IsSeenWhereThereIsOne) {
  // A trend by construction: each step adds 1e-8 of speed.
  struct Heated final : problems::Problem<double> {
    Heated() {
      omega = {0.0};
      start = {{{0.1, 0.2}}, {{1.0, 0.0}}};
    }
    double potential(std::span<const Vector>) const override { return 0.0; }
    void compute(std::span<const Vector>, std::span<Vector> a) const override {
      a[0] = {1e-8, 0.0};
    }
  } problem;
  const Drift drift = energy_drift(find_scheme("velocity-verlet"), problem, 1.0, 10000);
  EXPECT_NEAR(drift.change / drift.oscillation, 1.0, 0.01);
}

std::vector<std::string> symplectic_names() {
  std::vector<std::string> list;
  for (const Scheme& scheme : schemes())
    if (scheme.symplectic()) list.emplace_back(scheme.name);
  return list;
}

INSTANTIATE_TEST_SUITE_P(Schemes, Energy, testing::ValuesIn(symplectic_names()),
                         [](const auto& made) {
                           std::string name = made.param;
                           std::erase(name, '-');
                           return name;
                         });

}  // namespace
}  // namespace carom
