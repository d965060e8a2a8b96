#include "carom/geometry/prepared_curve.hpp"

#include <algorithm>

#include "exact_curve.hpp"

namespace carom::geometry {

namespace {

// mpq_class::get_d truncates: a relative error of at most 2u.
double rounded(const mpq_class& q) { return q.get_d(); }
double rounded(const Dyadic& d) { return rounded(d.rational()); }
Vector rounded(const DyadicVector& v) { return {rounded(v.x), rounded(v.y)}; }

}  // namespace

PreparedCurve::PreparedCurve(const Curve& curve) {
  const ExactCurve exact_curve(curve);
  closed = exact_curve.closed;
  orientation = exact_curve.orientation;
  from = rounded(exact_curve.from);
  to = rounded(exact_curve.to);
  parametrisation = frame_of(curve);
  const Box box = bounding_box(curve);
  extent = std::max({std::fabs(box.low.x), std::fabs(box.low.y), std::fabs(box.high.x), std::fabs(box.high.y)});
  if (exact_curve.segment) {
    kind = CurveKind::segment;
    direction = rounded(exact_curve.direction);
    length = std::sqrt(dot(direction, direction));
    inverse_length = 1.0 / length;
    tangent = {direction.x / length, direction.y / length};
    // settle: x - from, the tangent (4u), s (7u of a length <= 2.83 extent) and its product (5u), the sum;
    // parameter: the same s, its product with 1/length (4u), taken times the length again.
    point_error = 48.0 * unit_roundoff * extent;
    normal_error = 4.0 * unit_roundoff;
    parameter_stretch = 1.42 * inverse_length;
    return;
  }
  kind = exact_curve.metric.euclidean ? CurveKind::circle : CurveKind::ellipse;
  centre = rounded(exact_curve.centre);
  centre_error = 2.0 * unit_roundoff * std::max(std::fabs(centre.x), std::fabs(centre.y));
  if (kind == CurveKind::circle) {
    r2 = rounded(exact_curve.r2);
    weight = 0.75 / r2;
    int exponent = 0;
    const double fraction = std::frexp(r2, &exponent);
    off_power = fraction < 0.625 || fraction > 0.875 ? 0.75 : 1.0;
  } else {
    // M(e, e) / M(a, a) = (e.p)^2 k^2 / M + (e.q)^2 / M: both rows carry 1 / sqrt(M(a, a)).
    const double root = std::sqrt(rounded(exact_curve.r2));
    const Vector p = rounded(exact_curve.metric.p);
    const double k = rounded(exact_curve.metric.k);
    first_axis = {k * p.x / root, k * p.y / root};
    second_axis = {-p.y / root, p.x / root};
    const double axis = std::sqrt(dot(p, p));
    first_direction = {p.x / axis, p.y / axis};
    second_direction = left(first_direction);
    second_weight = dot(p, p) / rounded(exact_curve.r2);
    first_weight = k * k * second_weight;
  }
  const Vector a = parametrisation.a, b = parametrisation.b;
  const auto norm_1 = [](Vector v) { return std::fabs(v.x) + std::fabs(v.y); };
  parameter_stretch = norm_1(parametrisation.along) + norm_1(parametrisation.across);
  // centre 2u, a sum u of the extents; settle: e and its factor back; parameter: the coordinates on the
  // unit circle (6u each), the half-angle tangent (2u) and u itself below 4 (2u), turned by two lengths.
  const double size = std::max(std::fabs(a.x) + std::fabs(b.x), std::fabs(a.y) + std::fabs(b.y));
  point_error = centre_error + unit_roundoff * (extent + 24.0 * size);
  // e = x - centre errs by 12u of |a|_1 + |b|_1 a coordinate, which the rows of the map to the unit circle
  // turn into a relative error of the gradient.
  normal_error = 16.0 * unit_roundoff * (norm_1(a) + norm_1(b)) * parameter_stretch;
}

}  // namespace carom::geometry
