// Signs that the choosing files ask for beyond those of geometry/filter.hpp, each with its bound.
// docs/physics/exactness.md derives them, tests/events/bounds_test.cpp measures them.
#pragma once

#include <cmath>

#include "carom/base/sign.hpp"
#include "carom/geometry/filter.hpp"
#include "events/flight/crossing.hpp"

namespace carom::events {

/// A number whose sign tells a side of a chord, and what its error cannot exceed.
struct ChordSide {
  double value, bound;
  Sign sign() const { return sign_within(value, bound); }
};

/// On which side of the chord of its joints is the crossing of a conic at kappa? Positive on the
/// arc's.
inline ChordSide side_of_chord(const geometry::PreparedCurve& w, geometry::Vector origin,
                               geometry::Vector v, double omega, double kappa, double kappa_error,
                               const geometry::FlightScale& s) {
  using namespace geometry;
  const Vector d = displacement(kappa, v, omega, 0.5);
  const Vector chord = w.to - w.from, e = (origin - w.from) + d;
  // Each coordinate of e: that of the point, u of the difference and of the sum; chord u, product
  // u, difference u.
  const double error = point_error(s, kappa, kappa_error, norm_1(d));
  const double rounding = unit_roundoff * (6.1 * norm_1(e) + 2.1 * w.extent + 2.1 * norm_1(d));
  return {-w.orientation * cross(chord, e), norm_1(chord) * (error + s.inflation * rounding)};
}

/// On which side of that chord does the flight begin? Positive beyond it, off the arc.
inline ChordSide start_beyond_chord(const geometry::PreparedCurve& w, geometry::Vector origin,
                                    const geometry::FlightScale& s) {
  const geometry::Vector chord = w.to - w.from, e = origin - w.from;
  // e: delta and u; chord u, product u, difference u.
  const double rounding = 4.1 * geometry::unit_roundoff * norm_1(e);
  return {w.orientation * cross(chord, e), s.inflation * norm_1(chord) * (s.delta + rounding)};
}

/// From this |kappa| on flights that begin beyond the chord end there, too: they are |v|/|kappa|
/// long at most. Infinite: it is not certain that they begin there. Seven roundings, a relative
/// 2^-50: 1.01 is more.
inline double kappa_beyond_chord(const geometry::PreparedCurve& w, geometry::Vector origin,
                                 const geometry::FlightScale& s) {
  const ChordSide start = start_beyond_chord(w, origin, s);
  return start.sign() == Sign::positive
             ? 1.01 * norm_1(w.to - w.from) * s.speed_1 / (start.value - start.bound)
             : HUGE_VAL;
}

/// Without field: the foot of an arc's centre on the flight, times |v|^2: positive if it lies
/// beyond the chord of the joints, off the arc.
[[gnu::always_inline]] inline ChordSide foot_beyond_chord(const geometry::PreparedCurve& w,
                                                          geometry::Vector origin,
                                                          geometry::Vector v,
                                                          const geometry::FlightScale& s) {
  using namespace geometry;
  const Vector e = origin - w.from, chord = w.to - w.from, c = origin - w.centre;
  const double side = dot(v, v) * cross(chord, e) - dot(c, v) * cross(chord, v);
  // Each coordinate of e and c errs by eta, of the chord by u; four factors, each a sum of
  // products.
  const double e1 = norm_1(e), c1 = norm_1(c);
  const double eta = s.delta + w.centre_error + 1.1 * unit_roundoff * (e1 + c1);
  return {w.orientation * side, s.inflation * norm_1(chord) * (s.speed_1 * s.speed_1) *
                                    (2.1 * eta + 8.1 * unit_roundoff * (e1 + c1))};
}

/// The foot of the Larmor circle's centre on a segment's line, times |omega|: is it beyond the
/// start
/// (`first` positive), is it before the end (`last` positive)?
struct Feet {
  double first, last, bound;
};
[[gnu::always_inline]] inline Feet feet_of_centre(const geometry::PreparedCurve& w,
                                                  geometry::Vector origin, geometry::Vector v,
                                                  double omega, const geometry::FlightScale& s) {
  using namespace geometry;
  const double across = cross(w.tangent, v);
  const Vector e = origin - w.from, g = origin - w.to;
  const double first = omega * dot(e, w.tangent) + across;
  const double last = omega * dot(g, w.tangent) + across;
  // omega e.t: e errs by delta, t by 5u; e u, product, sum, factor and last sum u. cross(t, v): 5u,
  // 2u and the last.
  const double e1 = norm_1(e), g1 = norm_1(g);
  const double bound =
      s.inflation * (s.omega * (1.42 * s.delta + 10.1 * unit_roundoff * (e1 > g1 ? e1 : g1)) +
                     8.1 * unit_roundoff * s.speed_1);
  return {omega > 0.0 ? first : -first, omega > 0.0 ? -last : last, bound};
}

/// Without field, error of kappa = U / T of a line, T > 0: U = cross(v, tangent) errs by twice the
/// error of its half, T by its own; |U/T - U'/T'| <= (|U - U'| + kappa |T - T'|) / T, and kappa is
/// rounded.
[[gnu::always_inline]] inline double straight_line_error(const geometry::PreparedCurve& w,
                                                         geometry::Vector origin,
                                                         const geometry::FlightScale& s,
                                                         double kappa, double time) {
  using namespace geometry;
  const QuadraticError e = line_error(s, norm_1(origin - w.from));
  if (!(time > e.a)) return HUGE_VAL;
  const double k = std::fabs(kappa);
  return (2.0 * e.b + k * e.a) / (time - e.a) + 2.1 * unit_roundoff * k;
}

/// Error of the parameter at which a flight lands that is displaced by at most d1 in l1.
inline double parameter_error(const geometry::PreparedCurve& w, geometry::Vector origin, double d1,
                              double kappa, double kappa_error, const geometry::FlightScale& s) {
  using namespace geometry;
  const double x =
      point_error(s, kappa, kappa_error, d1) +
      s.inflation *
          (w.centre_error + unit_roundoff * (2.1 * norm_1(origin) + 2.1 * d1 + 4.1 * w.extent));
  // The map of the point to u stretches by at most 1 / length, or by the rows of the map to the
  // unit circle, on which the half-angle tangent grows by at most 1.
  return 1.01 * w.parameter_stretch * x + s.inflation * 16.0 * unit_roundoff;
}

}  // namespace carom::events
