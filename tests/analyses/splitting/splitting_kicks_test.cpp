// What kicks cost, as kicked copies tell by how long they stay.
#include <gtest/gtest.h>

#include <cmath>

#include "analyses/splitting/decay_rate.hpp"
#include "analyses/systems.hpp"
#include "carom/analyses/escape.hpp"
#include "carom/analyses/escape/survival.hpp"
#include "carom/analyses/splitting.hpp"

namespace carom {
namespace {

// Nothing stretches: a particle that is still there moves nearly at right angles to the walls with
// the hole, by some 1/t.
System rectangle() {
  return make_system(R"([table]
shape = "rectangle"
width = 1.3
height = 1
[[table.hole]]
wall = "bottom"
center = 0.4
width = 0.1
[particles]
speed = 1
[run]
times = [20, 100, 500]
t_max = 500
)");
}

SplittingPlan plan_of(double kick) {
  SplittingPlan plan;
  for (int i = 0; i < 9; ++i) plan.levels.push_back(10.0 * std::pow(40.0, i / 8.0));
  plan.population = 2000;
  plan.kick = kick;
  return plan;
}

std::vector<SurvivalPoint> independent(System system) {
  system.run.trajectories = 400'000;
  return survival(run_escape(system).counts);
}

// With 2^-9, which nearly all kicked copies survive, 11(2) % too few are there at t = 500.
TEST(SplittingKicks, AreChosenSmallWhereNothingStretches) {
  const SplittingResult result = run_splitting(rectangle(), plan_of(0));
  EXPECT_LT(result.plan.kick, 0x1p-11);
  EXPECT_FALSE(is_certain(cost_of_kicks(result, 2), 16));
  const auto truth = independent(rectangle());
  const auto split = survival(result);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const double error = std::hypot(split[i].p.limit.error, (truth[i].high - truth[i].low) / 4);
    EXPECT_LT(std::fabs(split[i].p.limit.value - truth[i].p), 4.0 * error) << truth[i].t;
  }
}

TEST(SplittingKicks, KicksThatAreTooLargeAreReported) {
  const SplittingResult result = run_splitting(rectangle(), plan_of(0x1p-7));
  const Mean cost = cost_of_kicks(result, 2);
  EXPECT_TRUE(is_certain(cost, 16)) << cost.value << " " << cost.error;
  EXPECT_LT(cost.value, 0.0);
  const auto truth = independent(rectangle()).back();
  const Extrapolated last = survival(result).back().p;
  EXPECT_GT(std::fabs(last.limit.value - truth.p), 6.0 * last.limit.error)
      << "these kicks cost little";
  EXPECT_GT(last.kick_error, 0.0);
  EXPECT_LT(last.low(), truth.low);
  EXPECT_GT(last.high(), truth.high);
  const Extrapolated rate = escape_rate(result).back().value, decay = decay_rate(result, 0, 2);
  EXPECT_GT(rate.kick_error, 0.0);
  EXPECT_NEAR(decay.kick_error,
              2.0 * std::fabs(cost.value - cost_of_kicks(result, 0).value) / 480.0, 1e-9);
}

// Where orbits stretch, kicked copies forget where they come from, and cost nothing that is seen.
TEST(SplittingKicks, KicksCostNothingAmongThreeDiscs) {
  SplittingPlan plan;
  plan.by = SplittingPlan::Level::hits;
  for (int n = 0; n < 16; ++n) plan.levels.push_back(n);
  plan.population = 3000;
  const SplittingResult result = run_splitting(load_system("three-disc", {}).system, plan);
  EXPECT_FALSE(is_certain(cost_of_kicks(result, 15), 16));
  for (const SplitPoint& point : survival(result)) EXPECT_EQ(point.p.kick_error, 0.0) << point.at;
  // Each stage has its first copies and the others, but the first.
  for (const PopulationRun& run : result.runs.back()) {
    EXPECT_EQ(run.copies.front().kicked.followed, 0u);
    for (std::size_t k = 0; k < 16; ++k) {
      EXPECT_EQ(run.copies[k].first.followed + run.copies[k].kicked.followed, 3000u);
      EXPECT_EQ(run.copies[k].first.stayed + run.copies[k].kicked.stayed, run.reached[k]);
      EXPECT_TRUE(k == 0 || run.copies[k].first.followed == run.reached[k - 1]);
    }
  }
}

}  // namespace
}  // namespace carom
