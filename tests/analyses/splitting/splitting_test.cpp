#include "carom/analyses/splitting.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "analyses/splitting/decay_rate.hpp"
#include "analyses/splitting/kick.hpp"
#include "analyses/systems.hpp"
#include "carom/analyses/escape.hpp"
#include "carom/base/error.hpp"
#include "carom/base/random.hpp"
#include "carom/events/world.hpp"
#include "carom/starts/sampler.hpp"
#include "soak.hpp"

namespace carom {

using namespace analyses;

namespace {

System three_disc() { return load_system("three-disc", {}).system; }

System square(const std::string& times) {
  SystemOverrides changes;
  changes.times = times;
  return load_system("magnetic-square", changes).system;
}

SplittingPlan by_hits(int levels, std::uint64_t population, std::uint64_t repetitions) {
  SplittingPlan plan;
  plan.by = SplittingPlan::Level::hits;
  for (int n = 0; n < levels; ++n) plan.levels.push_back(n);
  plan.population = population;
  plan.repetitions = repetitions;
  return plan;
}

SplittingPlan by_time(std::vector<double> levels, std::uint64_t population,
                      std::uint64_t repetitions) {
  SplittingPlan plan;
  plan.levels = std::move(levels);
  plan.population = population;
  plan.repetitions = repetitions;
  return plan;
}

// The part of a difference that chance and the kicks do not explain, in standard errors of both.
double deviation(const Extrapolated& split, double value, double error) {
  const double difference = std::fabs(split.limit.value - value);
  return difference / std::hypot(split.limit.error, error);
}

TEST(Splitting, DependsNeitherOnThreadsNorOnTheEngine) {
  const System square_system = square("lin:2:40:20");
  const System discs = three_disc();
  for (const bool hits : {false, true}) {
    const System& system = hits ? discs : square_system;
    const SplittingPlan plan = hits ? by_hits(6, 200, 3) : by_time({5, 10, 20}, 200, 3);
    SplittingOptions options;
    options.threads = 1;
    const SplittingResult one = run_splitting(system, plan, options);
    EXPECT_TRUE(one.complete);
    EXPECT_EQ(one.lost, 0u);
    EXPECT_GT(one.collisions, 1000u);
    for (const int threads : {2, 3, 8}) {
      options.threads = threads;
      options.decisions.filter_inflation = threads == 3 ? 0x1p20 : 1.0;
      if (threads == 2)
        options.lanes.reset();
      else
        options.lanes = available_instruction_sets().front();
      const SplittingResult many = run_splitting(system, plan, options);
      EXPECT_EQ(many.digest, one.digest);
      for (std::size_t k = 0; k < kick_sizes; ++k) {
        for (std::size_t r = 0; r < 3; ++r) {
          EXPECT_EQ(many.runs[k][r].survival, one.runs[k][r].survival);
          EXPECT_EQ(many.runs[k][r].gone, one.runs[k][r].gone);
        }
      }
    }
    SplittingPlan other = plan;
    other.kick = 0.01;
    EXPECT_NE(run_splitting(system, other, options).digest, one.digest);
  }
}

// To one part in a thousand of what started.
TEST(Splitting, ThreeDiscAgreesWithIndependentTrajectories) {
  System system = three_disc();
  const auto split = survival(run_splitting(system, by_hits(6, 8000, 20)));
  system.run.trajectories = 2'000'000;
  const EscapeResult brute = run_escape(system);
  for (const SurvivalHitsPoint& point : survival_by_hits(brute.counts)) {
    if (point.n == 0 || point.n > 3) continue;
    const SplitPoint& there = split[point.n];
    EXPECT_EQ(there.at, static_cast<double>(point.n));
    EXPECT_LT(deviation(there.p, point.p, (point.high - point.low) / 4), 4.0) << point.n;
    EXPECT_LT(there.p.limit.error, 0.05 * point.p);
    std::printf("n %llu: %.4e +- %.1e (extrapolation %.1e), independent %.4e\n",
                static_cast<unsigned long long>(point.n), there.p.limit.value, there.p.limit.error,
                there.p.extrapolation, point.p);
  }
}

// Gaspard & Rice 1989; the digits are those of cycle expansions.
TEST(Splitting, ThreeDiscSurvivalPerBounceIsThePublishedOne) {
  const SplittingResult result =
      run_splitting(three_disc(), by_hits(31, tests::soak() ? 4000 : 1600, 16));
  const auto points = survival(result);
  EXPECT_LT(points.back().p.limit.value, 1e-20);
  const Extrapolated decay = decay_rate(result, 6, 30);
  const double exact = -std::log(0.183029795396354243674);
  EXPECT_LT(std::fabs(decay.limit.value - exact), 4 * decay.limit.error);
  EXPECT_LT(decay.limit.error, 0.005);
  std::printf("survival per bounce %.6f +- %.6f, extrapolation %.6f\n",
              std::exp(-decay.limit.value), std::exp(-decay.limit.value) * decay.limit.error,
              std::exp(-decay.limit.value) * decay.extrapolation);
}

// To a thousandth: the three runs of docs/physics/rare-events.md together. Minutes, so with
// CAROM_SOAK alone.
TEST(Splitting, ThreeDiscSurvivalIsKnownToAThousandth) {
  if (!tests::soak()) GTEST_SKIP() << "long";
  double sum = 0.0, weights = 0.0;
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    System system = three_disc();
    system.run.seed = seed;
    const Extrapolated decay = decay_rate(run_splitting(system, by_hits(25, 64000, 32)), 12, 24);
    const double weight = 1.0 / (decay.limit.error * decay.limit.error);
    EXPECT_LT(decay.extrapolation, 1e-3);
    sum += weight * decay.limit.value;
    weights += weight;
  }
  const double off = sum / weights + std::log(0.183029795396354243674),
               error = 1.0 / std::sqrt(weights);
  std::printf("off by %.1e, standard error %.1e\n", off, error);
  EXPECT_LT(2.0 * error, 1e-3);
  EXPECT_LT(std::fabs(off), 1e-3);
}

// The orbit between two discs hits one of them where its wall begins. With kicks along the wall,
// folded there, these short looks back gave .1814(1) with kicks of 2^-7.
TEST(Splitting, WhereAWallBeginsDoesNotMatter) {
  SplittingPlan plan = by_hits(25, tests::soak() ? 6000 : 3000, 16);
  plan.kick = 0x1p-5;
  plan.lookback = 1;
  const Extrapolated decay = decay_rate(run_splitting(three_disc(), plan), 4, 24);
  double mean = 0.0, variance = 0.0;
  for (const Mean& kick : decay.at_kick) {
    mean += kick.value / 3;
    variance += kick.error * kick.error / 9;
  }
  std::printf("survival per bounce %.6f, off by %.1f standard errors of %.1e\n", std::exp(-mean),
              (-std::log(0.183029795396354243674) - mean) / std::sqrt(variance),
              std::sqrt(variance));
  EXPECT_LT(std::fabs(mean + std::log(0.183029795396354243674)), 3.5 * std::sqrt(variance));
  EXPECT_LT(std::sqrt(variance), 0.003);
}

// By time a kick changes the number of hits until the level, and with it from where a copy would go
// back. To take such ways favoured those with many hits: with these kicks, by 14 % after the first
// level and by 36 % after the third.
TEST(Splitting, CopiesByTimeKeepTheirNumberOfHits) {
  System system = three_disc();
  system.run.times = {6, 10, 14};
  SplittingPlan plan = by_time({4.2, 8.3, 12.5}, 20000, 8);
  plan.kick = 0.2;
  plan.lookback = 1;
  const auto split = survival(run_splitting(system, plan));
  system.run.trajectories = 5'000'000;
  const auto brute = survival(run_escape(system).counts);
  for (std::size_t i = 0; i < brute.size(); ++i) {
    const Mean& there = split[i].p.at_kick[0];
    EXPECT_LT(std::fabs(there.value - brute[i].p),
              4 * std::hypot(there.error, (brute[i].high - brute[i].low) / 4))
        << i;
    EXPECT_LT(there.error, 0.04 * brute[i].p) << i;
  }
}

TEST(Splitting, MagneticSquareAgreesWithIndependentTrajectories) {
  System system = square("5,10,15,20,30,40,60,80,120");
  const SplittingResult result = run_splitting(system, by_time({5, 10, 20, 40}, 2000, 16));
  system.run.trajectories = 200'000;
  const EscapeResult brute = run_escape(system);
  const auto rates = escape_rate(brute.counts);
  const auto split = escape_rate(result);
  ASSERT_EQ(rates.size(), split.size());
  for (std::size_t i = 0; i < rates.size(); ++i) {
    EXPECT_EQ(split[i].from, rates[i].from);
    EXPECT_EQ(split[i].to, rates[i].to);
    EXPECT_LT(deviation(split[i].value, rates[i].value, (rates[i].high - rates[i].low) / 4), 4.0)
        << i;
    std::printf("t %6.2f: %.3e +- %.1e (extrapolation %.1e), independent %.3e\n", rates[i].t,
                split[i].value.limit.value, split[i].value.limit.error,
                split[i].value.extrapolation, rates[i].value);
  }
  const auto shares = survival(brute.counts);
  const auto points = survival(result);
  for (std::size_t i = 0; i < shares.size(); ++i)
    EXPECT_LT(deviation(points[i].p, shares[i].p, (shares[i].high - shares[i].low) / 4), 4.0) << i;
}

// Before the first level nothing is copied: these are the first trajectories of the ensemble.
TEST(Splitting, FirstStageIsTheEnsemble) {
  System system = square("lin:1:10:10");
  const SplittingResult result = run_splitting(system, by_time({9.5}, 500, 2));
  system.run.trajectories = 500;
  const auto points = survival(run_escape(system).counts);
  for (std::size_t i = 0; i + 1 < points.size(); ++i)
    EXPECT_NEAR(result.runs[0][0].survival[i], points[i].p, 1e-12);
}

TEST(Splitting, ClosedTablesKeepEverything) {
  const System system =
      make_system("[table]\nshape = \"stadium\"\nhalf_length = 1\nradius = 1\n[run]\nt_max = 20\n");
  const SplittingResult result = run_splitting(system, by_time({5, 10}, 97, 3));
  constexpr double z = 1.9599639845400545;
  for (const SplitPoint& point : survival(result)) {
    EXPECT_EQ(point.p.limit.value, 1.0);
    EXPECT_EQ(point.p.extrapolation, 0.0);
    for (const Mean& mean : point.p.at_kick) EXPECT_EQ(mean.value, 1.0);
    EXPECT_EQ(point.p.high(), 1.0);
    // None of 291 starts has gone: Wilson's interval.
    EXPECT_NEAR(point.p.low(), 1.0 / (1.0 + z * z / 291), 1e-9);
    EXPECT_EQ(point.equivalent, 291.0);
  }
  for (const SplitRate& rate : escape_rate(result)) {
    EXPECT_EQ(rate.value.limit.value, 0.0);
    EXPECT_NEAR(rate.value.high(), (1.0 - 1.0 / (1.0 + z * z / 291)) / (rate.to - rate.from),
                1e-9 * rate.value.high());
  }
}

// Orbits that never hit, and those of a table without holes beside them: all are still there.
TEST(Splitting, SurvivalOfAllIsExactlyOne) {
  const System system = make_system(
      "[table]\nshape = \"rectangle\"\nwidth = 1\nheight = 1\n[field]\nlarmor_radius = "
      "0.1\n[run]\nt_max = 30\n");
  for (const SplittingPlan& plan : {by_time({5, 10, 20}, 97, 2), by_hits(12, 97, 2)})
    for (const auto& runs : run_splitting(system, plan).runs)
      for (const PopulationRun& run : runs)
        for (const double p : run.survival) EXPECT_EQ(p, 1.0);
}

// Around the discs of a table that is said to be closed, a particle that leaves is lost. None goes
// without being counted: trajectories that did not reach their level, and kicked copies that did
// not.
TEST(Splitting, LostKickedCopiesAreCounted) {
  System leaky = three_disc();
  Table table = *leaky.table;
  table.extent = Extent::bounded;
  leaky.table = std::make_shared<const Table>(table);
  SplittingPlan plan = by_hits(5, 100, 2);
  plan.kick = 0x1p-4;
  SplittingOptions options;
  options.threads = 1;
  const SplittingResult result = run_splitting(leaky, plan, options);
  std::uint64_t left = 0, kept = 0;
  for (const auto& runs : result.runs)
    for (const PopulationRun& run : runs) {
      std::uint64_t flown = plan.population;
      for (const std::uint64_t reached : run.reached) {
        left += flown - reached;
        flown = reached > 0 ? plan.population : 0;
      }
      kept += run.tried - run.accepted;
    }
  EXPECT_GT(kept, 0u);
  EXPECT_EQ(result.lost, left + kept);
  EXPECT_EQ(result.reports.size(), 5u);
  // A kick that is chosen loses some in its first populations, too.
  plan.kick = 0;
  plan.repetitions = 3;
  const SplittingResult chosen = run_splitting(leaky, plan, options);
  plan.kick = chosen.plan.kick;
  EXPECT_GT(chosen.lost, run_splitting(leaky, plan, options).lost);
}

// Pinned orbits are never copied and never lost.
TEST(Splitting, PinnedOrbitsKeepTheirShare) {
  const System system = make_system(
      "[table]\nshape = \"rectangle\"\nwidth = 1\nheight = 1\n[[table.hole]]\nwall = "
      "\"bottom\"\ncenter = "
      "0.5\n"
      "width = 0.3\n[field]\nlarmor_radius = 0.1\n[run]\nt_max = 200\n");
  const SplittingResult result = run_splitting(system, by_time({10, 20, 50}, 2000, 4));
  const Mean last = survival(result).back().p.at_kick[0];
  EXPECT_NEAR(last.value, 0.64, 5 * std::sqrt(0.64 * 0.36 / 8000));
}

TEST(Splitting, RefusesWhatItCannotDo) {
  const System system = three_disc();
  EXPECT_THROW(run_splitting(system, by_hits(0, 100, 2)), InputError);
  EXPECT_THROW(run_splitting(system, by_hits(3, 100, 1)), InputError);
  EXPECT_THROW(run_splitting(system, by_hits(3, 1, 2)), InputError);
  EXPECT_THROW(run_splitting(system, by_time({5, 4}, 100, 2)), InputError);
  EXPECT_THROW(run_splitting(system, by_time({5, 1e4}, 100, 2)), InputError);
  SplittingPlan plan = by_hits(3, 100, 2);
  plan.levels[1] = 0.5;
  EXPECT_THROW(run_splitting(system, plan), InputError);
  plan = by_hits(3, 100, 2);
  plan.kick = -0.1;
  EXPECT_THROW(run_splitting(system, plan), InputError);
  EXPECT_THROW(run_splitting(system, by_hits(3, 1'000'000'000, 2)), InputError) << "terabytes";
  EXPECT_THROW(run_splitting(load_system("henon-heiles", {}).system, by_hits(3, 100, 2)),
               InputError);
}

TEST(Splitting, CanBeInterrupted) {
  std::atomic<bool> stop{false};
  SplittingOptions options;
  options.threads = 1;
  options.interrupted = &stop;
  options.progress = [&](std::uint64_t done, std::uint64_t, std::uint64_t) { stop = done == 7; };
  const SplittingResult result = run_splitting(three_disc(), by_hits(3, 100, 100), options);
  EXPECT_FALSE(result.complete);
  for (const auto& runs : result.runs) EXPECT_EQ(runs.size(), 2u);
}

// The invariant measure stays: kicked cosine-law states are cosine-law states, close by, at the
// same place: a move along the wall would be folded at its end, and orbits that pass there lose
// their neighbours on the other side.
TEST(Kick, KeepsThePlaceAndTheInvariantMeasure) {
  for (const char* shape :
       {"shape = \"rectangle\"\nwidth = 1\nheight = 1\n", "shape = \"circle\"\nradius = 1\n"}) {
    const std::string wall =
        std::string(shape).find("circle") != std::string::npos ? "circle" : "bottom";
    const System system =
        make_system("[table]\n" + std::string(shape) + "[[table.hole]]\nwall = \"" + wall +
                    "\"\ncenter = 0.5\nwidth = 0.2\n[initial]\nkind = \"boundary\"\nwall = \"" +
                    wall + "\"\n[particles]\nspeed = 3\n");
    const geometry::CurveFrame frame = geometry::frame_of(system.table->walls[0].curve);
    const Sampler sampler(system);
    const World world(*system.table);
    const Kick kick(*system.table);
    constexpr int parts = 10, states = 40000;
    std::vector<double> before(parts), after(parts);
    for (std::uint64_t i = 0; i < states; ++i) {
      const State state = sampler.draw(world, i, 0);
      RandomStream random(1, Purpose::splitting, i);
      const State kicked = kick(state, 3.0, 0.3, random);
      EXPECT_EQ(kicked.u, state.u);
      EXPECT_EQ(kicked.position.x, state.position.x);
      EXPECT_EQ(kicked.position.y, state.position.y);
      const auto sine = [&](const State& at) {
        EXPECT_NEAR(dot(at.velocity, at.velocity), 9.0, 1e-14);
        EXPECT_GT(dot(at.velocity, geometry::normal_at(frame, at.u)), 0.0);
        return dot(at.velocity, right(geometry::normal_at(frame, at.u))) / 3.0;
      };
      const double old_sine = sine(state), new_sine = sine(kicked);
      EXPECT_LE(std::fabs(new_sine - old_sine), 0.3 + 1e-12);
      EXPECT_NE(new_sine, old_sine);
      ++before[static_cast<std::size_t>((1 + old_sine) / 2 * parts)];
      ++after[static_cast<std::size_t>((1 + new_sine) / 2 * parts)];
    }
    for (std::size_t i = 0; i < parts; ++i)
      EXPECT_NEAR(after[i], before[i], 5 * std::sqrt(2 * before[i]) + 1) << shape << i;
  }
}

// Two repetitions tell 12.7 standard errors at 95 %, sixteen 2.13, and no share lies beyond 0
// and 1.
TEST(Splitting, IntervalsKnowHowFewRepetitionsThereAre) {
  Extrapolated value;
  value.limit = {0.5, 0.01};
  for (const auto& [repetitions, quantile] :
       {std::pair{2u, 12.706205}, {3u, 4.302653}, {16u, 2.131450}, {1000u, 1.962341}}) {
    value.repetitions = repetitions;
    EXPECT_NEAR(value.band(), quantile * 0.01, 1e-8) << repetitions;
  }
  const std::vector<SplitPoint> points = survival(run_splitting(three_disc(), by_hits(6, 100, 2)));
  EXPECT_LE(points.front().p.least, 0.0);
  value.limit = {0.01, 0.01};
  value.repetitions = 2;
  value.least = 0.0;
  EXPECT_GT(value.low(), 0.0);
  EXPECT_LT(value.low(), 1e-7);
  EXPECT_GT(value.high(), 0.13);
  for (const SplitPoint& point : points) {
    EXPECT_EQ(point.p.repetitions, 2u);
    EXPECT_GE(point.p.low(), 0.0);
    EXPECT_LE(point.p.high(), 1.0);
  }
}

// Values of small populations are skewed: an interval about the value held it in 9 of 10 runs, or
// in 8.
TEST(Splitting, IntervalsHoldTheValue) {
  System system = three_disc();
  SplittingPlan plan = by_hits(9, 8000, 8);
  plan.kick = 0x1p-20;
  const auto value = survival(run_splitting(system, plan));
  for (const std::uint64_t population : {30u, 100u}) {
    plan.population = population;
    plan.repetitions = 4;
    int three = 0, eight = 0;
    constexpr int runs = 150;
    for (int i = 0; i < runs; ++i) {
      system.run.seed = 100 + static_cast<std::uint64_t>(i);
      const auto points = survival(run_splitting(system, plan));
      const auto holds = [&](std::size_t n) {
        return points[n].p.low() <= value[n].p.limit.value &&
               value[n].p.limit.value <= points[n].p.high();
      };
      three += holds(3);
      eight += holds(8);
    }
    std::printf("population %d: %.3f and %.3f of the intervals hold the value\n",
                static_cast<int>(population), three / 150.0, eight / 150.0);
    EXPECT_GE(three, 0.94 * runs);
    EXPECT_GE(eight, (population < 100 ? 0.88 : 0.94) * runs);
  }
}

}  // namespace
}  // namespace carom
