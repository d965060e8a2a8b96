// The list of what is wrong with a region, and the faults of single loops.
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "carom/geometry/region.hpp"

namespace carom::geometry {

class RegionFaults {
 public:
  explicit RegionFaults(std::size_t limit) : limit_(limit) {}
  void add(RegionFault::Kind kind, const std::string& first, const std::string& second,
           Vector place, const std::string& sentence) {
    if (!full()) list_.push_back({kind, first, second, place, sentence});
  }
  bool none() const { return list_.empty(); }
  bool full() const { return list_.size() >= limit_; }
  bool any(RegionFault::Kind kind) const {
    return std::any_of(list_.begin(), list_.end(),
                       [&](const RegionFault& f) { return f.kind == kind; });
  }
  std::vector<RegionFault> take() { return std::move(list_); }

 private:
  std::size_t limit_;
  std::vector<RegionFault> list_;
};

/// "(0.31, 1.2)", with as many digits as asked for.
std::string place_text(Vector place, int digits = 4);

/// Every curve is finite and has an extent.
void check_extent(const Loop& loop, RegionFaults& faults);
/// Every curve starts where the one before ends.
void check_closed(const Loop& loop, RegionFaults& faults);

}  // namespace carom::geometry
