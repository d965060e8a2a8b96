// Which copies of something on a lattice reach somewhere.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "carom/geometry/curve.hpp"
#include "carom/geometry/lattice.hpp"

namespace carom::geometry {

/// Two cells whose displacements are the shortest vectors that span the lattice.
struct ShortestCells {
  Cell first, second;
};
ShortestCells shortest_cells(const Lattice&);
/// The displacement of a cell, rounded once: Lattice::translation cancels where vectors are far
/// from the shortest.
Vector displacement(const Lattice&, const Cell&);

/// The cells, ordered, whose displacement brings the box `moving` onto `fixed`. One too many is
/// possible, by rounding, one too few is not. Nothing if there are more than `most`. The work is
/// that of the cells found: it is sought along the shortest vectors, however the lattice was
/// written.
std::optional<std::vector<Cell>> cells_that_reach(const Lattice&, const Box& moving,
                                                  const Box& fixed, std::size_t most);

}  // namespace carom::geometry
