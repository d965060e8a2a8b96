// Cells of a grid that cover a region, and how the unit square is laid over them.
#pragma once

#include <functional>
#include <vector>

#include "carom/geometry/curve.hpp"
#include "carom/geometry/curve_frame.hpp"

namespace carom::starts {

/// The cells of a grid over a box that a region may reach into. A point drawn in them lies in the
/// region more often than one that is drawn in the box: about one in 200 is missed.
class Cover {
 public:
  static constexpr double across = 1024;  ///< cells along the longer side of the box

  Cover() = default;
  /// `edges` bound the region, whose points `contains` tells; of the cells that no edge meets one
  /// is asked for all beside it.
  Cover(const geometry::Box&, const std::vector<geometry::CurveFrame>& edges,
        const std::function<bool(geometry::Vector)>& contains);
  /// Takes equal areas to equal areas: u runs over the columns, and v up the cells of one.
  geometry::Vector point(double u, double v) const;

 private:
  /// Neighbouring cells of a column that are in the cover.
  struct Run {
    double first, before;  ///< `before`: cells of the column below it that are in the cover
  };
  struct Column {
    double x, before, cells;  ///< `before`: cells of the columns to its left
    std::vector<Run> runs;
  };
  geometry::Vector low_, cell_;
  double cells_ = 0.0;
  std::vector<Column> columns_;  ///< those that are not empty
};

}  // namespace carom::starts
