// A straight flight and a Bézier curve in exact numbers: crossings are roots in u, compared by
// kappa.
#pragma once

#include <vector>

#include "exact_crossing.hpp"
#include "exact_curve.hpp"

namespace carom::geometry {

/// The flight as one piece sees it; `known`: parameters at which the particle stands on it.
struct LineAtCurve {
  const ExactCurve& curve;
  ExactPoint start;
  DyadicVector v;
  std::vector<Dyadic> known;
};

/// Where the line leaves the domain, by falling kappa; a joint on the line counts as on its left.
std::vector<Crossing> exits(const LineAtCurve&);
/// Where it is tangent to the curve without crossing it.
std::vector<Crossing> touches(const LineAtCurve&);

/// a . (x(u) - p) times p.w, as a polynomial in u.
Polynomial form_of(const ExactCurve& curve, const DyadicVector& a, const ExactPoint& p);

/// On which side of the curve, which goes on beyond its end, a line along v through that end runs
/// just before and after it: 1 left, -1 right, 0 along a straight curve.
struct AroundEnd {
  int before, after;
  bool tangent;
};
AroundEnd around_end(const ExactCurve& curve, bool at_end, const DyadicVector& v);

}  // namespace carom::geometry
