// Sums of growths: their order, their errors, chaotic shares, bins.
#include "carom/analysis/growth.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include "random_tables.hpp"

namespace carom {
namespace {

using tests::Dice;

double gaussian(Dice& dice) {
  return std::sqrt(-2.0 * std::log(1.0 - dice.unit())) * std::cos(6.283185307179586 * dice.unit());
}

TEST(GrowingHistogram, IsAFunctionOfTheNumbersAlone) {
  Dice dice(1);
  for (int round = 0; round < 50; ++round) {
    std::vector<double> numbers(static_cast<std::size_t>(dice.whole(1, 200)));
    const double size = dice.spread(1e-3, 1e6);
    for (double& x : numbers) x = size * gaussian(dice);
    GrowingHistogram whole, halves[2], sum;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      whole.add(numbers[i]);
      halves[i % 2].add(numbers[numbers.size() - 1 - i]);
    }
    for (const GrowingHistogram& half : halves) sum.merge(half);
    EXPECT_EQ(sum.exponent(), whole.exponent());
    EXPECT_EQ(sum.first(), whole.first());
    EXPECT_EQ(sum.counts(), whole.counts());
    ASSERT_LE(whole.counts().size(), GrowingHistogram::most);
    EXPECT_EQ(std::accumulate(whole.counts().begin(), whole.counts().end(), std::uint64_t{0}),
              numbers.size());
    // Each bin counts what lies in it, and no finer bins would do.
    const double width = std::ldexp(1.0, whole.exponent());
    for (std::size_t i = 0; i < whole.counts().size(); ++i) {
      const double from = static_cast<double>(whole.first() + static_cast<std::int64_t>(i)) * width;
      const auto in = std::count_if(numbers.begin(), numbers.end(),
                                    [&](double x) { return x >= from && x < from + width; });
      EXPECT_EQ(whole.counts()[i], static_cast<std::uint64_t>(in));
    }
    if (whole.exponent() > GrowingHistogram::finest) {
      EXPECT_GT(whole.counts().size(), GrowingHistogram::most / 2);
    }
  }
}

// An orbit whose blocks grow by 2 a time unit on the whole, each with the block's noise and a part
// of the one before.
OrbitGrowth orbit_of(Dice& dice, const GrowthSums& sums, double memory) {
  OrbitGrowth orbit;
  double noise = gaussian(dice);
  for (std::size_t i = 0; i < sums.blocks(); ++i) {
    noise = memory * noise + std::sqrt(1 - memory * memory) * gaussian(dice);
    orbit.growth.push_back(2.0 * sums.block_length() + noise);
    orbit.hits.push_back(static_cast<std::uint64_t>(std::lround(100 + 10 * noise)));
  }
  return orbit;
}

TEST(GrowthSums, ErrorsHoldTheTruthInNineteenOfTwenty) {
  Dice dice(2);
  for (const std::uint64_t orbits : {2u, 20u, 200u}) {
    int held = 0;
    constexpr int rounds = 2000;
    for (int round = 0; round < rounds; ++round) {
      GrowthSums sums({10.0, 90.0}, orbits);
      for (std::uint64_t i = 0; i < orbits; ++i) sums.add(orbit_of(dice, sums, 0.0));
      const LyapunovEstimate e = estimate_of(sums);
      EXPECT_GE(e.block_errors.back().count, GrowthSums::enough_blocks);
      held += std::fabs(e.per_time.value - 2.0) < 1.96 * e.per_time.error;
    }
    // 16 blocks are Student's with 15 degrees: 93 %.
    EXPECT_GT(held, 0.915 * rounds) << orbits;
    EXPECT_LT(held, 0.97 * rounds) << orbits;
  }
}

TEST(GrowthSums, SaysWhenBlocksAreTooShort) {
  Dice dice(3);
  int said = 0, said_of_noise = 0;
  for (int round = 0; round < 200; ++round) {
    for (const bool remembers : {false, true}) {
      GrowthSums sums({0.0, 64.0}, 1);
      ASSERT_EQ(sums.blocks(), 64u);
      sums.add(orbit_of(dice, sums, remembers ? 0.95 : 0.0));
      (remembers ? said : said_of_noise) += !estimate_of(sums).long_enough;
    }
  }
  EXPECT_GT(said, 190);
  EXPECT_LT(said_of_noise, 30);
}

// One orbit between a sea that stretches and islands that do not, where it stays for times whose
// distribution falls by a power 1.5: blocks of 125 that are shorter than many a stay. What it says
// is right: its error holds the truth, or it is doubted.
TEST(GrowthSums, DoubtTheErrorOfAnOrbitThatSticks) {
  Dice dice(6);
  constexpr double block = 125.0, end = 64.0 * block, rate = 0.05;
  const auto orbit = [&] {
    OrbitGrowth made;
    made.growth.assign(64, 0.0);
    made.hits.assign(64, 100);
    bool sea = true;
    for (double t = -3000.0; t < end; sea = !sea) {
      const double stay = sea ? -400.0 * std::log(1.0 - dice.unit())
                              : 200.0 * std::pow(1.0 - dice.unit(), -1 / 1.5);
      for (std::size_t i = 0; sea && i < 64; ++i) {
        const double from = static_cast<double>(i) * block;
        made.growth[i] +=
            rate * std::max(0.0, std::min(t + stay, from + block) - std::max(t, from));
      }
      t += stay;
    }
    for (double& growth : made.growth) growth += 0.05 * std::sqrt(block) * gaussian(dice);
    return made;
  };
  const auto estimate = [&](const OrbitGrowth& one) {
    GrowthSums sums({0.0, end}, 1);
    sums.add(one);
    return estimate_of(sums);
  };
  constexpr int rounds = 1000;
  double truth = 0.0;
  for (int round = 0; round < 4 * rounds; ++round)
    truth += estimate(orbit()).per_time.value / (4 * rounds);
  int held = 0, doubted = 0, right = 0;
  for (int round = 0; round < rounds; ++round) {
    const LyapunovEstimate e = estimate(orbit());
    const bool holds = std::fabs(e.per_time.value - truth) < 2.13 * e.per_time.error;
    held += holds;
    doubted += !e.long_enough;
    right += holds || !e.long_enough;
  }
  EXPECT_LT(held, 0.9 * rounds);
  EXPECT_GT(doubted, 0.7 * rounds);
  EXPECT_GT(right, 0.9 * rounds);
}

TEST(GrowthSums, PartsAddUpToTheSameBits) {
  Dice dice(4);
  GrowthSums whole({1.0, 5.0}, 8), parts[2] = {whole, whole};
  for (int i = 0; i < 8; ++i) {
    OrbitGrowth orbit = orbit_of(dice, whole, 0.3);
    orbit.regularity = i % 3 == 0 ? Regularity::regular : Regularity::chaotic;
    orbit.look = static_cast<std::size_t>(i);
    whole.add(orbit);
    parts[i % 2].add(orbit);
  }
  parts[1].merge(parts[0]);
  const LyapunovEstimate one = estimate_of(whole), other = estimate_of(parts[1]);
  EXPECT_EQ(one.per_time.value, other.per_time.value);
  EXPECT_EQ(one.per_time.error, other.per_time.error);
  EXPECT_EQ(one.per_hit.value, other.per_hit.value);
  EXPECT_EQ(one.per_hit.error, other.per_hit.error);
  EXPECT_EQ(one.chaotic.value, other.chaotic.value);
  EXPECT_EQ(parts[1].totals().chaotic_at, whole.totals().chaotic_at);
}

// Half of the orbits are chaotic; of these a part sticks, and a share 1/t of it shows after t.
TEST(GrowthSums, CountsChaoticOrbitsThatHaveNotShownYet) {
  Dice dice(5);
  int held = 0;
  constexpr int rounds = 200;
  for (int round = 0; round < rounds; ++round) {
    GrowthSums sums({0.0, 1024.0}, 1000);
    constexpr int orbits = 10000;
    for (int i = 0; i < orbits; ++i) {
      OrbitGrowth orbit;
      orbit.growth = {1.0}, orbit.hits = {1};
      const bool chaotic = dice.coin();
      const double shows = dice.unit() < 0.1 ? 8.0 / dice.unit() : 1.0;
      orbit.regularity = Regularity::regular;
      for (std::size_t look = 0; chaotic && look < GrowthSums::looks; ++look) {
        if (sums.look_time(look) < shows) continue;
        orbit.regularity = Regularity::chaotic;
        orbit.look = look;
        break;
      }
      sums.add(orbit);
    }
    const LyapunovEstimate e = estimate_of(sums);
    held += std::fabs(e.chaotic_share.value - 0.5) < 1.96 * e.chaotic_share.error;
  }
  EXPECT_GT(held, 0.90 * rounds);
}

TEST(Regularity, ShearIsRegularAndExponentialsAreNot) {
  for (const double hits : {10.0, 1e3, 1e6}) {
    const double n = hits;
    for (const double constant : {0.01, 1.0, 100.0})
      EXPECT_EQ(regularity_of(2 * std::log(constant * hits + 1), n), Regularity::regular);
    if (hits > 50) {
      EXPECT_EQ(regularity_of(2 * 0.5 * hits, n), Regularity::chaotic);
    }
    EXPECT_EQ(regularity_of(20 + 2 * std::log(hits), n), Regularity::undecided);
  }
}

}  // namespace
}  // namespace carom
