// Distances on a lattice.
#pragma once

#include "carom/geometry/lattice.hpp"

namespace carom::forces {

/// The shortest of d and its displacements by lattice vectors.
inline geometry::Vector nearest_copy(geometry::Vector d, const geometry::Lattice& lattice) {
  for (bool moved = true; moved;) {
    moved = false;
    for (const geometry::CellEdge& e : lattice.edges) {
      const geometry::Vector nearer = d - lattice.translation(e.beyond);
      if (!(dot(nearer, nearer) < dot(d, d))) continue;
      d = nearer;
      moved = true;
    }
  }
  return d;
}

}  // namespace carom::forces
