// Paired survival curves against counts by hand, all swaps there are, and made-up biases.
#include "validation/rounding/paired_survival.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "random_tables.hpp"

namespace carom::tests {
namespace {

PairedEnd gone(double time, int hole = 0, std::uint64_t hits = 1) { return {time, hole, hits}; }

TEST(PairedSurvival, CountsDifferences) {
  PairedSurvival pairs({1.0, 2.0, 4.0}, 1e-3);
  pairs.add(gone(1.0), gone(1.0005));     // the same, on two sides of a report time
  pairs.add(gone(1.5), gone(3.0, 0, 2));  // other hits
  pairs.add(gone(1.5, 0), gone(1.5, 1));  // other hole
  pairs.add(gone(0.5), gone(0.6));        // other time
  pairs.add(PairedEnd{}, gone(3.0));      // only one
  pairs.add(PairedEnd{}, PairedEnd{});
  const PairedResult r = pairs.result(1, 100);
  EXPECT_EQ(r.pairs, 6u);
  EXPECT_EQ(r.other_hole, 2u);
  EXPECT_EQ(r.other_hits, 1u);
  EXPECT_EQ(r.other_time, 1u);
  ASSERT_EQ(r.points.size(), 3u);
  EXPECT_DOUBLE_EQ(r.points[0].first, 4.0 / 6.0);  // an escape exactly at t counts at t
  EXPECT_DOUBLE_EQ(r.points[0].second, 5.0 / 6.0);
  EXPECT_EQ(r.points[0].only_second, 1u);
  EXPECT_EQ(r.points[1].only_second, 1u);
  EXPECT_EQ(r.points[1].only_first, 0u);
  EXPECT_EQ(r.points[2].only_first, 1u);
  EXPECT_DOUBLE_EQ(r.points[2].difference, 1.0 / 6.0);
  EXPECT_DOUBLE_EQ(r.points[2].error, std::sqrt(1.0 - 1.0 / 6.0) / 6.0);
}

TEST(PairedSurvival, EqualPairsGiveNoDifference) {
  PairedSurvival pairs({1.0, 2.0}, 0.0);
  for (int i = 0; i < 100; ++i) pairs.add(gone(0.03 * i), gone(0.03 * i));
  const PairedResult r = pairs.result(1, 100);
  EXPECT_EQ(r.different(), 0u);
  EXPECT_EQ(r.statistic, 0.0);
  EXPECT_EQ(r.p_value, 1.0);
  // A few pairs must disagree before anything can be found: (1.96 + 0.84)^2 of them.
  EXPECT_NEAR(r.points[0].detectable, 7.85 / 100.0, 1e-4);
}

// All 2^n swaps of n pairs, one by one.
TEST(PairedSurvival, SwapsAreThoseOfAllSwaps) {
  Dice dice(3);
  for (int trial = 0; trial < 20; ++trial) {
    const std::vector<double> times{1.0, 2.0, 3.0, 4.0};
    std::vector<std::pair<double, double>> ends;
    PairedSurvival pairs(times, 0.0);
    for (int i = 0; i < 10; ++i) {
      const double shift = trial % 2 == 0 ? 0.0 : 1.2;
      ends.emplace_back(dice.between(0.0, 5.0) + shift, dice.between(0.0, 5.0));
      pairs.add(gone(ends.back().first), gone(ends.back().second));
    }
    const auto statistic = [&](unsigned mask) {
      double most = 0.0;
      for (const double t : times) {
        double sum = 0.0, number = 0.0;
        for (std::size_t i = 0; i < ends.size(); ++i) {
          const double d = double(ends[i].first > t) - double(ends[i].second > t);
          sum += ((mask >> i) & 1u) != 0 ? -d : d;
          number += d * d;
        }
        if (number > 0.0) most = std::max(most, std::fabs(sum) / std::sqrt(number));
      }
      return most;
    };
    int as_large = 0;
    for (unsigned mask = 0; mask < 1024; ++mask)
      as_large += statistic(mask) >= statistic(0) - 1e-12 ? 1 : 0;
    const double p = as_large / 1024.0;
    const PairedResult r = pairs.result(17, 20000);
    EXPECT_DOUBLE_EQ(r.statistic, statistic(0));
    EXPECT_NEAR(r.p_value, p, 5.0 * std::sqrt(p * (1.0 - p) / 20000.0) + 1e-3);
  }
}

// Two independent exponential decays of one rate are told apart in one case of twenty; a bias of
// the size that is called detectable, in four of five.
TEST(PairedSurvival, FindsTheBiasItPromises) {
  const std::vector<double> times{0.25, 0.5, 1.0, 2.0, 3.0};
  const int experiments = 200, sample = 2000;
  int wrong = 0, found = 0;
  Dice dice(5);
  const auto decay = [&](double rate) { return -std::log(1.0 - dice.between(0.0, 1.0)) / rate; };
  for (int e = 0; e < experiments; ++e) {
    PairedSurvival fair(times, 0.0);
    for (int i = 0; i < sample; ++i) fair.add(gone(decay(1.0)), gone(decay(1.0)));
    const PairedResult without = fair.result(static_cast<std::uint64_t>(e), 400);
    wrong += without.p_value <= 0.05 ? 1 : 0;
    // exp(-t) moved by the promised difference at t = 1 alone: some are kept until just behind it.
    const double bias = without.points[2].detectable, among = std::exp(-0.5) - std::exp(-1.0);
    PairedSurvival biased(times, 0.0);
    for (int i = 0; i < sample; ++i) {
      double t = decay(1.0);
      if (t > 0.5 && t <= 1.0 && dice.between(0.0, 1.0) < bias / among) t = 1.01;
      biased.add(gone(t), gone(decay(1.0)));
    }
    found += biased.result(static_cast<std::uint64_t>(e), 400).p_value <= 0.05 ? 1 : 0;
  }
  EXPECT_LE(wrong, 22);   // 10 expected, 4 standard deviations
  EXPECT_GE(found, 136);  // at least 160 expected
}

}  // namespace
}  // namespace carom::tests
