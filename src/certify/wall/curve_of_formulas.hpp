// A closed curve that was written as formulas, in balls.
#pragma once

#include <map>
#include <string>

#include "certify/wall/piece.hpp"
#include "table/closed_curves.hpp"

namespace carom::certify {

/// With the numbers as they were written. Without bounds where a formula has no value or no
/// derivatives. It repeats where it cannot but do: functions of sines and cosines of whole
/// multiples.
class CurveOfFormulas final : public Piece {
 public:
  explicit CurveOfFormulas(table::shapes::CurveFormulas);
  VectorOf<Series> about(const Ball& t) const override;

 private:
  table::shapes::CurveFormulas written_;
  BallVector centre_;
  std::map<std::string, Series> numbers_;
};

}  // namespace carom::certify
