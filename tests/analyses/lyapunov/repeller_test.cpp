// The exponent of orbits that never leave, by populations.
#include "carom/analyses/lyapunov/repeller.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "analyses/systems.hpp"
#include "carom/analyses/lyapunov.hpp"
#include "carom/base/error.hpp"

namespace carom {
namespace {

System three_disc(std::uint64_t seed, double t_max = 42.0) {
  System system = load_system("three-disc", {}).system;
  system.run.trajectories = 16 * 3 * 300;
  system.run.t_max = t_max;
  system.run.seed = seed;
  return system;
}

// By cycle expansion, 18 digits (ChaosBook); the program's own gives 13 of them.
constexpr double lambda = 0.577552578771878598, flight = 4.142111880596933;

TEST(Repeller, IntervalsHoldTheExponentOfThreeDiscs) {
  int held = 0;
  double sum = 0.0, squares = 0.0;
  constexpr int runs = 8;
  for (int seed = 1; seed <= runs; ++seed) {
    const System system = three_disc(static_cast<std::uint64_t>(seed));
    const RepellerExponent r = *measure_repeller(system, growth_window(system), flight);
    held += r.per_time.low() <= lambda && lambda <= r.per_time.high();
    const double off = (r.per_time.limit.value - lambda) / r.per_time.limit.error;
    sum += off;
    squares += off * off;
    EXPECT_LT(r.per_time.limit.error, 0.002);
    EXPECT_NEAR(r.per_hit.limit.value, lambda * flight, 6.0 * r.per_hit.limit.error);
    EXPECT_FALSE(r.drifts());
  }
  EXPECT_GE(held, runs - 1);
  EXPECT_LT(std::fabs(sum / runs), 3.0 / std::sqrt(runs));
  EXPECT_LT(squares / runs, 3.0);
}

// One orbit is all that never leaves between two discs: its multiplier is known, and no growth
// varies.
TEST(Repeller, IsExactForTwoDiscs) {
  System system = make_system(
      "[table]\nshape = \"discs\"\ncenters = [[0, 0], [5, 0]]\nradius = 1\n[initial]\nkind = "
      "\"boundary\"\n[run]\nt_max = 40\ntrajectories = 28800\n");
  const RepellerExponent r = *measure_repeller(system, growth_window(system), 3.0);
  EXPECT_NEAR(r.per_time.limit.value, std::log(4.0 + std::sqrt(15.0)) / 3.0, 1e-3);
}

TEST(Repeller, DependsNeitherOnThreadsNorOnLanes) {
  const System system = three_disc(1);
  SplittingOptions one, two;
  one.threads = 1;
  one.lanes.reset();
  two.threads = 2;
  const TimeWindow window = growth_window(system);
  const RepellerExponent a = *measure_repeller(system, window, flight, one),
                         b = *measure_repeller(system, window, flight, two);
  EXPECT_EQ(a.per_time.limit.value, b.per_time.limit.value);
  EXPECT_EQ(a.change.limit.error, b.change.limit.error);
}

// A run of an open system has it, one of a closed system has not.
TEST(Repeller, IsAddedWhereOrbitsLeave) {
  EXPECT_TRUE(run_lyapunov(three_disc(1)).repeller);
  System closed = make_system(
      "[table]\nshape = \"stadium\"\nhalf_length = 1\nradius = 1\n[run]\nt_max = "
      "20\ntrajectories = 100\n");
  EXPECT_FALSE(run_lyapunov(closed).repeller);
  EXPECT_FALSE(is_open(closed));
}

// Bouncing balls never leave a stadium with a hole at its end: what survives has smaller exponents
// the later it is looked at.
TEST(Repeller, SaysWhereTheExponentStillFalls) {
  System system = load_system("stadium", {}).system;
  system.run.trajectories = 16 * 3 * 600;
  system.run.t_max = 400;
  const RepellerExponent r = *measure_repeller(system, growth_window(system), 2.0);
  EXPECT_TRUE(r.drifts());
  EXPECT_LT(r.late.limit.value, r.early.limit.value);
}

TEST(Repeller, RefusesWhatCannotBeKeptAlive) {
  System system = three_disc(1);
  system.run.trajectories = 1000;
  EXPECT_THROW((void)measure_repeller(system, {8, 42}, flight), InputError);
  EXPECT_THROW((void)measure_repeller(three_disc(1, 5.0), {1, 5}, flight), InputError);
}

}  // namespace
}  // namespace carom
