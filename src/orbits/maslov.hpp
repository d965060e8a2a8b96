// The Maslov index of a periodic orbit.
#pragma once

#include <optional>
#include <vector>

#include "carom/orbits/periodic_orbit.hpp"
#include "orbits/across.hpp"

namespace carom::orbits {

/// As PeriodicOrbit::maslov. docs/physics/periodic-orbits.md derives it.
std::optional<int> maslov_index(const std::vector<FlightAcross>&, Stability);

}  // namespace carom::orbits
