// Free corridors of a periodic table: straight strips between the obstacles that never end.
#pragma once

#include <vector>

#include "carom/geometry/curve.hpp"
#include "carom/geometry/lattice.hpp"

namespace carom::geometry {

/// An open strip along a lattice vector that no obstacle enters.
struct Corridor {
  Cell direction;  ///< coefficients of `along`: coprime, first > 0, or first == 0 and second == 1
  Vector along;    ///< shortest lattice vector of that direction
  double width = 0.0;  ///< > 0, rounded
};

/// The free corridors of a lattice of obstacles.
struct Corridors {
  std::vector<Corridor> list;  ///< widest first
  /// False where there were too many directions to look at all of them: then only those with the
  /// shortest vectors, which hold the widest corridors of a single obstacle, have been.
  bool complete = true;
  /// False where a wall is an arc of an ellipse, for which this is not decided: then the list is
  /// empty.
  bool decided = true;
};

/// A strip along the lattice vector p is free if the obstacles, projected across p, leave a gap of
/// the period; it needs |p| < cell area / width of an obstacle, so few directions are possible.
/// Whether there is a gap is a sign of an exact number: discs that a line touches from both sides
/// leave none. The walls must close to loops, each loop's walls one after the other.
Corridors free_corridors(const Lattice&, const std::vector<Curve>& walls);

/// The limit of t P(t) where P(t) is the share of straight flights of unit speed without a hit
/// until t, when starts are uniform in the free area of a cell: sum of width^2 |along| / (pi area).
double flight_tail(const Corridors&, double free_area);

}  // namespace carom::geometry
