// A closed curve that was written as formulas, in balls.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "certify/flight/flight.hpp"
#include "certify/number/ball.hpp"
#include "table/closed_curves.hpp"

namespace carom::certify {

/// A point with its first two derivatives.
struct CurvePlace {
  BallVector point, first, second;
};

inline geometry::Vector in_doubles(const BallVector& v) {
  return {v.x.to_double(), v.y.to_double()};
}

class CurveOfFormulas {
 public:
  explicit CurveOfFormulas(table::shapes::CurveFormulas);
  /// The outer wall of a table, if that is such a curve and the only loop.
  static std::optional<CurveOfFormulas> of(const TableSpec&);

  /// For all parameters of a ball, with the numbers as they were written. Balls without bounds
  /// where a formula has no value or no derivatives.
  CurvePlace at(const Ball& t) const;
  Ball from() const;
  /// From the start to the end.
  Ball length() const;
  /// About where a point of the table's wall in doubles lies.
  double parameter(int wall, double u) const {
    const auto [begin, end] = parts_[static_cast<std::size_t>(wall)];
    return begin + u * (end - begin);
  }
  /// The wall on which a parameter lies, of one or more rounds.
  std::pair<int, double> wall_at(double parameter) const;
  /// -1: the table's walls run the other way.
  double turn() const { return parts_.front().first < parts_.front().second ? 1.0 : -1.0; }
  /// Do the formulas repeat after the length, so that they are the curve beyond its ends, too?
  /// Where they cannot but do: functions of sines and cosines of whole multiples.
  bool periodic() const { return periodic_; }

 private:
  table::shapes::CurveFormulas written_;
  bool periodic_;
  std::vector<std::pair<double, double>> parts_;  ///< parameters where walls begin and end
};

}  // namespace carom::certify
