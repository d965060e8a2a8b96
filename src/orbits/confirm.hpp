// Does the engine fly a chain of hits as it says?
#pragma once

#include "carom/events/world.hpp"
#include "carom/orbits/periodic_orbit.hpp"
#include "orbits/boundary.hpp"
#include "orbits/newton.hpp"

namespace carom::orbits {

/// Flies each of an orbit's flights in a world of the table without holes: does it end at the next
/// hit, with nothing in its way, within what the orbit's error makes there?
bool confirmed(const Boundary&, World&, const Solution&, const PeriodicOrbit&);

}  // namespace carom::orbits
