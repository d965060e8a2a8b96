// States of many short trajectories on their way.
#pragma once

#include "carom/motion/state.hpp"

namespace carom::motion {

/// The same as `to = from`, number by number. A number that was just stored by itself can be read
/// by itself at once; two of them are read together only once both are in the cache, and many short
/// trajectories would wait for little else.
inline void take(State& to, const State& from) {
  const auto& [wall, u, position, velocity, cell, time] = from;  // all that a state has
  to.wall = wall;
  to.u = u;
  to.position.x = position.x;
  to.position.y = position.y;
  to.velocity.x = velocity.x;
  to.velocity.y = velocity.y;
  to.cell.first = cell.first;
  to.cell.second = cell.second;
  to.time.high = time.high;
  to.time.low = time.low;
}

}  // namespace carom::motion
