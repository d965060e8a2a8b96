// A piece of boundary as polynomials, for exact questions about its shape alone.
#pragma once

#include <vector>

#include "algebraic_root.hpp"
#include "exact_curve.hpp"

namespace carom::geometry {

/// The homogeneous point (x, y, weight)(w) of a stretch of the curve, w in [0, last]: a segment, or
/// a quarter turn of a conic.
struct Stretch {
  Polynomial x, y, weight;
};

/// Where a point of a curve's carrier (its line or conic) lies on the piece.
enum class Where { outside, start, inside, end };

/// A point of a stretch: a root of some polynomial.
struct Spot {
  const Stretch* stretch;
  AlgebraicRoot w;
};

class ExactPiece {
 public:
  ExactPiece(const Curve& curve, const DyadicVector& shift);

  const ExactCurve& curve() const { return curve_; }
  const std::vector<Stretch>& stretches() const { return stretches_; }
  /// The same, of which the last one, too, ends at w = 1.
  std::vector<Stretch> whole_stretches() const;
  /// Parameter of the end, rounded.
  double end() const { return static_cast<double>(stretches_.size() - 1) + last_.get_d(); }

  /// The implicit equation of the carrier along a stretch of another piece: identically zero
  /// exactly when both have one carrier.
  Polynomial equation(const Stretch& other) const;
  /// The carrier's equation at a point.
  int side(const ExactPoint& point) const;

  /// Place of a point of the carrier.
  Where where(const Spot& spot) const;
  Where where(const ExactPoint& point) const;
  /// Place of a root within stretch `index` of this piece, from its parameter.
  Where where_along(std::size_t index, const AlgebraicRoot& w) const;

 private:
  ExactCurve curve_;
  std::vector<Stretch> stretches_;
  mpq_class last_{1};  // end of the last stretch
};

Polynomial plus(const Polynomial& a, const Polynomial& b);
Polynomial times(const Dyadic& a, Polynomial p);
Polynomial times(const Polynomial& a, const Polynomial& b);
/// Linear form a.(X - weight P) along a stretch.
Polynomial form_along(const Stretch& s, const DyadicVector& a, const ExactPoint& p);
bool vanishes(const Polynomial& p);
/// Has p obviously no root in [0, 1]? Degree 10 at most.
bool keeps_sign_in_unit(const Polynomial& p);
/// The roots in [0, 1], ascending; quick where the polynomial obviously keeps its sign there.
std::vector<RealRoot> roots_in_unit(const Polynomial& p);
/// Does the stretch of a Bézier curve pass through a point?
bool passes_through(const Stretch& s, const ExactPoint& p);
/// Rounded place of a point of a stretch.
Vector rounded_point(const Stretch& s, double w);

}  // namespace carom::geometry
