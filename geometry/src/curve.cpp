// Points, directions, boxes and areas of curves.
#include "carom/geometry/curve.hpp"

#include <cmath>
#include <numbers>

#include "carom/base/elementary.hpp"
#include "carom/geometry/curve_frame.hpp"

namespace carom::geometry {

namespace {

using Kind = CurveFrame::Kind;

template <class... Functions>
struct Overloaded : Functions... {
  using Functions::operator()...;
};
template <class... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;

/// theta - sin(theta) for the angle that a conic turns up to u, without cancellation.
double angle_minus_sine(double u) {
  const double n = std::floor(u), w = u - n;
  if (n == 0.0 && w < 0.25) {
    // 2 atan w - 2w/(1 + w^2) = 2 w^3 sum (-w^2)^j (2j + 2)/(2j + 3): 16 terms leave 2^-64.
    const double square = w * w;
    double sum = 0.0;
    for (int j = 15; j >= 0; --j) sum = (2.0 * j + 2.0) / (2.0 * j + 3.0) - square * sum;
    return 2.0 * w * square * sum;
  }
  const double angle = n * (std::numbers::pi / 2.0) + 2.0 * elementary::atan2(w, 1.0);
  const double weight = 1.0 + w * w;
  const double x = (1.0 - w) * (1.0 + w) / weight, y = 2.0 * w / weight;
  return angle - (n == 0.0 ? y : n == 1.0 ? x : n == 2.0 ? -y : -x);
}

/// One coordinate of a conic: origin + (x - start) a + y b with (x, y) on the unit circle up to
/// `end`. Widens [low, high] by its extremes inside, and outwards by the rounding: with U = 2^-53,
/// a and b carry U, the squares, their sum and the root 4U, sum or quotient below another 6U, the
/// last sum U of the result: at most 12 U (|origin| + |step|); 16 are taken.
void widen(double& low, double& high, double origin, double start, double a, double b, double end) {
  const double extent = std::sqrt(a * a + b * b);
  if (!(extent > 0.0)) return;
  for (const double sign : {1.0, -1.0}) {
    const double x = sign * a / extent, y = sign * b / extent;
    // Parameter of the extreme point, as in conic_parameter. If rounding puts one in that lies just
    // beyond the end, the box is larger than it must be by a second-order amount.
    const bool ahead = y > 0.0 || (y == 0.0 && x > 0.0);
    const double n = ahead ? (x > 0.0 ? 0.0 : 1.0) : (x < 0.0 ? 2.0 : 3.0);
    const double c = n == 0.0 ? x : n == 1.0 ? y : n == 2.0 ? -x : -y;
    const double s = n == 0.0 ? y : n == 1.0 ? -x : n == 2.0 ? -y : x;
    const double u = n + s / (1.0 + c);
    // extent carries 3 U, x and y 4 U, s/(1 + c) so at most 10 U and u 14 U: 32 are taken.
    constexpr double slack = 0x1p-48;
    if (u > end + slack && u < 4.0 - slack) continue;
    // From the start, where extent - |a| = b^2/(extent + |a|).
    const double step = start == 0.0     ? sign * extent
                        : sign * a > 0.0 ? sign * (b * b / (extent + sign * a))
                                         : sign * (extent - sign * a);
    // 16 U, as derived above.
    const double margin = 0x1p-49 * (std::fabs(origin) + std::fabs(step));
    low = std::fmin(low, origin + step - margin);
    high = std::fmax(high, origin + step + margin);
  }
}

}  // namespace

bool is_closed(const Curve& curve) {
  return std::holds_alternative<Circle>(curve) || std::holds_alternative<Ellipse>(curve);
}

Vector start_point(const Curve& curve) {
  return std::visit(Overloaded{[](const Circle& c) {
                                 return Vector{c.centre.x + c.radius, c.centre.y};
                               },
                               [](const Ellipse& c) { return c.centre + c.axis; },
                               [](const auto& c) { return c.from; }},
                    curve);
}

Vector end_point(const Curve& curve) {
  return std::visit(Overloaded{[](const Circle& c) { return start_point(c); },
                               [](const Ellipse& c) { return start_point(c); },
                               [](const auto& c) { return c.to; }},
                    curve);
}

namespace {
bool ends_at_one(const Curve& curve) {
  return std::holds_alternative<Segment>(curve) || std::holds_alternative<Bezier>(curve);
}
}  // namespace

double end_parameter(const Curve& curve) {
  if (is_closed(curve)) return 4.0;
  return ends_at_one(curve) ? 1.0 : frame_of(curve).end;
}
double last_parameter(const Curve& curve) {
  if (is_closed(curve)) return std::nextafter(4.0, 0.0);
  return ends_at_one(curve) ? std::nextafter(1.0, 0.0) : frame_of(curve).last;
}

Vector tangent_at(const CurveFrame& f, double u) {
  const Vector t = direction_at(f, u);
  const double norm = std::sqrt(dot(t, t));
  return {t.x / norm, t.y / norm};
}
Vector normal_at(const CurveFrame& f, double u) { return left(tangent_at(f, u)); }
double curvature_at(const CurveFrame& f, double u) {
  if (f.kind == Kind::segment) return 0.0;
  if (f.bezier) return f.bezier->curvature(u);
  if (f.circular) return f.turn / f.major;
  // x' x x''/|x'|^3 by the eccentric angle, where x' x x'' = a x b is the product of the semi-axes.
  const Vector t = conic_direction(f, u);
  const double squared = dot(t, t);
  return f.turn * (f.major * f.minor) / (squared * std::sqrt(squared));
}

Vector point_at(const Curve& curve, double u) { return point_at(frame_of(curve), u); }
Vector tangent_at(const Curve& curve, double u) { return tangent_at(frame_of(curve), u); }
Vector normal_at(const Curve& curve, double u) { return normal_at(frame_of(curve), u); }
double curvature_at(const Curve& curve, double u) { return curvature_at(frame_of(curve), u); }
double parameter_of(const Curve& curve, Vector point) {
  return parameter_of(frame_of(curve), point);
}
double length(const Curve& curve) { return length(frame_of(curve)); }
double arc_length_at(const Curve& curve, double u) { return arc_length_at(frame_of(curve), u); }
double parameter_at_length(const Curve& curve, double s) {
  return parameter_at_length(frame_of(curve), s);
}
Vector centre(const Curve& curve) { return frame_of(curve).middle; }

Box bounding_box(const Curve& curve) {
  const Vector from = start_point(curve), to = end_point(curve);
  Box box{{std::fmin(from.x, to.x), std::fmin(from.y, to.y)},
          {std::fmax(from.x, to.x), std::fmax(from.y, to.y)}};
  if (std::holds_alternative<Segment>(curve)) return box;
  if (const auto* bezier = std::get_if<Bezier>(&curve)) {
    // The curve lies in the convex hull of its control points.
    for (int i = 1; i < bezier->degree; ++i) {
      const Vector p = bezier->control(i);
      box = {{std::fmin(box.low.x, p.x), std::fmin(box.low.y, p.y)},
             {std::fmax(box.high.x, p.x), std::fmax(box.high.y, p.y)}};
    }
    return box;
  }
  const CurveFrame f = frame_of(curve);
  widen(box.low.x, box.high.x, f.origin.x, f.start, f.a.x, f.b.x, f.end);
  widen(box.low.y, box.high.y, f.origin.y, f.start, f.a.y, f.b.y, f.end);
  return box;
}

double area_beyond_chord(const CurveFrame& f) {
  if (f.kind == Kind::segment) return 0.0;
  if (f.bezier) return f.bezier->area_beyond_chord();
  const double product = f.turn * (f.major * f.minor);
  return f.kind == Kind::closed ? product * std::numbers::pi
                                : 0.5 * product * angle_minus_sine(f.end);
}

double area_integral(const Curve& curve) {
  const Vector from = start_point(curve), to = end_point(curve);
  return 0.5 * cross(from, to) + area_beyond_chord(frame_of(curve));
}

}  // namespace carom::geometry
