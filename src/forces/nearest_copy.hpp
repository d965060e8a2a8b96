// Distances on a lattice.
#pragma once

#include "carom/geometry/lattice.hpp"

namespace carom::forces {

/// A lattice vector next to d, and d less it.
struct NearestCopy {
  geometry::Vector d;
  geometry::Cell cell;
};
inline NearestCopy nearest_copy_and_cell(geometry::Vector d, const geometry::Lattice& lattice) {
  NearestCopy found{d, {}};
  for (bool moved = true; moved;) {
    moved = false;
    for (const geometry::CellEdge& e : lattice.edges) {
      const geometry::Vector nearer = found.d - lattice.translation(e.beyond);
      if (!(dot(nearer, nearer) < dot(found.d, found.d))) continue;
      found.d = nearer;
      found.cell.first += e.beyond.first;
      found.cell.second += e.beyond.second;
      moved = true;
    }
  }
  return found;
}
/// The shortest of d and its displacements by lattice vectors.
inline geometry::Vector nearest_copy(geometry::Vector d, const geometry::Lattice& lattice) {
  return nearest_copy_and_cell(d, lattice).d;
}

}  // namespace carom::forces
