// The walls and the particle that an orbit is looked for with.
#pragma once

#include <vector>

#include "carom/geometry/curve_frame.hpp"
#include "carom/geometry/vector.hpp"
#include "carom/motion/state.hpp"
#include "carom/table/table.hpp"

namespace carom::orbits {

/// 2^-53.
inline constexpr double unit_roundoff = 0x1p-53;

struct Boundary {
  /// Refers to the table. Holes count as walls.
  Boundary(const Table&, const Particle&);

  const Table* table;
  Particle particle;
  std::vector<geometry::CurveFrame> frames;  ///< of the walls
  double size = 0.0;  ///< largest coordinate of a wall, in size; of a lattice vector, too

  /// Curvature of flights with the sign of omega: positive turns clockwise.
  double flight_curvature() const { return particle.omega / particle.speed; }
};

/// A point of a wall with what the equations of an orbit need.
struct WallPoint {
  geometry::Vector position, tangent, normal;
  double curvature = 0.0;
};
WallPoint wall_point(const Boundary&, int wall, double u);

/// The parameter of the wall's point that lies `distance` from u along the tangent, seen from the
/// wall's centre: a step of Newton's that stays on the wall. `left_wall` is set where the wall ends
/// before.
double moved_along(const Boundary&, int wall, double u, double distance, bool& left_wall);

}  // namespace carom::orbits
