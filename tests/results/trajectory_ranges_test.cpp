// Sets of trajectories against a plain array of flags.
#include "carom/results/trajectory_ranges.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

namespace carom {
namespace {

TEST(Shard, CoversTheEnsembleOnceInEvenParts) {
  for (std::uint64_t n : {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{7}, std::uint64_t{1000},
                          std::numeric_limits<std::uint64_t>::max()})
    for (std::uint64_t parts : {1u, 2u, 3u, 7u, 64u, 1000u}) {
      std::uint64_t end = 0;
      for (std::uint64_t k = 1; k <= parts; ++k) {
        const TrajectoryRange part = shard(k, parts, n);
        ASSERT_EQ(part.first, end) << k << "/" << parts << " of " << n;
        ASSERT_GE(part.last - part.first, n / parts);
        ASSERT_LE(part.last - part.first - n / parts, 1u);
        end = part.last;
      }
      ASSERT_EQ(end, n);
    }
}

TEST(TrajectoryRanges, AgreeWithFlags) {
  constexpr std::uint64_t n = 40;
  std::mt19937 random(1);
  int refused = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    TrajectoryRanges set;
    std::vector<bool> flags(n);
    for (int step = 0; step < 12; ++step) {
      const std::uint64_t first = random() % n,
                          last = std::min<std::uint64_t>(n, first + random() % 6);
      bool free = true;
      for (std::uint64_t i = first; i < last; ++i) free = free && !flags[i];
      const TrajectoryRanges before = set;
      ASSERT_EQ(set.add(TrajectoryRange{first, last}), free);
      if (!free) {
        ASSERT_EQ(set, before);
        ++refused;
        continue;
      }
      for (std::uint64_t i = first; i < last; ++i) flags[i] = true;
    }
    // Ranges are apart, and with the gaps they make up the whole.
    std::vector<bool> seen(n);
    for (std::size_t i = 0; i < set.ranges().size(); ++i) {
      if (i > 0) {
        ASSERT_LT(set.ranges()[i - 1].last, set.ranges()[i].first);
      }
      for (std::uint64_t j = set.ranges()[i].first; j < set.ranges()[i].last; ++j) seen[j] = true;
    }
    ASSERT_EQ(seen, flags);
    TrajectoryRanges rest;
    for (const TrajectoryRange& gap : set.missing_from({0, n})) ASSERT_TRUE(rest.add(gap));
    ASSERT_EQ(rest.size() + set.size(), n);
    ASSERT_TRUE(rest.add(set));
    ASSERT_EQ(rest.ranges(), (std::vector<TrajectoryRange>{{0, n}}));
    const TrajectoryRanges whole = rest;
    if (set.size() > 0) {
      ASSERT_FALSE(rest.add(set));
    }
    ASSERT_EQ(rest, whole);
  }
  EXPECT_GT(refused, 1000);
}

TEST(TrajectoryRanges, GapsStayInsideAShard) {
  TrajectoryRanges done;
  ASSERT_TRUE(done.add(TrajectoryRange{0, 12}));
  ASSERT_TRUE(done.add(TrajectoryRange{15, 18}));
  ASSERT_TRUE(done.add(TrajectoryRange{25, 40}));
  EXPECT_EQ(done.missing_from({10, 30}), (std::vector<TrajectoryRange>{{12, 15}, {18, 25}}));
  EXPECT_TRUE(done.missing_from({26, 30}).empty());
}

TEST(Shard, OfRangesCoversThemOnce) {
  const std::vector<TrajectoryRange> all{{3, 10}, {12, 13}, {20, 26}};
  for (const std::uint64_t of : {1u, 2u, 3u, 5u, 14u, 40u}) {
    std::uint64_t sum = 0, at = 0;
    for (std::uint64_t k = 1; k <= of; ++k) {
      const TrajectoryRange part = shard(k, of, all);
      if (part.first == part.last) continue;
      EXPECT_GE(part.first, at);
      at = part.last;
      std::uint64_t in_part = 0;
      for (const TrajectoryRange& range : all)
        for (std::uint64_t i = range.first; i < range.last; ++i)
          in_part += i >= part.first && i < part.last;
      EXPECT_LE(in_part, 14 / of + 1);
      sum += in_part;
    }
    EXPECT_EQ(sum, 14u) << of;
  }
  EXPECT_EQ(shard(2, 3, {}), TrajectoryRange{});
  EXPECT_EQ(shard(2, 3, {{5, 17}}), (TrajectoryRange{9, 13}));
}

}  // namespace
}  // namespace carom
