// Does a point lie exactly on a wall?
#pragma once

#include <memory>
#include <vector>

#include "carom/geometry/curve_frame.hpp"
#include "carom/geometry/region.hpp"
#include "carom/table/table.hpp"
#include "events/flight/wall_grid.hpp"

namespace carom::events {

/// A start on a wall needs (wall, u): as two doubles x, y it has no side that it could leave to.
class WallTouch {
 public:
  /// `grid_from`: walls from which on a grid tells which are near.
  explicit WallTouch(const Table& table, int grid_from);
  bool on_wall(geometry::Vector point) const;

 private:
  bool on(std::size_t wall, geometry::Vector point) const;

  std::vector<geometry::Curve> curves_;
  std::vector<geometry::CurveFrame> frames_;
  std::unique_ptr<const WallGrid> grid_;
};

}  // namespace carom::events
