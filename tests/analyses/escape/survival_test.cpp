#include "carom/analyses/escape/survival.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "carom/base/error.hpp"

namespace carom {
namespace {

// As a sum to which parts are added.
TEST(Survival, CountsMadeWithoutTimesCount) {
  SurvivalCounts counts;
  counts.add(Fate::escaped, 3.0, 5, -1);
  EXPECT_EQ(counts.escaped, 1u);
  EXPECT_TRUE(counts.gone_in.empty());
  EXPECT_EQ(counts.gone_at.total(), 1u);
}

TEST(Wilson, HasTheTabulatedEnds) {
  // (k, n) and the ends to four digits, from the closed form by hand.
  const Interval none = wilson_interval(0, 10), half = wilson_interval(5, 10),
                 all = wilson_interval(10, 10);
  EXPECT_EQ(none.low, 0.0);
  EXPECT_NEAR(none.high, 0.2775, 5e-5);
  EXPECT_NEAR(half.low, 0.2366, 5e-5);
  EXPECT_NEAR(half.high, 0.7634, 5e-5);
  EXPECT_NEAR(all.low, 0.7225, 5e-5);
  EXPECT_EQ(all.high, 1.0);
}

TEST(Wilson, ContainsTheShareAndMirrors) {
  for (const std::uint64_t n : {1u, 2u, 17u, 1000u, 4000000000u}) {
    for (std::uint64_t i = 0; i <= 16; ++i) {
      const std::uint64_t k = n / 16 * i + std::min<std::uint64_t>(n % 16, i);
      const Interval at = wilson_interval(k, n), mirrored = wilson_interval(n - k, n);
      const double p = static_cast<double>(k) / static_cast<double>(n);
      EXPECT_LE(at.low, p);
      EXPECT_GE(at.high, p);
      EXPECT_NEAR(at.low, 1.0 - mirrored.high, 1e-15);
    }
  }
  EXPECT_EQ(wilson_interval(0, 0).low, 0.0);
  EXPECT_EQ(wilson_interval(0, 0).high, 1.0);
}

TEST(Wilson, CoversAboutNinetyFivePercent) {
  std::mt19937_64 random(3);
  std::binomial_distribution<std::uint64_t> draw(200, 0.13);
  int inside = 0;
  constexpr int repeats = 20000;
  for (int i = 0; i < repeats; ++i) {
    const Interval at = wilson_interval(draw(random), 200);
    inside += at.low <= 0.13 && 0.13 <= at.high;
  }
  EXPECT_NEAR(static_cast<double>(inside) / repeats, 0.95, 0.02);
}

TEST(ReportedHits, RunToTheEndOfTheScale) {
  const auto& n = reported_hits();
  EXPECT_TRUE(std::is_sorted(n.begin(), n.end()));
  const std::vector<std::uint64_t> first(n.begin(), n.begin() + 9);
  EXPECT_EQ(first, (std::vector<std::uint64_t>{0, 1, 2, 3, 5, 10, 20, 30, 50}));
  EXPECT_EQ(n.back(), 5'000'000'000'000'000'000u);
}

TEST(Survival, IsGoneAtTheReportedTimeItself) {
  SurvivalCounts counts({1.0, 2.0}, 1);
  counts.add(Fate::escaped, 1.0, 3, 0);
  counts.add(Fate::escaped, std::nextafter(1.0, 2.0), 4, 0);
  counts.add(Fate::survived, 2.0, 9, -1);
  const auto p = survival(counts);
  EXPECT_DOUBLE_EQ(p[0].p, 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(p[1].p, 1.0 / 3.0);
  const auto hits = survival_by_hits(counts);
  EXPECT_EQ(hits.back().n, 10u) << "the first number that none exceeded";
  EXPECT_DOUBLE_EQ(hits[2].p, 1.0);
  EXPECT_DOUBLE_EQ(hits[3].p, 2.0 / 3.0) << "three hits, then gone";
  EXPECT_DOUBLE_EQ(hits[4].p, 1.0 / 3.0);
}

TEST(Survival, LeavesSingularUnresolvedAndLostOnesOut) {
  SurvivalCounts counts({10.0}, 0);
  counts.add(Fate::singular, 1.0, 1, -1);
  counts.add(Fate::lost, 1.0, 1, -1);
  counts.add(Fate::unresolved, 1.0, 1, -1);
  counts.add(Fate::unbounded, 2.0, 1, -1);
  counts.add(Fate::pinned, 10.0, 0, -1);
  counts.add(Fate::capped, 3.0, 5, -1);
  EXPECT_EQ(counts.trajectories, counts.all());
  EXPECT_LE(counts.unbounded, counts.escaped);
  EXPECT_EQ(counts.unresolved, 1u);
  EXPECT_EQ(counts.lost, 1u);
  EXPECT_EQ(counts.survived, 2u);
  EXPECT_EQ(counts.pinned, 1u);
  EXPECT_EQ(counts.capped, 1u);
  EXPECT_DOUBLE_EQ(survival(counts)[0].p, 2.0 / 3.0) << "a capped one is still there";
}

// Of particles that are counted by their fates alone, too.
TEST(FateCounts, EachParticleIsInOneSum) {
  FateCounts counts;
  for (int fate = 0; fate <= static_cast<int>(last_fate); ++fate)
    counts.count(static_cast<Fate>(fate));
  EXPECT_EQ(counts.all(), static_cast<std::uint64_t>(last_fate) + 1);
  EXPECT_EQ(counts.survived, 3u) << "those that are pinned and capped, too";
  EXPECT_EQ(counts.until_last_time(), 2u);
  EXPECT_EQ(counts.escaped, 2u) << "those that are unbounded, too";
}

SurvivalCounts random_counts(unsigned seed, int n) {
  std::mt19937_64 random(seed);
  SurvivalCounts counts({0.5, 1.0, 4.0}, 2);
  for (int i = 0; i < n; ++i) {
    const auto fate = static_cast<Fate>(random() % 8);
    counts.add(fate, static_cast<double>(random() % 600) / 100.0, random() % 50,
               static_cast<int>(random() % 2));
  }
  return counts;
}

TEST(Survival, MergesInAnyOrder) {
  SurvivalCounts forwards({0.5, 1.0, 4.0}, 2), backwards = forwards;
  for (unsigned i = 0; i < 8; ++i) forwards.merge(random_counts(i, 100));
  for (unsigned i = 8; i-- > 0;) backwards.merge(random_counts(i, 100));
  EXPECT_EQ(forwards.gone_in, backwards.gone_in);
  EXPECT_EQ(forwards.gone_in_hits, backwards.gone_in_hits);
  EXPECT_EQ(forwards.hole_escapes, backwards.hole_escapes);
  EXPECT_EQ(forwards.trajectories, 800u);
  EXPECT_EQ(forwards.most_hits, backwards.most_hits);
  EXPECT_EQ(forwards.collisions, backwards.collisions);
  EXPECT_THROW(forwards.merge(SurvivalCounts({1.0}, 2)), InternalError);
}

TEST(EscapeRate, RatesSumToTheEscapedShare) {
  const SurvivalCounts counts = random_counts(1, 5000);
  double gone = 0.0, last = 0.0;
  for (const RatePoint& r : escape_rate(counts)) {
    EXPECT_EQ(r.from, last);
    last = r.to;
    EXPECT_LE(r.low, r.value);
    EXPECT_GE(r.high, r.value);
    EXPECT_GT(r.t, r.from);
    EXPECT_LT(r.t, r.to);
    gone += r.value * (r.to - r.from);
  }
  EXPECT_NEAR(gone, 1.0 - survival(counts).back().p, 1e-12);
}

}  // namespace
}  // namespace carom
