// The polynomial in kappa of a flight against one wall, and its error: what the choosing files
// share.
#pragma once

#include <algorithm>
#include <cmath>

#include "carom/geometry/filter.hpp"

namespace carom::events {

inline double norm_1(geometry::Vector v) { return std::fabs(v.x) + std::fabs(v.y); }

/// An ellipse without field. `on_wall`: as below.
[[gnu::always_inline]] inline geometry::Quadratic<double> ellipse_quadratic(
    const geometry::PreparedCurve& w, geometry::Vector e, geometry::Vector v, bool on_wall) {
  geometry::Quadratic<double> q =
      geometry::ellipse_quadratic(e, v, w.first_direction, w.first_weight, w.second_weight);
  if (on_wall) q.a = 0.0;
  return q;
}

/// A circle, up to its orientation.
template <bool larmor>
[[gnu::always_inline]] inline geometry::Quadratic<double> circle_quadratic(
    const geometry::PreparedCurve& w, geometry::Vector e, geometry::Vector v, double v2,
    double omega, bool on_wall) {
  if constexpr (larmor)
    return geometry::circle_quadratic(e, on_wall ? dot(e, e) : w.r2, v, v2, omega, 0.5);
  geometry::Quadratic<double> q = geometry::circle_quadratic(e, w.r2, v, v2);
  if (on_wall) q.a = 0.0;
  return q;
}

/// All but Larmor circles against ellipses. `on_wall`: the start lies on the wall, and the leading
/// coefficient is zero by algebra. Without field the terms with omega, which are exact zeros, are
/// left out.
template <bool larmor>
[[gnu::always_inline]] inline geometry::Quadratic<double> quadratic(
    const geometry::PreparedCurve& w, geometry::Vector origin, geometry::Vector v, double v2,
    double omega, bool on_wall) {
  using namespace geometry;
  if (w.kind == CurveKind::segment) {
    const Vector e = on_wall ? Vector{} : origin - w.from;
    return line_quadratic(e, w.tangent, v, omega, 0.5);
  }
  const Vector e = origin - w.centre;
  const Quadratic<double> q = w.kind == CurveKind::ellipse
                                  ? ellipse_quadratic(w, e, v, on_wall)
                                  : events::circle_quadratic<larmor>(w, e, v, v2, omega, on_wall);
  return w.orientation > 0 ? -q : q;
}

[[gnu::always_inline]] inline geometry::QuadraticError quadratic_error(
    const geometry::PreparedCurve& w, geometry::Vector origin, const geometry::FlightScale& scale,
    bool on_wall) {
  using namespace geometry;
  QuadraticError error{};
  if (w.kind == CurveKind::segment) {
    error = line_error(scale, on_wall ? 0.0 : norm_1(origin - w.from));
  } else if (w.kind == CurveKind::circle) {
    error = circle_error(scale, norm_1(origin - w.centre), w.centre_error, w.r2);
  } else {
    const double row = std::max(norm_1(w.first_axis), norm_1(w.second_axis));
    error = ellipse_error(scale, norm_1(origin - w.centre), w.centre_error, row);
  }
  if (on_wall) error.a = 0.0;
  return error;
}

/// In a field: is the sign of the rising root certain where it goes through infinity? There a
/// flight of no length passes into a full turn. Falling towards the curve the root is a quotient by
/// a, the distance of the start; standing on it one by b, which is positive, but may have been
/// rounded away.
[[gnu::always_inline]] inline bool far_root_certain(const geometry::Quadratic<double>& q,
                                                    const geometry::QuadraticError& e,
                                                    bool on_wall) {
  return on_wall ? q.b > 0.0 : q.b > e.b || std::fabs(q.a) > e.a;
}

/// Without field, the time of a crossing is a quotient: that of a conic's rising root.
struct Quotient {
  double time, unit;
};
[[gnu::always_inline]] inline Quotient straight_time(const geometry::Quadratic<double>& q,
                                                     double root) {
  return q.b <= 0.0 ? Quotient{q.a, root - q.b} : Quotient{-(q.b + root), q.c};
}

}  // namespace carom::events
