// A flight and a Bézier curve in exact numbers: crossings are roots in u, compared by kappa.
#pragma once

#include <vector>

#include "exact_crossing.hpp"
#include "exact_curve.hpp"

namespace carom::geometry {

/// The flight as one piece sees it; `known`: parameters at which the particle is on it.
struct FlightAtCurve {
  const ExactCurve& curve;
  ExactPoint start;
  DyadicVector v;
  Dyadic omega;
  std::vector<Dyadic> known;
};

/// Where the flight leaves the domain, by falling kappa; a joint on it counts as on its left.
std::vector<Crossing> exits(const FlightAtCurve&);
/// Where it is tangent to the curve without crossing it.
std::vector<Crossing> touches(const FlightAtCurve&);

/// On which side of a curve, which goes on beyond its end, a flight through that end runs just
/// before and after it: 1 left, -1 right, 0 along it.
struct AroundEnd {
  int before, after;
  bool tangent;
};
/// `velocity`: of the flight when it is there, or a positive multiple of it.
AroundEnd around_end(const FlightAtCurve&, bool at_end, const DyadicVector& velocity);

}  // namespace carom::geometry
