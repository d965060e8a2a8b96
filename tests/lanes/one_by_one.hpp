// Starts for FreeLanes, from a list.
#pragma once

#include <functional>
#include <vector>

#include "carom/lanes/lanes.hpp"

namespace carom::tests {

/// Gives them one after the other. They must live as long.
inline std::function<bool(LaneStart&)> one_by_one(const std::vector<LaneStart>& starts) {
  return [&starts, next = std::size_t{0}](LaneStart& start) mutable {
    if (next == starts.size()) return false;
    start = starts[next++];
    return true;
  };
}

}  // namespace carom::tests
