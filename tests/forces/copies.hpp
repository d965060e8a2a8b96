// Copies of bumps on a lattice, one by one: the witness of sums over it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "carom/geometry/lattice.hpp"

namespace carom::forces {

/// The copies that are nearer than `reach` to some point of the cell.
inline std::vector<geometry::Vector> copies_that_reach(const std::vector<geometry::Vector>& centers,
                                                       const geometry::Lattice& lattice,
                                                       double reach) {
  geometry::Vector middle{};
  for (const geometry::CellEdge& e : lattice.edges) middle = middle + e.segment.from;
  middle = (1.0 / static_cast<double>(lattice.edges.size())) * middle;
  double cell = 0.0;
  for (const geometry::CellEdge& e : lattice.edges) {
    const geometry::Vector d = e.segment.from - middle;
    cell = std::max(cell, std::sqrt(dot(d, d)));
  }
  const double longest =
      std::sqrt(std::max(dot(lattice.first, lattice.first), dot(lattice.second, lattice.second)));
  std::vector<geometry::Vector> found;
  for (const geometry::Vector& center : centers) {
    const geometry::Vector offset = center - middle;
    const double far = reach + cell + std::sqrt(dot(offset, offset));
    // |m a + n b| >= max(|m|, |n|) area / longest
    const auto range =
        static_cast<std::int64_t>(std::ceil(far * longest / lattice.cell_area())) + 1;
    for (std::int64_t m = -range; m <= range; ++m)
      for (std::int64_t n = -range; n <= range; ++n) {
        const geometry::Vector copy = center + lattice.translation({m, n});
        const geometry::Vector d = copy - middle;
        if (dot(d, d) <= (reach + cell) * (reach + cell)) found.push_back(copy);
      }
  }
  return found;
}

}  // namespace carom::forces
