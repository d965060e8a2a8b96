// Escape rates and Lyapunov exponents from periodic orbits.
#include "carom/orbits/cycle_expansion.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "carom/analyses/orbits.hpp"
#include "carom/table/make.hpp"

namespace carom {
namespace {

System between(const MadeTable& table) {
  System system;
  system.table = table.table;
  system.particles.resize(1);
  return system;
}

// Of two discs one orbit is all there is: N(t) falls by Lambda a flight, and deviations grow by it
// (exact).
TEST(CycleExpansion, IsExactForTwoDiscs) {
  const double distance = 5.0;
  const OrbitSearchResult found =
      find_orbits(between(discs({{0.0, 0.0}, {distance, 0.0}}, 1.0)), {.most_hits = 20});
  ASSERT_EQ(found.orbits.size(), 1U);
  const CycleExpansion expansion = expand_cycles(found.orbits, 20);
  const double multiplier = distance - 1.0 + std::sqrt(distance * (distance - 2.0));
  const double rate = std::log(multiplier) / (distance - 2.0);
  EXPECT_NEAR(expansion.escape_rate, rate, 1e-13);
  EXPECT_NEAR(expansion.orders.front().dynamical, rate, 1e-13);
  EXPECT_NEAR(expansion.lambda, rate, 1e-13);
}

// P. Cvitanovic et al., ChaosBook; 26 digits in validation/.
TEST(CycleExpansion, GivesEscapeRateAndExponentOfThreeDiscs) {
  const OrbitSearchResult found = find_orbits(
      between(discs({{0.0, 0.0}, {6.0, 0.0}, {3.0, "3*sqrt(3)"_exact}}, 1.0)), {.most_hits = 11});
  const CycleExpansion expansion = expand_cycles(found.orbits, 11);
  EXPECT_NEAR(expansion.escape_rate, 0.41033840776934648, 1e-12);
  EXPECT_LT(std::abs(expansion.escape_rate - 0.41033840776934648), expansion.error);
  EXPECT_NEAR(expansion.orders.back().dynamical, 0.41033840776934648, 1e-5);
  constexpr double lambda = 0.577552578771878598;
  EXPECT_NEAR(expansion.lambda, lambda, 1e-12);
  for (std::size_t i = 2; i < expansion.orders.size(); ++i) {
    const double before = expansion.orders[i - 1].lambda, now = expansion.orders[i].lambda;
    EXPECT_LT(std::abs(now - lambda), 2.0 * std::abs(now - before)) << expansion.orders[i].hits;
  }
}

}  // namespace
}  // namespace carom
