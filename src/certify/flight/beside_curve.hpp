// Flights from one point of a curve to another that meet it nowhere else.
#pragma once

#include <optional>

#include "certify/wall/curve_of_formulas.hpp"

namespace carom::certify {

/// Straight, or along a circle that turns to one side.
struct FlightBetween {
  BallVector from, to;
  bool turns = false;
  bool clockwise = false;
  BallVector centre = {};  ///< of the circle
  Ball radius2 = {};
};

/// Proves it: false where it is not so, or cannot be told. `first` and `last` enclose the curve's
/// parameters at both ends; no first one: the flight begins off the curve.
bool meets_nowhere_else(const CurveOfFormulas&, const FlightBetween&,
                        const std::optional<Ball>& first, const Ball& last);
/// How often the curve goes round a point, counter-clockwise. Nothing where that cannot be told:
/// near the curve.
std::optional<int> turns_round(const CurveOfFormulas&, const BallVector& point);

}  // namespace carom::certify
