// Newton's method on all hits of a chain at once, and the orbit that it comes to.
#pragma once

#include <cstddef>
#include <optional>

#include "carom/events/world.hpp"
#include "carom/orbits/periodic_orbit.hpp"
#include "orbits/boundary.hpp"
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

/// Flies each of an orbit's flights in a world of the table without holes: does it end at the next
/// hit, with nothing in its way, within what the orbit's error makes there?
bool confirmed(const Boundary&, World&, const Solution&, const PeriodicOrbit&);

/// All of an orbit but holes, copies and what symmetry leaves of it.
PeriodicOrbit describe(const Boundary&, const Solution&);

}  // namespace carom::orbits
