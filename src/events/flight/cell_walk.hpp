// A line through a grid, cell by cell. docs/developer/many-walls.md has why no cell is missed.
#pragma once

#include <algorithm>
#include <cmath>

#include "events/flight/wall_grid.hpp"

namespace carom::events {

template <class Visit, class Passed>
[[gnu::always_inline]] inline bool WallGrid::walk_line(geometry::Vector point, double delta,
                                                       geometry::Vector velocity,
                                                       const Visit& visit,
                                                       const Passed& passed) const {
  constexpr double u = geometry::unit_roundoff;
  const geometry::Vector slowness{1.0 / velocity.x, 1.0 / velocity.y};
  const double off = delta + 4.0 * u * (std::fabs(point.x) + std::fabs(point.y));
  if (!(off < slack_ && std::fabs(slowness.x) + std::fabs(slowness.y) < HUGE_VAL)) return false;
  const int right = velocity.x > 0.0, up = velocity.y > 0.0;
  // When it comes to a cut.
  const auto x_at = [&](int i) { return (columns_.cut(i) - point.x) * slowness.x; };
  const auto y_at = [&](int k) { return (rows_.cut(k) - point.y) * slowness.y; };
  const int columns = columns_.parts(), rows = rows_.parts();
  int column = columns_.part_about(point.x), row = rows_.part_about(point.y);
  const auto goes_on = [&](double time) { return !(time > 0.0 && passed((1.0 + 4.0 * u) / time)); };
  do {
    const int cell = place(column, row);
    if (cell >= 0 && !is_empty(cell)) {
      visit(cell);
    } else if (const int clear = clearance(column, row); clear > 1) {
      // To the edge of the square of empty cells.
      const double x = x_at(right ? std::min(column + clear, columns)
                                  : std::max(column + 1 - clear, 0)),
                   y = y_at(up ? std::min(row + clear, rows) : std::max(row + 1 - clear, 0)),
                   time = x < y ? x : y;
      if (!goes_on(time)) return true;
      const int i = columns_.part_about(point.x + time * velocity.x),
                k = rows_.part_about(point.y + time * velocity.y);
      column = x < y ? column + (right ? clear : -clear)
                     : std::clamp(i, column - clear + 1, column + clear - 1);
      row = x < y ? std::clamp(k, row - clear + 1, row + clear - 1) : row + (up ? clear : -clear);
      continue;
    }
    const double x = x_at(column + right), y = y_at(row + up);
    if (!goes_on(x < y ? x : y)) return true;
    // Without a branch: a processor cannot guess the side.
    const int sideways = x < y;
    column += (2 * right - 1) * sideways;
    row += (2 * up - 1) * (1 - sideways);
  } while ((static_cast<unsigned>(column) < static_cast<unsigned>(columns)) &
           (static_cast<unsigned>(row) < static_cast<unsigned>(rows)));
  passed(-HUGE_VAL);
  return true;
}

}  // namespace carom::events
