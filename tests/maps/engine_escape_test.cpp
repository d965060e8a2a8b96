// Figure 5 of Solanpaa, Luukko & Rasanen (2016): escape from a magnetic square, engine against map.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <numbers>
#include <numeric>
#include <random>
#include <vector>

#include "carom/analyses/escape.hpp"
#include "maps/closed/maps.hpp"
#include "maps/engine.hpp"

namespace carom {
namespace {

struct ChiSquare {
  double value = 0.0;
  int degrees = -1;  // one is spent: both samples have the same size
  // Normal deviate of the upper tail (Wilson & Hilferty 1931); p > 1e-3 is below 3.09.
  double deviate() const {
    const double k = 2.0 / (9.0 * degrees);
    return (std::cbrt(value / degrees) - (1.0 - k)) / std::sqrt(k);
  }
};

ChiSquare compare(const std::vector<std::uint64_t>& a, const std::vector<std::uint64_t>& b) {
  ChiSquare result;
  double first = 0, second = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    first += static_cast<double>(a[i]);
    second += static_cast<double>(b[i]);
    if (first + second < 20 && i + 1 < a.size()) continue;  // too few: joined with the next
    if (first + second == 0) break;
    result.value += (first - second) * (first - second) / (first + second);
    ++result.degrees;
    first = second = 0;
  }
  return result;
}

// The bins and the rest: those still there at the end.
std::vector<std::uint64_t> with_rest(std::vector<std::uint64_t> bins, std::uint64_t trajectories) {
  bins.push_back(trajectories - std::accumulate(bins.begin(), bins.end(), std::uint64_t{0}));
  return bins;
}

struct EscapeCase {
  double larmor_radius, turn;
};
class MagneticSquareEscape : public ::testing::TestWithParam<EscapeCase> {};

TEST_P(MagneticSquareEscape, HasTheRateOfTheMap) {
  const auto [rho, turn] = GetParam();
  const char* asked = std::getenv("CAROM_TRAJECTORIES");  // 10000000 for the figure itself
  const char* asked_time = std::getenv("CAROM_T_MAX");
  System system;
  HoleSpec hole;
  hole.wall = "bottom";
  hole.center = ExactNumber("0.5", Place{});
  hole.width = ExactNumber("0.3", Place{});
  system.table = std::make_shared<Table>(
      witness::table("rectangle", {{"width", "1"}, {"height", "1"}}, {hole}));
  system.particles = {{1, 1, 1, turn / rho}};
  system.run.trajectories = asked != nullptr ? std::strtoull(asked, nullptr, 10) : 100000;
  system.run.t_max = asked_time != nullptr ? std::strtod(asked_time, nullptr) : 40.0;
  system.run.seed = 20160901;
  for (double t = 0.1; t < system.run.t_max; t *= 1.2) system.run.times.push_back(t);
  const EscapeResult engine = run_escape(system);
  ASSERT_EQ(engine.counts.lost, 0u);
  ASSERT_EQ(engine.counts.singular, 0u);

  const maps::MagneticRectangle<double> map(1, 1, 1, turn / rho);
  const maps::Opening<double> opening{maps::Side::bottom, 0.35, 0.65};
  SurvivalCounts counts(system.run.times, 1);
  std::mt19937_64 random(1987);
  const auto uniform = [&random] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  for (std::uint64_t i = 0; i < system.run.trajectories; ++i) {
    const double x = uniform(), y = uniform(), angle = 2 * std::numbers::pi * uniform();
    const auto end = map.escape(opening, x, y, angle, system.run.t_max);
    const Fate fate = end.escaped ? Fate::escaped : end.pinned ? Fate::pinned : Fate::survived;
    counts.add(fate, end.time, end.hits, end.escaped ? 0 : -1);
  }
  const std::uint64_t n = system.run.trajectories;
  const ChiSquare time = compare(with_rest(engine.counts.gone_in, n), with_rest(counts.gone_in, n));
  const ChiSquare hits =
      compare(with_rest(engine.counts.gone_in_hits, n), with_rest(counts.gone_in_hits, n));
  const ChiSquare pinned =
      compare({engine.counts.pinned, n - engine.counts.pinned}, {counts.pinned, n - counts.pinned});
  EXPECT_LT(time.deviate(), 3.09);
  EXPECT_LT(hits.deviate(), 3.09);
  EXPECT_LT(pinned.value, 10.8);
  EXPECT_GE(time.degrees, 20);
  std::printf(
      "rho %g: chi^2 of times %.1f with %d degrees (deviate %.2f), of hits %.1f with %d (%.2f); "
      "pinned %llu, "
      "%llu; survivors %llu, %llu of %llu\n",
      turn * rho, time.value, time.degrees, time.deviate(), hits.value, hits.degrees,
      hits.deviate(), static_cast<unsigned long long>(engine.counts.pinned),
      static_cast<unsigned long long>(counts.pinned),
      static_cast<unsigned long long>(engine.counts.survived),
      static_cast<unsigned long long>(counts.survived), static_cast<unsigned long long>(n));
}

INSTANTIATE_TEST_SUITE_P(Fields, MagneticSquareEscape,
                         ::testing::Values(EscapeCase{0.5075, 1}, EscapeCase{0.3, -1}));

}  // namespace
}  // namespace carom
