// The decay of made-up populations: 95 % intervals hold the rate in 95 % of trials, and the law
// that made them is preferred where it can be told.
#include "carom/analyses/splitting/fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <stdexcept>
#include <string>

#include "random_tables.hpp"

namespace carom {

using namespace tests;

namespace {

using Generator = std::mt19937_64;

// Populations of `population` trajectories at levels 1 … 40: what is left of one at a level is a
// binomial share of what was left at the level before, refilled in between. Kicks change nothing.
SplittingResult made_up(const std::function<double(double)>& share, Generator& generator,
                        int population, std::size_t repetitions) {
  SplittingResult result;
  result.plan.population = static_cast<std::uint64_t>(population);
  result.plan.repetitions = repetitions;
  for (int level = 1; level <= 40; ++level) result.at.push_back(level);
  result.plan.levels = result.at;
  for (auto& runs : result.runs)
    for (std::size_t r = 0; r < repetitions; ++r) {
      PopulationRun run;
      run.done = true;
      double p = 1.0, before = 1.0;
      for (const double at : result.at) {
        std::binomial_distribution<int> left(population, share(at) / before);
        const int stayed = left(generator);
        p *= static_cast<double>(stayed) / population;
        run.survival.push_back(p);
        run.reached.push_back(static_cast<std::uint64_t>(stayed));
        run.copies.emplace_back();
        before = share(at);
      }
      runs.push_back(std::move(run));
    }
  return result;
}

double exponential(double t) { return std::exp(-0.3 * t); }
double power(double t) { return 1.0 / (t * t); }

// Rate 0.3 of an exponential, exponent 2 of a power.
void expect_held(const std::function<double(double)>& share, DecayLaw law, double truth) {
  Generator generator(1);
  const long trials = cases(100, 1000);
  long held = 0, near = 0, preferred = 0;
  for (long i = 0; i < trials; ++i) {
    const SplitFit fit = fit_decay(made_up(share, generator, 300, 16));
    ASSERT_EQ(fit.decays.size(), 2u) << fit.why_none;
    EXPECT_EQ(fit.from, 21.0);
    EXPECT_EQ(fit.to, 40.0);
    preferred += fit.decays[0].law == law;
    const SplitDecay& right = fit.decays[fit.decays[0].law == law ? 0 : 1];
    held += right.rate.low() <= truth && truth <= right.rate.high();
    // The interval also holds what extrapolation in the kicks adds; the error alone is narrower.
    near += std::fabs(right.rate.limit.value - truth) <= 0.5 * right.rate.limit.error;
  }
  const auto all = static_cast<double>(trials);
  EXPECT_GE(static_cast<double>(held), 0.95 * all - 3.9 * std::sqrt(0.0475 * all));
  EXPECT_LE(static_cast<double>(near), 0.38 * all + 3.9 * std::sqrt(0.24 * all))
      << "errors are too large";
  EXPECT_GE(static_cast<double>(preferred), 0.9 * all);
}

TEST(SplittingFit, HoldsTheRateOfAnExponential) {
  expect_held(exponential, DecayLaw::exponential, 0.3);
}
TEST(SplittingFit, HoldsTheExponentOfAPower) { expect_held(power, DecayLaw::power, 2.0); }

// Survival that falls in steps of four levels, as that of discs far apart: its slopes in the halves
// of a window may be those of either law, and neither describes it.
TEST(SplittingFit, DecidesForNoLawThatReportsWithinRefute) {
  Generator generator(4);
  const auto steps = [](double t) { return std::exp(-1.2 * std::floor(t / 4)); };
  for (int trial = 0; trial < 20; ++trial) {
    const SplitFit fit = fit_decay(made_up(steps, generator, 300, 16));
    ASSERT_FALSE(fit.decays.empty());
    EXPECT_LT(fit.decays[0].p_value, 0.01);
    EXPECT_FALSE(fit.decided);
  }
}

TEST(SplittingFit, TakesTheReportsOfItsWindow) {
  Generator generator(2);
  const SplittingResult result = made_up(exponential, generator, 300, 4);
  const SplitFit fit = fit_decay(result, DecayWindow{4.5, 12.0});
  EXPECT_EQ(fit.from, 5.0);
  EXPECT_EQ(fit.to, 12.0);
}

// An exponential that falls to a third shows itself, and a power over a factor of two in time.
TEST(SplittingFit, NamesALocalSlope) {
  Generator generator(4);
  const auto local = [&](const SplittingResult& result, DecayLaw law, double from, double to) {
    for (const SplitDecay& decay : fit_decay(result, DecayWindow{from, to}).decays)
      if (decay.law == law) return decay.local;
    throw std::logic_error("no such law");
  };
  const SplittingResult falls = made_up(exponential, generator, 3000, 4);
  EXPECT_TRUE(local(falls, DecayLaw::exponential, 5, 8));
  EXPECT_FALSE(local(falls, DecayLaw::exponential, 5, 10));
  const SplittingResult grows = made_up(power, generator, 3000, 4);
  EXPECT_TRUE(local(grows, DecayLaw::power, 10, 19));
  EXPECT_FALSE(local(grows, DecayLaw::power, 10, 20));
}

TEST(SplittingFit, SaysWhyThereIsNone) {
  Generator generator(3);
  EXPECT_NE(fit_decay(made_up(exponential, generator, 300, 1)).why_none, "");
  const SplittingResult two = made_up(exponential, generator, 300, 4);
  EXPECT_NE(fit_decay(two, DecayWindow{50, 60}).why_none, "");
  EXPECT_NE(fit_decay(two, DecayWindow{4.5, 5.5}).why_none, "");
  // All die out at the third level.
  const SplitFit dead = fit_decay(
      made_up([](double t) { return t < 2.5 ? exponential(t) : 0.0; }, generator, 300, 4));
  EXPECT_NE(dead.why_none, "");
}

}  // namespace
}  // namespace carom
