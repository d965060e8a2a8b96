// Where a line leaves the domain through a Bézier curve, in double precision with bounds.
#pragma once

#include "carom/base/sign.hpp"
#include "carom/geometry/filter.hpp"

namespace carom::geometry {

/// The first exit ahead. `along` is v . (x(u) - start): the time times |v|^2. Undecided: the bounds
/// do not tell whether there is one, or which comes first.
struct LineExit {
  Sign leaves = Sign::undecided;
  double u = 0.0;
  double along = 0.0, error = 0.0;  ///< of `along`
};

/// `on`: the exact parameter of the start if it is a point of the curve, else negative: then both
/// ends of the curve must be known to lie off the line. The numbers do not depend on the scale's
/// inflation as long as exits are decided.
LineExit first_exit(const BezierForm& curve, Vector start, Vector velocity,
                    const FlightScale& scale, double on);

}  // namespace carom::geometry
