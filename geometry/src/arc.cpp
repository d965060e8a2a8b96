#include "carom/geometry/arc.hpp"

#include <cmath>
#include <numbers>

#include "carom/base/elementary.hpp"
#include "carom/geometry/curve_frame.hpp"

namespace carom::geometry {

namespace {

// Direction of the axis to which `a` belongs, and the ratio b/a.
struct Axis {
  Vector direction{1.0, 0.0};
  double ratio = 1.0;
};
Axis axis_of(const Curve& curve) {
  if (const auto* arc = std::get_if<EllipticArc>(&curve)) return {arc->axis, arc->ratio};
  if (const auto* ellipse = std::get_if<Ellipse>(&curve)) return {ellipse->axis, ellipse->ratio};
  return {};
}

}  // namespace

const char* kind_name(const Curve& curve) {
  static constexpr const char* names[] = {"segment",      "circular arc", "circle",
                                          "elliptic arc", "ellipse",      "bezier"};
  return names[curve.index()];
}

std::optional<Arc> arc_of(const Curve& curve) {
  if (std::holds_alternative<Segment>(curve) || std::holds_alternative<Bezier>(curve)) return {};
  const CurveFrame frame = frame_of(curve);
  Axis axis = axis_of(curve);
  if (axis.ratio == 1.0) axis = {};  // a circle
  const bool along_major = axis.ratio <= 1.0;
  Arc arc{.centre = frame.middle,
          .a = along_major ? frame.major : frame.minor,
          .b = along_major ? frame.minor : frame.major,
          .axis = elementary::atan2(axis.direction.y, axis.direction.x)};
  const Vector start = start_point(curve) - arc.centre, e = axis.direction;
  arc.from = elementary::atan2(cross(e, start) / arc.b, dot(e, start) / arc.a);
  // The end's parameter counts quarter turns, and the tangent of half of what is left (curve.hpp).
  const double end = end_parameter(curve), quarters = std::floor(end);
  const double swept =
      quarters * (std::numbers::pi / 2.0) + 2.0 * elementary::atan2(end - quarters, 1.0);
  arc.to = arc.from + frame.turn * swept;
  return arc;
}

}  // namespace carom::geometry
