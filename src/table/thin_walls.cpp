#include "table/thin_walls.hpp"

#include <algorithm>
#include <cmath>

namespace carom::table {

using namespace geometry;

bool FlightSizes::is_thin(const CurveFrame& curve) const {
  if (curve.kind == CurveFrame::Kind::segment || curve.bezier) return false;
  // Two products of two factors, each of up to (longest / minor)^2, and their factors, which err by
  // the rounding of coordinates: docs/physics/exactness.md.
  constexpr double u = 0x1p-53;
  return 8.0 * u * longest * (longest + farthest) > 0x1p-16 * curve.minor * curve.minor;
}

FlightSizes flight_sizes(const Table& table) {
  Vector low{HUGE_VAL, HUGE_VAL}, high{-HUGE_VAL, -HUGE_VAL};
  const auto reach = [&](Vector x) {
    low = {std::min(low.x, x.x), std::min(low.y, x.y)};
    high = {std::max(high.x, x.x), std::max(high.y, x.y)};
  };
  for (const Wall& wall : table.walls) {
    const Box box = bounding_box(wall.curve);
    reach(box.low);
    reach(box.high);
  }
  if (table.lattice)
    for (const CellEdge& edge : table.lattice->edges) reach(edge.segment.from);
  if (!(low.x <= high.x)) return {};
  return {(high.x - low.x) + (high.y - low.y),
          std::max({std::fabs(low.x), std::fabs(low.y), std::fabs(high.x), std::fabs(high.y)})};
}

bool has_thin_walls(const Table& table) {
  const FlightSizes sizes = flight_sizes(table);
  return std::any_of(table.walls.begin(), table.walls.end(), [&](const Wall& wall) {
    return !std::holds_alternative<Segment>(wall.curve) && sizes.is_thin(frame_of(wall.curve));
  });
}

}  // namespace carom::table
