// Arcs as programs that draw want them: centre, semi-axes, angles.
#pragma once

#include <optional>

#include "carom/geometry/curve.hpp"

namespace carom::geometry {

/// "segment", "circular arc", "circle", "elliptic arc", "ellipse" or "bezier".
const char* kind_name(const Curve&);

/// The points centre + a cos(phi) e + b sin(phi) left(e) with e = (cos(axis), sin(axis)), phi from
/// `from` to `to`. Lengths and radians, all rounded. Of a circle a = b is the radius and axis = 0.
struct Arc {
  Vector centre;
  double a = 0.0, b = 0.0, axis = 0.0;
  double from = 0.0, to = 0.0;  ///< from < to: counter-clockwise
};
/// Nothing for a segment or a Bézier curve. Costs what a frame costs, about 4 µs.
std::optional<Arc> arc_of(const Curve&);

}  // namespace carom::geometry
