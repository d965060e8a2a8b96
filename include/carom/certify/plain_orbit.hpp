// Orbits in plain arithmetic of any precision (MPFR): the formulas of certified orbits, without a guarantee.
// For comparison: it is never known how many of the digits are right.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "carom/certify/exact_system.hpp"
#include "carom/geometry/lattice.hpp"

namespace carom {

/// What an orbit is asked for.
struct PlainTask {
  std::uint64_t collisions = 0;      ///< 0: no cap
  std::optional<ExactNumber> t_max;  ///< last time
  long bits = 53;                    ///< of every number: operations round to nearest
};

/// The end of an orbit: its fate, and the state after the last event.
struct PlainEnd {
  enum Fate : unsigned char { completed, escaped, unbounded, pinned, lost } fate = completed;
  std::uint64_t collisions = 0;
  int wall = -1;                     ///< of the last hit
  int hole = -1;
  geometry::Cell cell;               ///< of the last hit, or of the hole it left through
  std::string t, x, y, vx, vy;       ///< all digits of the precision, right or wrong
};
const char* name_of(PlainEnd::Fate);

/// Throws InputError for what has no such form. `interrupted`, if set, is asked between hits.
PlainEnd plain_orbit(const ExactSystem&, const PlainTask&, const std::function<bool()>& interrupted = {});

}  // namespace carom
