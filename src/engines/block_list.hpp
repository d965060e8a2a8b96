// The blocks of those trajectories that are still to be done.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "carom/results/trajectory_ranges.hpp"

namespace carom::engines {

/// Numbers blocks of at most `block` trajectories through several ranges, in order.
class BlockList {
 public:
  BlockList(std::vector<TrajectoryRange> ranges, std::uint64_t block)
      : ranges_(std::move(ranges)), block_(block) {
    for (const TrajectoryRange& range : ranges_) {
      first_.push_back(size_);
      const std::uint64_t trajectories = range.last - range.first;
      size_ += trajectories / block_ + (trajectories % block_ != 0);
    }
  }

  std::uint64_t size() const { return size_; }
  TrajectoryRange operator[](std::uint64_t number) const {
    const auto after = std::upper_bound(first_.begin(), first_.end(), number);
    const auto at = static_cast<std::size_t>(after - first_.begin()) - 1;
    const std::uint64_t from = ranges_[at].first + (number - first_[at]) * block_;
    return {from, std::min(ranges_[at].last, from + block_)};
  }
  std::uint64_t block() const { return block_; }

 private:
  std::vector<TrajectoryRange> ranges_;
  std::vector<std::uint64_t> first_;  // number of each range's first block
  std::uint64_t block_, size_ = 0;
};

}  // namespace carom::engines
