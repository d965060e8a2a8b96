// Newton's method on all hits of a chain at once.
#pragma once

#include <cstddef>
#include <optional>

#include "orbits/chain.hpp"

namespace carom::orbits {

/// A chain that solves its equations as far as doubles can.
struct Solution {
  Chain chain;
  ChainGeometry geometry;
  std::size_t lost_rank = 0;  ///< directions in which the equations do not change: families
  double error = 0.0;  ///< bound of each unknown's error, to first order, across these directions
};

/// Newton's steps from a chain: empty where they do not end, leave a wall, make two hits one, or
/// turn a flight beyond a full turn.
std::optional<Solution> solve(const Boundary&, Chain);

}  // namespace carom::orbits
