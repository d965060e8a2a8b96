// The reference orbit of a system, to a time at which nearby orbits have not separated too far.
#pragma once

#include "orbit.hpp"

namespace resolution {

struct Reference {
  double t_end = 0.0;
  State<Quad> end = {};
  double growth =
      0.0;  ///< of the distance from nearby orbits in phase space, the largest until t_end
  double fastest = 0.0;  ///< largest speed
  double energy_change =
      0.0;  ///< of the orbit in quad precision, relative to the largest kinetic energy
  double quick_distance = 0.0;  ///< from the orbit in long double at t_end
  long steps = 0, hits = 0;
};

/// Ends before nearby orbits have separated by more than `growth`, or after as many steps as a
/// second affords.
Reference reference_orbit(const System& system, double growth);

/// What the reference says against itself; all of these should be about 1e-30 times the growth.
struct SelfTest {
  double finer =
      0.0;  ///< distance from the orbit with half the way a step, higher order, smaller tolerance
  double reversed = 0.0;  ///< distance from the start after turning back
  double force =
      0.0;  ///< difference of the force series from differences of the potential, relative
};
SelfTest self_test(const System& system, const Reference& reference);

}  // namespace resolution
