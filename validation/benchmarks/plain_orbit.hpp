// Orbits in plain MPFR numbers: the formulas of certified orbits, each operation rounded once.
// Nothing tells how many digits are right: these orbits are for comparison with certified ones.
#pragma once

#include <cstdint>
#include <string>

#include "carom/certify/exact_system.hpp"
#include "carom/geometry/lattice.hpp"

namespace carom::bench {

/// The state after the last hit.
struct PlainEnd {
  std::uint64_t collisions = 0;
  int wall = -1;
  geometry::Cell cell;
  std::string t, x, y, vx, vy;  ///< all digits of the precision, right or wrong
};

/// Follows the orbit until it has had that many collisions, or no wall is found. Holes are closed.
PlainEnd plain_orbit(const ExactSystem&, std::uint64_t collisions, long bits);

}  // namespace carom::bench
