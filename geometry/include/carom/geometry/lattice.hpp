// Periodic repetition in the plane.
#pragma once

#include <cstdint>
#include <vector>

#include "carom/geometry/curve.hpp"
#include "carom/geometry/formulas.hpp"
#include "carom/geometry/vector.hpp"

namespace carom::geometry {

/// Integers that count cells along the two lattice vectors.
struct Cell {
  std::int64_t first = 0, second = 0;
  friend constexpr bool operator==(const Cell&, const Cell&) = default;
};

/// An edge of the cell, run through with the cell on its left, and the cell beyond it.
struct CellEdge {
  Segment segment;
  Cell beyond;
};

/// A lattice with its cell: the convex region around the origin bounded by the bisectors towards
/// the six (or four) nearest lattice vectors (the Voronoi cell), shifted by `centre`. Lattice
/// vectors and cell corners lie on one binary grid, so that translates of an edge by a lattice
/// vector are exact.
struct Lattice {
  Vector first, second;
  std::vector<CellEdge> edges;

  Vector translation(const Cell& c) const {
    return {static_cast<double>(c.first) * first.x + static_cast<double>(c.second) * second.x,
            static_cast<double>(c.first) * first.y + static_cast<double>(c.second) * second.y};
  }
  /// The point x as it is seen from the cell c.
  Vector seen_from(const Cell& c, const Vector& x) const {
    return less_multiples(x, static_cast<double>(c.first), first, static_cast<double>(c.second),
                          second);
  }
  double cell_area() const {
    return cross(first, second) < 0 ? -cross(first, second) : cross(first, second);
  }
};

/// Builds the lattice and its cell about `centre`. The vectors are rounded once to a grid of 2^-51
/// of the largest component. Throws std::invalid_argument if they are parallel or zero.
Lattice make_lattice(Vector first, Vector second, Vector centre);

}  // namespace carom::geometry
