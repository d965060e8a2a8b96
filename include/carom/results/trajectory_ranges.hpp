// Which trajectories of an ensemble a checkpoint, a shard or a merged archive holds.
#pragma once

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <utility>
#include <vector>

namespace carom {

/// Trajectories first … last - 1.
struct TrajectoryRange {
  std::uint64_t first = 0, last = 0;
  bool operator==(const TrajectoryRange&) const = default;
};

/// Part k of N (k from 1 to N < 2^32) of n trajectories. The parts of one N cover 0 … n - 1 once,
/// and their lengths differ by at most one.
inline TrajectoryRange shard(std::uint64_t k, std::uint64_t of, std::uint64_t trajectories) {
  // floor(j n / N) without the product j n, which may not fit.
  const auto end = [&](std::uint64_t j) {
    return trajectories / of * j + trajectories % of * j / of;
  };
  return {end(k - 1), end(k)};
}

/// Part k of N of the trajectories of several ranges, in order: the smallest range that holds it,
/// or an empty one.
inline TrajectoryRange shard(std::uint64_t k, std::uint64_t of,
                             const std::vector<TrajectoryRange>& ranges) {
  std::uint64_t all = 0;
  for (const TrajectoryRange& range : ranges) all += range.last - range.first;
  const TrajectoryRange numbers = shard(k, of, all);
  TrajectoryRange part;
  if (numbers.first == numbers.last) return part;
  std::uint64_t before = 0;
  for (const TrajectoryRange& range : ranges) {
    const std::uint64_t end = before + (range.last - range.first);
    if (before <= numbers.first && numbers.first < end)
      part.first = range.first + (numbers.first - before);
    if (before < numbers.last && numbers.last <= end)
      part.last = range.first + (numbers.last - before);
    before = end;
  }
  return part;
}

/// A set of trajectories as sorted ranges that neither touch nor overlap: equal sets are equal
/// values, in whatever order they were put together.
class TrajectoryRanges {
 public:
  /// Adds a range; false, and no change, where one of its trajectories is there already.
  bool add(TrajectoryRange range) {
    if (range.first >= range.last) return true;
    auto next = std::lower_bound(
        ranges_.begin(), ranges_.end(), range,
        [](const TrajectoryRange& a, const TrajectoryRange& b) { return a.first < b.first; });
    const bool after_one = next != ranges_.begin();
    if (after_one && std::prev(next)->last > range.first) return false;
    if (next != ranges_.end() && next->first < range.last) return false;
    if (next != ranges_.end() && next->first == range.last) {
      range.last = next->last;
      next = ranges_.erase(next);
    }
    if (next != ranges_.begin() && std::prev(next)->last == range.first)
      std::prev(next)->last = range.last;
    else
      ranges_.insert(next, range);
    return true;
  }

  /// Adds all of another set; false, and no change, where they overlap.
  bool add(const TrajectoryRanges& other) {
    if (other.ranges_.size() == 1) return add(other.ranges_.front());
    std::vector<TrajectoryRange> sum;
    sum.reserve(ranges_.size() + other.ranges_.size());
    for (auto a = ranges_.cbegin(), b = other.ranges_.cbegin();
         a != ranges_.end() || b != other.ranges_.end();) {
      const bool first = b == other.ranges_.end() || (a != ranges_.end() && a->first < b->first);
      const TrajectoryRange next = first ? *a++ : *b++;
      if (sum.empty() || sum.back().last < next.first)
        sum.push_back(next);
      else if (sum.back().last == next.first)
        sum.back().last = next.last;
      else
        return false;
    }
    ranges_ = std::move(sum);
    return true;
  }

  /// What is not there of `whole`, in order: the work that is left.
  std::vector<TrajectoryRange> missing_from(TrajectoryRange whole) const {
    std::vector<TrajectoryRange> gaps;
    for (const TrajectoryRange& range : ranges_) {
      if (range.last <= whole.first) continue;
      if (range.first >= whole.last) break;
      if (range.first > whole.first) gaps.push_back({whole.first, range.first});
      whole.first = range.last;
    }
    if (whole.first < whole.last) gaps.push_back(whole);
    return gaps;
  }

  std::uint64_t size() const {
    std::uint64_t sum = 0;
    for (const TrajectoryRange& range : ranges_) sum += range.last - range.first;
    return sum;
  }
  const std::vector<TrajectoryRange>& ranges() const { return ranges_; }
  bool operator==(const TrajectoryRanges&) const = default;

 private:
  std::vector<TrajectoryRange> ranges_;
};

}  // namespace carom
