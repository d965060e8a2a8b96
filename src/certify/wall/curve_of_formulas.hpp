// Closed curves that were written as formulas, in balls.
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

/// A piece of the curve on which a formula of x and y vanishes: from each point of a Bézier curve
/// beside it, where that is along a normal. Neighbours have one normal at their joint.
class ImplicitPiece final : public Piece {
 public:
  /// Throws InputError where the curve is not proven to lie there.
  ImplicitPiece(const WrittenFormula& equation, const geometry::Bezier& beside,
                const geometry::Bezier& next);
  VectorOf<Series> about(const Ball& t) const override;

 private:
  Series equation(const VectorOf<Series>& at) const;
  VectorOf<Series> normal(const Ball& t) const;
  /// From a point beside it by s along the normal: two terms.
  Series across(const Ball& t, const Ball& s) const;
  bool is_beside(double low, double high, int depth) const;

  static constexpr double lowest = -0x1p-6,
                          highest = 1.0 - lowest;  ///< parameters of boxes about its points
  WrittenFormula equation_;
  PolynomialPiece beside_;
  geometry::Vector first_, last_;  ///< normals at the ends
  Ball off_;                       ///< contains how far it is
};

}  // namespace carom::certify
