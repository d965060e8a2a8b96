// Trajectories for lanes, from a list of states.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "carom/lanes/lanes.hpp"

namespace carom::bench {

/// Gives them one after the other. They must live as long.
inline std::function<bool(LaneStart&)> each_of(const Particle& particle,
                                               const std::vector<State>& starts) {
  return [&, next = std::size_t{0}](LaneStart& start) mutable {
    if (next == starts.size()) return false;
    start = {next, particle, starts[next], 0};
    ++next;
    return true;
  };
}

}  // namespace carom::bench
