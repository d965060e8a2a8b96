#include "starts/cover.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace carom::starts {

namespace {

using geometry::CurveFrame;
using geometry::Vector;

struct Grid {
  Vector low, cell;
  std::size_t columns, rows;
  std::vector<char> met;  ///< by an edge; column after column

  // The cells that the square of that half side around a point touches.
  void mark(Vector point, double reach) {
    const auto number = [](double from_low, double side, std::size_t most) {
      return static_cast<std::int64_t>(
          std::clamp(std::floor(from_low / side), -1.0, static_cast<double>(most)));
    };
    const Vector at = point - low;
    const auto last_column = static_cast<std::int64_t>(columns) - 1,
               last_row = static_cast<std::int64_t>(rows) - 1;
    const std::int64_t from = std::max<std::int64_t>(0, number(at.x - reach, cell.x, columns)),
                       to = std::min(last_column, number(at.x + reach, cell.x, columns)),
                       down = std::max<std::int64_t>(0, number(at.y - reach, cell.y, rows)),
                       up = std::min(last_row, number(at.y + reach, cell.y, rows));
    for (std::int64_t x = from; x <= to; ++x)
      for (std::int64_t y = down; y <= up; ++y)
        met[static_cast<std::size_t>(x) * rows + static_cast<std::size_t>(y)] = 1;
  }

  // Of the points taken from an edge neighbours are at most a quarter of a side apart, so that each
  // point of the edge is within an eighth of one of them; the square around that one reaches twice
  // as far, and touches the cell.
  void mark(const CurveFrame& edge, double side) {
    const double step = side / 4;
    // |dr/du| of a conic is at most twice its major semi-axis.
    const double speed = edge.kind == CurveFrame::Kind::segment ? std::sqrt(dot(edge.a, edge.a))
                         : edge.bezier                          ? 1.5 * edge.bezier->speed
                                       : 2.0 * std::max(edge.major, edge.minor);
    const double steps = std::ceil(speed * edge.end / step) + 1.0;
    for (double i = 0.0; i <= steps; i += 1.0)
      mark(geometry::point_at(edge, std::min(edge.end, edge.end * (i / steps))), step);
  }
};

}  // namespace

Cover::Cover(const geometry::Box& box, const std::vector<CurveFrame>& edges,
             const std::function<bool(Vector)>& contains)
    : low_(box.low) {
  const Vector size = box.high - box.low;
  const double side = std::max(size.x, size.y) / across;
  const double columns = std::ceil(size.x / side), rows = std::ceil(size.y / side);
  cell_ = {size.x / columns, size.y / rows};
  Grid grid{low_, cell_, static_cast<std::size_t>(columns), static_cast<std::size_t>(rows), {}};
  grid.met.resize(grid.columns * grid.rows);
  for (const CurveFrame& edge : edges) grid.mark(edge, side);
  for (std::size_t x = 0; x < grid.columns; ++x) {
    const double left = static_cast<double>(x);
    Column column{low_.x + left * cell_.x, cells_, 0.0, {}};
    // Cells one above the other that an edge meets, or that none does.
    const auto begin = grid.met.begin() + static_cast<std::ptrdiff_t>(x * grid.rows),
               end = begin + static_cast<std::ptrdiff_t>(grid.rows);
    bool below = false;
    for (auto from = begin; from != end;) {
      const auto to = std::find(from, end, *from == 0 ? 1 : 0);
      const double first = static_cast<double>(from - begin);
      const bool keep = *from != 0 || contains({low_.x + (left + 0.5) * cell_.x,
                                                low_.y + (first + 0.5) * cell_.y});
      if (keep && !below) column.runs.push_back({first, column.cells});
      if (keep) column.cells += static_cast<double>(to - from);
      below = keep;
      from = to;
    }
    cells_ += column.cells;
    if (column.cells > 0.0) columns_.push_back(std::move(column));
  }
}

Vector Cover::point(double u, double v) const {
  const double number = u * cells_;
  const auto column =
      std::prev(std::upper_bound(columns_.begin() + 1, columns_.end(), number,
                                 [](double cells, const Column& c) { return cells < c.before; }));
  const double along = (number - column->before) / column->cells, up = v * column->cells;
  const auto run =
      std::prev(std::upper_bound(column->runs.begin() + 1, column->runs.end(), up,
                                 [](double cells, const Run& r) { return cells < r.before; }));
  return {column->x + along * cell_.x, low_.y + (run->first + (up - run->before)) * cell_.y};
}

}  // namespace carom::starts
