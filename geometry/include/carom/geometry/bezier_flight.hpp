// Where a flight leaves the domain through a Bézier curve, in double precision with bounds.
#pragma once

#include "carom/base/sign.hpp"
#include "carom/geometry/filter.hpp"

namespace carom::geometry {

/// The first exit ahead. Undecided: the bounds do not tell whether there is one, or which comes
/// first.
struct CurveExit {
  Sign leaves = Sign::undecided;
  double u = 0.0;
  /// By which exits are ordered: without field v . (x(u) - start), the time times |v|^2; in a field
  /// kappa, which falls.
  double place = 0.0, error = 0.0;
};

/// Of a straight flight. `on`: the exact parameter of the start if it is a point of the curve, else
/// negative: then both ends of the curve must be known to lie off the flight. The numbers do not
/// depend on the scale's inflation as long as exits are decided.
CurveExit first_exit(const BezierForm& curve, Vector start, Vector velocity,
                     const FlightScale& scale, double on);
/// The same of a Larmor circle.
CurveExit first_exit(const BezierForm& curve, Vector start, Vector velocity, double omega,
                     const FlightScale& scale, double on);

}  // namespace carom::geometry
