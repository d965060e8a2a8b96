// Sums of growths: their order, their errors, chaotic shares, bins.
#include "carom/analyses/lyapunov/growth.hpp"

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
    // Of few orbits the larger of two errors holds: in 97 %.
    EXPECT_GT(held, 0.935 * rounds) << orbits;
    EXPECT_LT(held, 0.985 * rounds) << orbits;
  }
}

TEST(GrowthSums, SaysWhenBlocksAreTooShort) {
  Dice dice(3);
  int said = 0, said_of_noise = 0;
  for (int round = 0; round < 200; ++round) {
    for (const bool remembers : {false, true}) {
      GrowthSums sums({0.0, 6400.0}, 1);
      ASSERT_EQ(sums.blocks(), GrowthSums::wanted_blocks);
      sums.add(orbit_of(dice, sums, remembers ? 0.95 : 0.0));
      (remembers ? said : said_of_noise) += !estimate_of(sums).long_enough;
    }
  }
  EXPECT_GT(said, 190);
  EXPECT_LT(said_of_noise, 30);
}

// One orbit between a sea that stretches and parallel walls between which it does not, where it
// stays for times whose number falls as their square: its variance grows as t ln t, and blocks
// shorter than the longest stays tell too little. What is said is right: the error holds the truth,
// or it is doubted.
TEST(GrowthSums, KnowOrDoubtTheErrorOfAnOrbitThatSticks) {
  Dice dice(6);
  constexpr double end = 6000.0, rate = 4.0;
  const GrowthSums plan({0.0, end}, 1);
  const double block = plan.block_length();
  const auto orbit = [&] {
    OrbitGrowth made;
    made.growth.assign(plan.blocks(), 0.0);
    made.hits.assign(plan.blocks(), 100);
    made.regularity = Regularity::chaotic;
    made.flights = end;
    bool sea = true;
    for (double t = -1000.0; t < end; sea = !sea) {
      const double stay =
          sea ? -40.0 * std::log(1.0 - dice.unit()) : 20.0 / std::sqrt(1.0 - dice.unit());
      const double from = std::max(0.0, t), to = std::min(end, t + stay);
      for (auto i = static_cast<std::size_t>(from / block); sea && i < plan.blocks(); ++i) {
        const double begin = static_cast<double>(i) * block;
        if (begin >= to) break;
        made.growth[i] += rate * std::max(0.0, std::min(to, begin + block) - std::max(from, begin));
      }
      t += stay;
    }
    for (double& growth : made.growth) growth += 0.3 * std::sqrt(block) * gaussian(dice);
    return made;
  };
  constexpr int rounds = 1000;
  std::vector<LyapunovEstimate> estimates;
  double truth = 0.0;
  for (int round = 0; round < rounds; ++round) {
    GrowthSums sums = plan;
    sums.add(orbit());
    estimates.push_back(estimate_of(sums));
    truth += estimates.back().per_time.value / rounds;
  }
  int plain = 0, held = 0, right = 0;
  for (const LyapunovEstimate& e : estimates) {
    const double distance = std::fabs(e.per_time.value - truth);
    plain += distance < 1.96 * e.block_errors.back().error;
    held += distance < 1.96 * e.per_time.error;
    right += distance < 1.96 * e.per_time.error || !e.long_enough;
  }
  EXPECT_LT(plain, 0.9 * rounds);
  EXPECT_GT(held, 0.93 * rounds);
  EXPECT_GT(right, 0.95 * rounds);
}

