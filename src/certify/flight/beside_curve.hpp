// Flights from one point of a curve to another that meet it nowhere else.
#pragma once

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
/// parameters at both ends.
bool meets_nowhere_else(const CurveOfFormulas&, const FlightBetween&, const Ball& first,
                        const Ball& last);

}  // namespace carom::certify
