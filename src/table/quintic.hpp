// Pieces of curves that are written as formulas.
#pragma once

#include <algorithm>

#include "carom/geometry/curve.hpp"
#include "carom/table/table.hpp"

namespace carom::table::shapes {

/// A place on a curve with its first two derivatives.
struct Jet {
  double at;
  geometry::Vector x, first, second;
};

/// The curve of degree 5 that has both jets.
inline geometry::Bezier quintic(const Jet& a, const Jet& b) {
  const double h = 0.2 * (b.at - a.at), bend = 0.05 * (b.at - a.at) * (b.at - a.at);
  return {a.x,
          b.x,
          {a.x + h * a.first, a.x + (2.0 * h) * a.first + bend * a.second,
           b.x - (2.0 * h) * b.first + bend * b.second, b.x - h * b.first},
          5};
}

/// The larger of both.
inline void include(CurveErrors& all, const CurveErrors& more) {
  all = {std::max(all.distance, more.distance), std::max(all.normal, more.normal),
         std::max(all.curvature, more.curvature)};
}
/// Of a piece whose `distance` is such a bound: docs/physics/exactness.md, Bézier curves. Throws
/// std::invalid_argument where it has a cusp between its ends.
CurveErrors errors_of(const geometry::Bezier& piece, double distance);

/// By how much a piece may be off the curve that was written, of its size.
inline constexpr double most_distance = 1e-14;
/// Distances of that, normals to 1e-11, curvatures to 1e-8 of the inverse size.
inline bool as_promised(const CurveErrors& off, double size) {
  return off.distance <= most_distance * size && off.normal <= 1e-11 &&
         off.curvature * size <= 1e-8;
}
/// The declared angle pi/1 where pieces of one curve join: rounding turns their tangents.
inline constexpr int smooth = 1;

}  // namespace carom::table::shapes
