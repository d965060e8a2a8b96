// What cannot deal with Bézier curves yet asks here, and says so.
#pragma once

#include "carom/table/table.hpp"

namespace carom::table {

/// The first wall that is a Bézier curve, or null.
inline const Wall* bezier_wall(const Table& table) {
  for (const Wall& wall : table.walls)
    if (std::holds_alternative<geometry::Bezier>(wall.curve)) return &wall;
  return nullptr;
}

}  // namespace carom::table
