// From a solved chain to the numbers of its orbit.
#pragma once

#include "carom/orbits/periodic_orbit.hpp"
#include "orbits/newton.hpp"

namespace carom::orbits {

/// All of an orbit but holes, copies and what symmetry leaves of it.
PeriodicOrbit describe(const Boundary&, const Solution&);

}  // namespace carom::orbits
