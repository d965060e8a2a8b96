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

/// Of each wall, a number that the pieces of one smooth Bézier curve have in common: that of one of
/// them. A hit may move from one to the next.
std::vector<int> smooth_curves(const Table&);

struct Boundary {
  /// Refers to the table. Holes count as walls.
  Boundary(const Table&, const Particle&);

  const Table* table;
  Particle particle;
  std::vector<geometry::CurveFrame> frames;  ///< of the walls
  std::vector<int> curves;                   ///< smooth_curves()
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

/// The point of a wall, or of the next ones of its curve.
struct WallPlace {
  int wall = 0;
  double u = 0.0;
};
/// The point that lies `distance` along the tangent, seen from the wall's centre, or along a Bézier
/// curve: a step of Newton's that stays on the wall. `left_wall` is set where that ends before.
WallPlace moved_along(const Boundary&, WallPlace, double distance, bool& left_wall);

}  // namespace carom::orbits
