// Exact flights and integration with a step give the same statistics.
#include <gtest/gtest.h>

#include <cmath>

#include "analyses/systems.hpp"
#include "carom/analyses/escape.hpp"

namespace carom {
namespace {

SurvivalCounts survivors(System system, bool steps, std::uint64_t trajectories,
                         std::uint64_t seed) {
  system.dynamics.everywhere = steps;
  if (steps) system.dynamics.integrator.step = 0.1;
  system.run.trajectories = trajectories;
  system.run.seed = seed;
  const EscapeResult result = run_escape(system);
  EXPECT_EQ(result.counts.lost, 0u)
      << (result.reports.empty() ? "" : result.reports.front().second);
  EXPECT_EQ(result.counts.trajectories, trajectories);
  return result.counts;
}

// Different seeds, so that the numbers gone between report times are independent: chi^2 of two
// samples.
TEST(TwoEngines, TheyGiveTheSameSurvivalCurve) {
  const std::uint64_t many = 20000, few = 4000;
  for (const auto& [name, t_max] :
       {std::pair{"magnetic-square", "20"}, std::pair{"stadium", "60"}}) {
    SystemOverrides set;
    set.t_max = t_max;
    set.times = std::string("lin:") + (t_max[0] == '2' ? "1:20:20" : "3:60:20");
    const System system = load_system(name, set).system;
    const SurvivalCounts exact = survivors(system, false, many, 1),
                         stepped = survivors(system, true, few, 2);
    ASSERT_EQ(exact.times, stepped.times);
    const double share = static_cast<double>(few) / static_cast<double>(many);
    double chi_square = 0.0;
    int bins = 0;
    const auto bin = [&](std::uint64_t a, std::uint64_t b) {
      if (a + b == 0) return;
      const double d =
          std::sqrt(share) * static_cast<double>(a) - static_cast<double>(b) / std::sqrt(share);
      chi_square += d * d / static_cast<double>(a + b);
      ++bins;
    };
    std::uint64_t gone_exact = 0, gone_stepped = 0;
    for (std::size_t i = 0; i < exact.times.size(); ++i) {
      bin(exact.gone_in[i], stepped.gone_in[i]);
      gone_exact += exact.gone_in[i];
      gone_stepped += stepped.gone_in[i];
      const double p = static_cast<double>(many - gone_exact) / static_cast<double>(many);
      const double q = static_cast<double>(few - gone_stepped) / static_cast<double>(few);
      const double error = std::sqrt(
          p * (1.0 - p) * (1.0 / static_cast<double>(few) + 1.0 / static_cast<double>(many)));
      EXPECT_NEAR(q, p, 4.0 * error) << name << " t = " << exact.times[i];
    }
    bin(many - gone_exact, few - gone_stepped);
    EXPECT_GE(bins, 15);
    // Freedom: one less than the bins; four standard deviations.
    EXPECT_LT(chi_square, bins - 1 + 4.0 * std::sqrt(2.0 * (bins - 1))) << name;
    EXPECT_GT(gone_stepped, few / 4);
    const double hits = static_cast<double>(exact.collisions) / static_cast<double>(many);
    EXPECT_NEAR(static_cast<double>(stepped.collisions) / static_cast<double>(few) / hits, 1.0,
                0.06)
        << name;
  }
}

}  // namespace
}  // namespace carom
