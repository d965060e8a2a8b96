// The state of a particle between two events.
#pragma once

#include "carom/base/time.hpp"
#include "carom/geometry/lattice.hpp"
#include "carom/geometry/vector.hpp"

namespace carom {

/// What does not change along an orbit (except for the speed: by forces and contacts). omega =
/// charge B / mass (a = omega (v_y, -v_x)).
struct Particle {
  double mass = 1.0;
  double charge = 1.0;
  double speed = 1.0;
  double omega = 0.0;
  double radius = 0.0;  ///< of a hard disc; 0: a point
};

/// The state after the last event that moved the particle. On a wall the exact position is
/// (wall, u) in the cell `cell`; `position` is its rounded image in that cell. Off the walls
/// (wall == -1) the two doubles of `position` are exact. The velocity is exact and points into the
/// domain.
struct State {
  int wall = -1;
  double u = 0.0;
  geometry::Vector position;
  geometry::Vector velocity;
  geometry::Cell cell;
  Time time;
};

/// How a trajectory ended (docs/physics/conventions.md).
enum class Fate : unsigned char {
  survived,   ///< still there at t_max
  pinned,     ///< on a cyclotron orbit that can never hit anything: survives
  capped,     ///< ended by the cap on hits: survives
  escaped,    ///< left through a hole
  singular,   ///< its exact path ends at a corner without a continuation, or runs along a wall
  unbounded,  ///< no wall follows any more: gone since its last hit
  lost,       ///< an internal error
  unresolved  ///< its integration could not follow: forces or walls that a step does not resolve
};
inline constexpr Fate last_fate = Fate::unresolved;
const char* name_of(Fate);
/// Nothing is known of what would come after.
inline bool is_failure(Fate fate) { return fate == Fate::lost || fate == Fate::unresolved; }

}  // namespace carom
