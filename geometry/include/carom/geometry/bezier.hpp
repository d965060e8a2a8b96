// A Bézier curve made ready for double precision: its powers of u, each rounded once, with bounds.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "carom/geometry/curve.hpp"

namespace carom::geometry {

struct ExactCurve;

/// x(u) = control[0] + power[1] u + ... + power[degree] u^degree. `reach` and `speed` bound the
/// sums of |power[k]| and k |power[k]| over k >= 1, for each coordinate.
struct BezierForm {
  std::size_t degree = 0;
  std::array<Vector, Bezier::most + 1> control{}, power{};
  double reach = 0.0, speed = 0.0;
  /// Where the curve's first two or last two control points are one, x' vanishes at that end.
  bool rests_at_start = false, rests_at_end = false;
  /// x'(u) = u^a (1 - u)^b T(u): a, b are 1 at an end where the curve rests, else 0.
  std::size_t tangent_degree = 0;
  std::array<Vector, Bezier::most> tangent_power{};
  double tangent_size = 0.0;    ///< bounds the sum of |tangent_power[k]|, for each coordinate
  double least_tangent = 0.0;   ///< bounds |T(u)| from below
  std::vector<double> lengths;  ///< from the start to the ends of equal parts of [0, 1]

  /// Throws std::invalid_argument where the curve has a cusp between its ends, or comes so near to
  /// one that its tangents are not known to 2^-16.
  explicit BezierForm(const Bezier& curve);

  /// Horner: with U = 2^-53 a coefficient errs by U of itself, each step by 2U of what it sums, and
  /// the last sum by U of x: each coordinate by U (|x| + (2 degree + 1) reach).
  Vector point(double u) const {
    Vector x = power[degree];
    for (std::size_t k = degree - 1; k > 0; --k) x = power[k] + u * x;
    return control[0] + u * x;
  }
  /// dx/du. The same with k power[k], rounded once more: U (2 degree + 2) speed.
  Vector derivative(double u) const {
    Vector x = static_cast<double>(degree) * power[degree];
    for (std::size_t k = degree - 1; k > 0; --k) x = static_cast<double>(k) * power[k] + u * x;
    return x;
  }
  /// |dx/du|.
  double rate(double u) const {
    const Vector d = derivative(u);
    return std::sqrt(dot(d, d));
  }
  /// T(u), which points along the curve. By Horner: U (2 degree + 2) tangent_size.
  Vector tangent(double u) const {
    Vector x = tangent_power[tangent_degree];
    for (std::size_t k = tangent_degree; k-- > 0;) x = tangent_power[k] + u * x;
    return x;
  }
  double curvature(double u) const;
  double arc_length(double u) const;
  double area_beyond_chord() const;
  /// Parameter of the point of the curve that is nearest to a point beside it.
  double parameter_near(Vector point) const;

 private:
  void prepare_tangent(const ExactCurve& exact_curve);
};

}  // namespace carom::geometry
