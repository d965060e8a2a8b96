// A closed curve that was written as formulas, in balls.
#pragma once

#include "certify/flight/flight.hpp"
#include "certify/number/ball.hpp"
#include "table/closed_curves.hpp"

namespace carom::certify {

/// A point with its first two derivatives.
struct CurvePlace {
  BallVector point, first, second;
};

class CurveOfFormulas {
 public:
  explicit CurveOfFormulas(table::shapes::CurveFormulas);

  /// For all parameters of a ball, with the numbers as they were written. Balls without bounds
  /// where a formula has no value or no derivatives.
  CurvePlace at(const Ball& t) const;
  Ball from() const;
  /// From the start to the end.
  Ball length() const;
  /// Do the formulas repeat after the length, so that they are the curve beyond its ends, too?
  /// Where they cannot but do: functions of sines and cosines of whole multiples.
  bool periodic() const { return periodic_; }

 private:
  table::shapes::CurveFormulas written_;
  bool periodic_;
};

}  // namespace carom::certify
