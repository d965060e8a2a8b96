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
  extent = std::max(
      {std::fabs(box.low.x), std::fabs(box.low.y), std::fabs(box.high.x), std::fabs(box.high.y)});
  if (exact_curve.segment) {
    kind = CurveKind::segment;
    direction = rounded(exact_curve.direction);
    length = std::sqrt(dot(direction, direction));
    inverse_length = 1.0 / length;
    tangent = {direction.x / length, direction.y / length};
    // The normal: the direction is cut (2u), the quotient rounded (u); an error of its length alone
    // turns nothing. settle: x - from (u), the normal (4u), product and sum (2u) of a length
    // <= 2.83 extent, the last sum: 21u of the extent; parameter and point: as much along the wall,
    // and the product with the direction (5u) and its sum.
    point_error = 64.0 * unit_roundoff * extent;
    normal_error = 4.0 * unit_roundoff;
    normal_bound = 1.42 * normal_error;  // of a unit vector
    parameter_stretch = 1.42 * inverse_length;
    return;
  }
  if (parametrisation.bezier) {
    prepare_bezier();
    return;
  }
  kind = exact_curve.metric.euclidean ? CurveKind::circle : CurveKind::ellipse;
  landing = kind == CurveKind::circle ? LandingKind::circle : LandingKind::ellipse;
  centre = rounded(exact_curve.centre);
  centre_error = 2.0 * unit_roundoff * std::max(std::fabs(centre.x), std::fabs(centre.y));
  if (kind == CurveKind::circle) {
    r2 = rounded(exact_curve.r2);
    strength = 2.0 / r2;
    weight = 0.25 * strength;
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
    second_weight = dot(p, p) / rounded(exact_curve.r2);
    first_weight = k * k * second_weight;
  }
  const Vector a = parametrisation.a, b = parametrisation.b;
  const auto norm_1 = [](Vector v) { return std::fabs(v.x) + std::fabs(v.y); };
  parameter_stretch = norm_1(parametrisation.along) + norm_1(parametrisation.across);
  // In the plane of the unit circle (X, Y): a coordinate moves by at most `row` times a
  // displacement in the table's plane, which moves by at most `size` times an angle. Half the
  // angle's tangent w = Y/(1 + X) turns a displacement D of (X, Y) into an angle of at most
  // sqrt(2)|D|, so twice its larger coordinate.
  constexpr double u = unit_roundoff;
  const double size = std::max(std::fabs(a.x) + std::fabs(b.x), std::fabs(a.y) + std::fabs(b.y));
  const double row = std::max(norm_1(parametrisation.along), norm_1(parametrisation.across)),
               k = row * size;
  // A settled point misses the curve by the centre's error, its last sum and e = x - centre:
  // `placed`; and along e by the rounding of its squared length, circle: below 10u of the square,
  // 5u of the length (r2 2u, weight u, products, difference); ellipse: each axis times e 5u 2k,
  // half of the squares' sum: below 18u k + 3u. X and Y of the point: its difference from the
  // origin, row, product, sum: 4u of 2k, and u. w and u below 4: 5u, an angle of 10u.
  const double placed = centre_error + u * (extent + 2.0 * size);
  if (kind == CurveKind::circle) {
    point_error = (1.0 + 2.0 * k) * placed + u * size * (16.0 * k + 40.0);
    // The normal is e itself: it differs from the exact one by the angle between e and u.
    normal_error = 1.43 * (2.0 * row * placed + u * (16.0 * k + 14.0));
    normal_bound = normal_error * 1.43 * std::sqrt(r2);
  } else {
    point_error = (1.0 + 2.0 * k) * placed + u * size * (61.0 * k + 20.0);
    // The gradient is the transposed map of (X, Y): relative to its length an error of (X, Y) grows
    // by at most 2 row times sqrt(2) size; its own products add 12u k + 6u.
    normal_error = 2.85 * k * (2.0 * row * placed + u * (28.0 * k + 18.0));
    // The gradient has the rows as weights of X and Y, which lie on the unit circle.
    normal_bound = normal_error * 1.01 * (norm_1(first_axis) + norm_1(second_axis));
  }
}

void PreparedCurve::prepare_bezier() {
  kind = CurveKind::bezier;
  landing = LandingKind::bezier;
  const BezierForm& f = *parametrisation.bezier;
  constexpr double u = unit_roundoff;
  const double degree = static_cast<double>(f.degree);
  point_error = u * (1.1 * extent + (2.0 * degree + 1.1) * f.reach);
  // T errs by (2 degree + 2) u tangent_size in each coordinate, its product with a velocity by 2u.
  normal_bound = (2.0 * degree + 4.1) * u * f.tangent_size;
  normal_error = 1.42 * normal_bound / f.least_tangent;
  // |x'| has no bound from below where the curve rests.
  parameter_stretch = f.rests_at_start || f.rests_at_end ? HUGE_VAL : 1.42 / f.least_tangent;
}

void PreparedCurve::make_thin() {
  if (kind == CurveKind::segment || kind == CurveKind::bezier) return;
  landing = LandingKind::thin;
  const Vector a = parametrisation.a, b = parametrisation.b;
  const double size = std::fabs(a.x) + std::fabs(a.y) + std::fabs(b.x) + std::fabs(b.y);
  constexpr double u = unit_roundoff;
  // A point is conic_point(u): 10u of both axes, and the sum u of itself; its origin another u.
  point_error = u * (10.1 * size + 2.1 * extent);
  // The normal is X b - Y a, turned: X and Y err by 6u of themselves, the axes by u, product and
  // sum 2u; and its product with a velocity by 2u.
  normal_bound = 11.1 * u * size;
  normal_error = 1.42 * normal_bound / parametrisation.minor;
}

PreparedCurve::Frame PreparedCurve::frame_at(double u) const {
  const Vector normal = left(direction_at(parametrisation, u));
  return {point(u), normal, dot(normal, normal), 1.0};
}

/// On a Bézier curve the parameter was found by the flight, and everything is made of it.
PreparedCurve::Arrival PreparedCurve::arrival_at(double u, Vector v) const {
  Arrival a;
  a.u = std::clamp(u, first_parameter, last());
  reflect_by(frame_at(a.u), v, a);
  return a;
}

/// Where the line through x along v enters the unit circle that the curve is mapped to, or leaves
/// it if the domain lies inside. How far along the line x was found does not matter: it is
/// the distance of the line from the centre that tells, so a hit lies on the side that the particle
/// comes from. A line that misses the circle by rounding touches it.
PreparedCurve::Arrival PreparedCurve::arrival_by_line(Vector x, Vector v) const {
  Arrival a;
  const CurveFrame& f = parametrisation;
  const Vector e = x - f.origin;
  const Vector at{f.start + dot(f.along, e), dot(f.across, e)};
  const Vector way{dot(f.along, v), dot(f.across, v)};
  const double size = std::sqrt(dot(way, way));
  const Vector ahead{way.x / size, way.y / size};
  const double side = std::clamp(cross(ahead, at), -1.0, 1.0);
  const double half = orientation * std::sqrt((1.0 - side) * (1.0 + side));
  const Vector on = side * left(ahead) + half * ahead;
  // On the unit circle itself.
  geometry::Frame<double> circle;
  circle.along = {1.0, 0.0};
  circle.across = {0.0, 1.0};
  circle.end = f.end;
  circle.last = f.last;
  a.u = conic_parameter(circle, on, first_parameter);
  reflect_by(frame_at(a.u), v, a);
  return a;
}

}  // namespace carom::geometry
