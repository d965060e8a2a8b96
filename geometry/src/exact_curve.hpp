// Curves in exact arithmetic.
#pragma once

#include <vector>

#include "carom/geometry/curve.hpp"
#include "dyadic.hpp"

namespace carom::geometry {

using DyadicVector = BasicVector<Dyadic>;

inline DyadicVector exact(Vector v) { return {Dyadic(v.x), Dyadic(v.y)}; }

/// Homogeneous: the point (x/w, y/w), w > 0.
struct ExactPoint {
  Dyadic x, y, w{1};
};

/// M(e, f) = k^2 (e.p)(f.p) + (e.q)(f.q), q = left(p); the circle is p = (1, 0), k = 1.
struct Metric {
  bool euclidean = true;
  DyadicVector p{Dyadic(1), Dyadic(0)};
  Dyadic k{1}, k2{1};
  Dyadic scale{1};  ///< k |p|^2: K e / scale is the quarter turn
  Dyadic operator()(const DyadicVector& e, const DyadicVector& f) const;
  DyadicVector quarter(const DyadicVector& e) const;  ///< K e
};
/// Of ellipses with a semi-axis along `axis` and the other one `ratio` times as long.
Metric metric_of(Vector axis, double ratio);

struct ExactCurve {
  bool segment = true;
  bool closed = false;
  int orientation = 1;  ///< +1 counter-clockwise (domain inside), -1 clockwise
  DyadicVector from, to;
  DyadicVector direction;           ///< segment: to - from
  DyadicVector centre, start, end;  ///< conics: from and to seen from the centre
  Dyadic r2;                        ///< M(start, start)
  Metric metric;
  std::vector<DyadicVector> power;  ///< Bézier curves: x(u) = sum of power[k] u^k; else empty

  explicit ExactCurve(const Curve& curve);
  ExactPoint point(double u) const;
  ExactPoint end_point() const { return {to.x, to.y, Dyadic(1)}; }
  bool bezier() const { return !power.empty(); }
  /// Does the derivative of a Bézier curve vanish at its end?
  bool rests_at_end() const;
  /// A tangent vector (any length) in the direction of travel: at a homogeneous point of a line or
  /// conic, at a parameter (u < 0: at the end) of any curve.
  DyadicVector tangent(const ExactPoint& at) const;
  DyadicVector direction_at(double u) const;
};

}  // namespace carom::geometry