TEST(GrowthSums, PartsAddUpToTheSameBits) {
  Dice dice(4);
  GrowthSums whole({1.0, 5.0}, 8), parts[2] = {whole, whole};
  for (int i = 0; i < 8; ++i) {
    OrbitGrowth orbit = orbit_of(dice, whole, 0.3);
    orbit.regularity = i % 3 == 0 ? Regularity::linear : Regularity::chaotic;
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
  EXPECT_EQ(whole.totals().chaotic_growth.state(), parts[1].totals().chaotic_growth.state());
  EXPECT_EQ(parts[1].totals().chaotic_at, whole.totals().chaotic_at);
}

// Half of the orbits are chaotic; of these a part sticks, and a share 1/t of it shows after t.
GrowthSums half_chaotic(Dice& dice, int orbits, double t_end, double rate) {
  GrowthSums sums({0.2 * t_end, t_end}, static_cast<std::uint64_t>(orbits));
  for (int i = 0; i < orbits; ++i) {
    OrbitGrowth orbit;
    orbit.flights = t_end;
    orbit.growth = {std::log(5.0)}, orbit.hits = {static_cast<std::uint64_t>(t_end)};
    orbit.regularity = Regularity::linear;
    const bool chaotic = dice.coin();
    const double leaves = dice.unit() < 0.1 ? 8.0 / dice.unit() : 1.0;
    const auto spread = [&](double t) { return 2.0 * rate * std::max(0.0, t - leaves); };
    if (chaotic) orbit.growth = {std::max(std::log(5.0), 0.8 * 0.5 * spread(t_end))};
    for (std::size_t look = 0; chaotic && look < GrowthSums::looks; ++look) {
      orbit.regularity =
          regularity_of(spread(sums.look_time(look)) + 2.0 * std::log(sums.look_time(look) + 1.0),
                        sums.look_time(look));
      orbit.look = look;
      if (orbit.regularity == Regularity::chaotic) break;
    }
    sums.add(orbit);
  }
  return sums;
}

TEST(GrowthSums, CountsChaoticOrbitsThatHaveNotShownYet) {
  Dice dice(5);
  int held = 0;
  constexpr int rounds = 200;
  for (int round = 0; round < rounds; ++round) {
    const LyapunovEstimate e = estimate_of(half_chaotic(dice, 10000, 300.0, 0.4));
    ASSERT_TRUE(e.tells_regular);
    EXPECT_GT(e.hidden, 0.0);
    held += e.share_interval.low < 0.5 && 0.5 < e.share_interval.high;
  }
  EXPECT_GT(held, 0.94 * rounds);
}

// No orbit is regular, and there is no share, before chaotic ones have had the time to show.
TEST(GrowthSums, TellNoShareOfShortRuns) {
  Dice dice(7);
  for (const double t : {5.0, 20.0, 40.0, 80.0}) {
    const LyapunovEstimate e = estimate_of(half_chaotic(dice, 2000, t, 0.4));
    EXPECT_FALSE(e.tells_regular) << t;
    EXPECT_TRUE(std::isnan(e.chaotic_share.value)) << t;
    EXPECT_TRUE(std::isnan(e.chaotic.value)) << t;
  }
}

// Regular orbits grow, too, as the logarithm of the time: that is no exponent.
TEST(GrowthSums, TakeRegularOrbitsForZero) {
  Dice dice(8);
  const GrowthSums half = half_chaotic(dice, 20000, 200.0, 0.4);
  const LyapunovEstimate mixed = estimate_of(half);
  const double linear_growth = mean_growth_of(half).per_time.value - mixed.per_time.value;
  EXPECT_NEAR(linear_growth, 0.5 * std::log(5.0) / 160.0, 2e-4);
  EXPECT_NEAR(mixed.chaotic.value, mixed.per_time.value / 0.5, 3 * mixed.chaotic.error);
  const auto linear = [](double flights) {
    GrowthSums sums({0.2 * flights, flights}, 100);
    OrbitGrowth orbit;
    orbit.growth = {std::log(5.0)}, orbit.hits = {10}, orbit.flights = flights;
    orbit.regularity = Regularity::linear;
    for (int i = 0; i < 100; ++i) sums.add(orbit);
    return sums;
  };
  const LyapunovEstimate regular = estimate_of(linear(1000.0));
  EXPECT_EQ(regular.law, LyapunovEstimate::Law::linear);
  EXPECT_EQ(regular.per_time.value, 0.0);
  EXPECT_GT(regular.would_show, 0.005);
  EXPECT_LT(regular.would_show, 0.02);
  EXPECT_TRUE(std::isnan(regular.chaotic_share.value));
  const LyapunovEstimate unknown = estimate_of(linear(20.0));
  EXPECT_EQ(unknown.law, LyapunovEstimate::Law::unknown);
  EXPECT_TRUE(std::isnan(unknown.per_time.value));
  EXPECT_FALSE(unknown.tells_regular);
  const LyapunovEstimate known = estimate_of(linear(20.0), true);
  EXPECT_EQ(known.per_time.value, 0.0);
  EXPECT_EQ(known.per_time.error, 0.0);
  EXPECT_EQ(known.chaotic_share.value, 0.0);
}

TEST(GrowthSums, QuantilesLieWithinBins) {
  const std::vector<ExponentBin> bins{{0.0, 1.0, 4}, {1.0, 2.0, 0}, {2.0, 4.0, 4}};
  EXPECT_EQ(quantile_of(bins, 0.25), 0.5);
  EXPECT_EQ(quantile_of(bins, 0.5), 1.0);
  EXPECT_EQ(quantile_of(bins, 0.75), 3.0);
  EXPECT_EQ(quantile_of(bins, 1.0), 4.0);
  EXPECT_TRUE(std::isnan(quantile_of({}, 0.5)));
}

TEST(Regularity, ShearIsLinearAndExponentialsAreNot) {
  for (const double hits : {10.0, 1e3, 1e6}) {
    const double n = hits;
    for (const double constant : {0.01, 1.0, 100.0})
      EXPECT_EQ(regularity_of(2 * std::log(constant * hits + 1), n), Regularity::linear);
    if (hits > 50) {
      EXPECT_EQ(regularity_of(2 * 0.5 * hits, n), Regularity::chaotic);
    }
    EXPECT_EQ(regularity_of(20 + 2 * std::log(hits), n), Regularity::undecided);
  }
}

}  // namespace
}  // namespace carom
