// Does a point lie exactly on a wall?
#pragma once

#include <vector>

#include "carom/geometry/curve_frame.hpp"
#include "carom/geometry/region.hpp"
#include "carom/table/table.hpp"

namespace carom {

/// A start on a wall needs (wall, u): as two doubles x, y it has no side that it could leave to.
class WallTouch {
 public:
  explicit WallTouch(const Table& table);
  bool on_wall(geometry::Vector point) const;

 private:
  std::vector<geometry::CurveFrame> frames_;
  std::vector<geometry::Loop> loops_;
  std::vector<std::size_t> loop_of_;  ///< index of each wall's loop
};

}  // namespace carom
