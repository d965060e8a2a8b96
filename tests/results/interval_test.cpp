// Intervals by replicates: made-up numbers whose truth is known.
#include "carom/results/interval.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "carom/base/error.hpp"

namespace carom {
namespace {

constexpr int repeats = 5000;

// How often an interval holds p, where `draw` makes the successes of a part of n trials.
template <class Draw>
double coverage(double p, std::uint64_t n, Draw draw) {
  int held = 0;
  for (int i = 0; i < repeats; ++i) {
    std::vector<Portion> parts;
    for (std::size_t r = 0; r < replicates; ++r) parts.push_back({draw(), n});
    const Interval at = replicate_interval(parts);
    held += at.low <= p && p <= at.high;
  }
  return static_cast<double>(held) / repeats;
}

// Of few successes Wilson's interval, which knows that trials are independent, holds the truth in
// 90 to 98 %.
TEST(ReplicateInterval, HoldsTheTruthOfIndependentTrials) {
  std::mt19937_64 random(5);
  for (const double expected : {0.1, 1.0, 3.0, 10.0, 100.0, 5000.0, 15999.0}) {
    const double p = expected / 16000.0;
    std::binomial_distribution<std::uint64_t> draw(1000, p), draw_all(16000, p);
    const double held = coverage(p, 1000, [&] { return draw(random); });
    int by_wilson = 0;
    for (int i = 0; i < repeats; ++i) {
      const Interval at = wilson_interval(draw_all(random), 16000);
      by_wilson += at.low <= p && p <= at.high;
    }
    EXPECT_GT(held, static_cast<double>(by_wilson) / repeats - 0.01) << expected;
    EXPECT_LT(held, expected < 10.0 || expected > 15000.0 ? 0.99 : 0.965) << expected;
  }
}

// Numbers that are spread as evenly as whole numbers can be.
TEST(ReplicateInterval, HoldsTheTruthOfTrialsThatAreSpreadEvenly) {
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (const double part : {0.01, 0.1, 0.19, 0.5, 0.9}) {
    const double p = (320.0 + part) / 1000.0;
    const double held = coverage(
        p, 1000, [&] { return static_cast<std::uint64_t>(320.0 + part + uniform(random)); });
    EXPECT_GT(held, 0.935) << part;
  }
}

TEST(ReplicateInterval, IsThatOfWilsonWhereNothingSucceeds) {
  std::vector<Portion> parts(replicates, {0, 100});
  EXPECT_EQ(replicate_interval(parts).low, 0.0);
  EXPECT_NEAR(replicate_interval(parts).high, 2.1314 * 2.1314 / (1600 + 2.1314 * 2.1314), 1e-6);
  for (Portion& part : parts) part.successes = part.trials;
  EXPECT_EQ(replicate_interval(parts).high, 1.0);
  parts.back() = {};
  EXPECT_EQ(replicate_interval(parts).low, 0.0) << "a replicate without trials tells no spread";
  parts.pop_back();
  EXPECT_THROW(replicate_interval(parts), InternalError);
}

TEST(Jackknife, OfAMeanIsItsStandardError) {
  std::mt19937_64 random(7);
  std::vector<double> numbers;
  double sum = 0.0, squares = 0.0;
  for (std::size_t r = 0; r < replicates; ++r) {
    numbers.push_back(std::normal_distribution<double>(3.0, 2.0)(random));
    sum += numbers.back();
  }
  constexpr double n = replicates;
  for (const double x : numbers) squares += (x - sum / n) * (x - sum / n);
  EXPECT_NEAR(jackknife_error([&](std::size_t r) { return (sum - numbers[r]) / (n - 1.0); }),
              std::sqrt(squares / (n - 1.0) / n), 1e-14);
}

}  // namespace
}  // namespace carom
