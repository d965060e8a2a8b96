// Flights from one point of a curve to another that meet it nowhere else.
#pragma once

#include <optional>

#include "certify/wall/curve_of_formulas.hpp"

namespace carom::certify {

/// A straight flight, or an arc of a circle.
struct FlightBetween {
  BallVector from, to;
  BallVector direction;  ///< where it begins, of any length
  Ball curvature;        ///< times that length; positive: it turns clockwise
};
/// Of a point e from where a flight begins: zero on its line or circle, and it rises where a
/// flight leaves to the left of a curve. (2 d x e + k e.e, as geometry::side_of_flight.)
inline Ball side_of_flight(const BallVector& direction, const Ball& curvature,
                           const BallVector& e) {
  return Ball(2) * cross(direction, e) + curvature * dot(e, e);
}
/// How fast that changes where the point moves.
inline Ball slope_of_side(const BallVector& direction, const Ball& curvature, const BallVector& e,
                          const BallVector& moves) {
  return Ball(2) * (cross(direction, moves) + curvature * dot(e, moves));
}

/// Proves it: false where it is not so, or cannot be told. `first` and `last` enclose the curve's
/// parameters at both ends; no first one: the flight begins off the curve.
bool meets_nowhere_else(const CurveOfFormulas&, const FlightBetween&,
                        const std::optional<Ball>& first, const Ball& last);
/// Proves that a circle does not meet the curve at all; the flight's end counts for nothing.
bool circle_meets_nothing(const CurveOfFormulas&, const FlightBetween&);
/// How often the curve goes round a point, counter-clockwise. Nothing where that cannot be told:
/// near the curve.
std::optional<int> turns_round(const CurveOfFormulas&, const BallVector& point);

}  // namespace carom::certify
