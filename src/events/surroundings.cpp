#include "events/surroundings.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace carom {

using geometry::Cell;
using geometry::Vector;

namespace {

/// Copies of a wall that a particle in the lattice's cell may meet within a step that is shorter than
/// the cell.
constexpr std::int64_t copies = 2;

}  // namespace

std::vector<Barrier<double>> barriers_of(const geometry::Curve& curve, int wall,
                                         const std::optional<geometry::Lattice>& lattice) {
  std::vector<Barrier<double>> barriers;
  const std::int64_t range = lattice ? copies : 0;
  for (std::int64_t m = -range; m <= range; ++m)
    for (std::int64_t n = -range; n <= range; ++n) {
      const Cell cell{m, n};
      barriers.push_back(barrier_of<double>(curve, lattice ? lattice->translation(cell) : Vector{}));
      barriers.back().wall = wall;
      barriers.back().cell = cell;
    }
  return barriers;
}

double longest_way(const Table& table) {
  double length = std::numeric_limits<double>::infinity();
  if (table.lattice) {
    for (const geometry::CellEdge& e : table.lattice->edges) {
      const Vector t = table.lattice->translation(e.beyond);
      length = std::min(length, std::sqrt(dot(t, t)));
    }
  } else if (table.extent == Extent::bounded) {
    length = 0.0;
    for (const Wall& wall : table.walls) {
      const geometry::Box box = geometry::bounding_box(wall.curve);
      length = std::max({length, box.high.x - box.low.x, box.high.y - box.low.y});
    }
    length *= 1000.0;
  }
  return length;
}

}  // namespace carom
