// Error bounds of the formulas in double precision: the first stage of every decision.
//
// Notation: u = 2^-53; the start P of a flight is known to `delta` a coordinate; |.|_1 is the sum
// of absolute coordinates; s the speed, V = |v|_1, w = |omega|. Each bound is derived in
// docs/physics/exactness.md; products of two roundings are covered by the last digit of a constant.
// No bound is tuned: tests check that the largest error over 10^7 cases is between 1 % and 100 % of
// it.
#pragma once

#include <cmath>

#include "carom/geometry/formulas.hpp"
#include "carom/geometry/prepared_curve.hpp"

namespace carom::geometry {

/// What the bounds need to know of a flight.
struct FlightScale {
  double delta = 0.0;      ///< error of each coordinate of the start, seen from this cell
  double speed_1 = 0.0;    ///< V
  double omega = 0.0;      ///< w
  double inflation = 1.0;  ///< factor on every bound; results never depend on it
};

/// Error of side_of_flight for d = J - P with |d|_1 = d1.
inline double side_error(const FlightScale& f, double d1) {
  // 2 cross(v, d): with S = |v_x d_y| + |v_y d_x| <= V d1, d errs by delta and by u of itself: 2 V
  // delta + 2u S; two products and their difference 4u S; the last sum 2u S: together 2 V (delta +
  // 4u d1). omega d.d: 2 w (d1 delta + delta^2) and 2u w d1^2 from d, products, sum and factor 3u,
  // the last sum u: together 2 w (d1 + delta)(delta + 3u d1).
  return f.inflation * 2.01 * (f.speed_1 + f.omega * (d1 + f.delta)) *
         (f.delta + 4.1 * unit_roundoff * d1);
}

/// Errors of what is made of centre_of_circle for joints at an l1 distance of at most d: of |c|^2 -
/// |v|^2, with |v|^2 the energy shell's; and of lengths compared on a segment: |v| - |cross(t, c)|,
/// dot(t, c), omega L - dot(t, c).
struct CentreError {
  double joint, segment;
};
inline CentreError centre_error(const FlightScale& f, double d) {
  // |c|_1 <= size. Each coordinate: omega delta, and u from the difference, the product and the
  // sum.
  const double u = unit_roundoff, size = f.omega * d + f.speed_1,
               c = f.omega * f.delta + 3.1 * u * size;
  // Squares and sum 2u, the difference 2u, the shell 64u. Tangent 5u, product, difference; |v| 33u;
  // L 5u, last sums.
  return {f.inflation * (2.01 * c * (size + c) + 70.0 * u * size * size),
          f.inflation * (1.42 * c + 44.0 * u * size)};
}

/// Errors of the coefficients of a quadratic.
struct QuadraticError {
  double a, b, c;
};

/// Line, e = P - A with |e|_1 = e1. Each coordinate of the unit tangent errs by 5u of itself: the
/// direction cut off (2u), its length (2u, of which the cut takes back its own), the quotient (u).
/// With the sum of the two products' sizes S <= |e|_2:  a: 1.42 delta + (5u + e u + product u +
/// difference u) S; b: half of 5u + 2u of S' <= V;  c: n a with two roundings and the last, and
/// half of w (5u + 2u + u + u) V.
inline QuadraticError line_error(const FlightScale& f, double e1) {
  const double u = unit_roundoff;
  const double a = 1.42 * f.delta + 8.0 * u * e1;
  const double n = 0.25 * f.omega * f.omega;
  return {f.inflation * a, f.inflation * 3.6 * u * f.speed_1,
          f.inflation * (n * (a + 4.1 * u * e1) + 4.6 * u * f.omega * f.speed_1)};
}

/// Circle: e = P - C with |e|_1 = e1; the centre errs by `centre_error`, the squared radius by 2u
/// r2.
inline QuadraticError circle_error(const FlightScale& f, double e1, double centre_error,
                                   double r2) {
  const double u = unit_roundoff;
  const double eta = f.delta + centre_error + 1.01 * u * e1;
  const double a = 2.01 * e1 * eta + 2.01 * eta * eta + u * (3.1 * e1 * e1 + 4.1 * r2);
  const double b = f.speed_1 * (eta + 2.1 * u * e1);
  const double n = 0.25 * f.omega * f.omega;
  const double c = n * (a + 4.1 * u * (e1 * e1 + r2)) + f.omega * f.speed_1 * (eta + 5.1 * u * e1) +
                   66.1 * u * f.speed_1 * f.speed_1;  // |v|^2 is the energy shell's, within 64u
  return {f.inflation * a, f.inflation * b, f.inflation * c};
}

/// Ellipse without field, in the frame in which it is the unit circle: `row` bounds the l1 norm of
/// the rows of the map, whose entries err by 4u relative; e = P - C with |e|_1 = e1.
inline QuadraticError ellipse_error(const FlightScale& f, double e1, double centre_error,
                                    double row) {
  const double u = unit_roundoff;
  const double eta =
      row * (f.delta + centre_error + 9.1 * u * e1);             // of each mapped coordinate of e
  const double m = 2.01 * row * e1, n = 2.01 * row * f.speed_1;  // mapped |e|_1, |v|_1
  const double nu = 8.1 * u * row * f.speed_1;                   // of each mapped coordinate of v
  return {f.inflation * (2.01 * m * eta + 2.01 * eta * eta + 3.1 * u * (m * m + 1.0)),
          f.inflation * (m * nu + n * eta + 2.01 * nu * eta + 2.1 * u * m * n),
          f.inflation * (2.01 * n * nu + 2.01 * nu * nu + 2.1 * u * n * n)};
}

/// The crossing at which a kappa^2 + 2 b kappa + c rises, without cancellation.
struct Root {
  double discriminant = 0.0;  ///< b^2 - a c
  double root = 0.0;          ///< its square root (0 where rounding made it negative)
  double kappa = 0.0;
};
inline Root rising_root(const Quadratic<double>& q) {
  Root r;
  r.discriminant = discriminant_of(q);
  r.root = r.discriminant > 0.0 ? std::sqrt(r.discriminant) : 0.0;
  r.kappa = q.b <= 0.0 ? (r.root - q.b) / q.a : -q.c / (q.b + r.root);
  return r;
}
/// The crossing at which it falls.
inline Root falling_root(const Quadratic<double>& q) { return rising_root(-q); }

/// Error of the discriminant.
inline double discriminant_error(const Quadratic<double>& q, const QuadraticError& e) {
  const double a = std::fabs(q.a), b = std::fabs(q.b), c = std::fabs(q.c);
  return 2.0 * b * e.b + e.b * e.b + a * e.c + c * e.a + e.a * e.c +
         3.1 * unit_roundoff * (b * b + a * c);
}

/// Error of kappa; infinite where the discriminant could be zero or the divisor could vanish.
inline double kappa_error(const Quadratic<double>& q, const QuadraticError& e, const Root& r) {
  const double spread = discriminant_error(q, e);
  if (!(r.discriminant > spread)) return HUGE_VAL;
  const double n = std::fabs(q.b) + r.root;
  // |sqrt(x) - sqrt(y)| <= |x - y| / sqrt(x).
  const double n_error = e.b + spread / r.root + 2.1 * unit_roundoff * n;
  const double k = std::fabs(r.kappa);
  const double divisor = q.b <= 0.0 ? std::fabs(q.a) : n;
  const double divisor_error = q.b <= 0.0 ? e.a : n_error;
  const double numerator_error = q.b <= 0.0 ? n_error : e.c;
  if (!(divisor > divisor_error)) return HUGE_VAL;
  return (numerator_error + k * divisor_error) / (divisor - divisor_error) +
         2.1 * unit_roundoff * k;
}

/// Error of each coordinate of the point at kappa, when kappa errs by `kappa_error` and |x - P|_1 =
/// d1: |dx/dkappa| = |v| / (kappa^2 + omega^2/4).
inline double point_error(const FlightScale& f, double kappa, double kappa_error, double d1) {
  const double low = std::fabs(kappa) - kappa_error;
  const double n = (low > 0.0 ? low * low : 0.0) + 0.249 * f.omega * f.omega;
  if (!(n > 0.0) || !(kappa_error < HUGE_VAL)) return HUGE_VAL;
  return f.inflation * (f.delta + 8.1 * unit_roundoff * d1) + 1.01 * f.speed_1 * kappa_error / n;
}

}  // namespace carom::geometry
