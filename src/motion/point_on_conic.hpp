// Points of circles and ellipses by their parameter: the rational parametrisation by half angles
// within quarters.
#pragma once

#include <cmath>

#include "carom/geometry/vector.hpp"

namespace carom::motion {

/// The quarter turn of `a` in the frame where the ellipse with these axes over squared semi-axes is
/// a circle.
template <class N>
geometry::BasicVector<N> quarter_turn(const geometry::BasicVector<N>& a,
                                      const geometry::BasicVector<N>& along,
                                      const geometry::BasicVector<N>& across) {
  const N determinant = cross(along, across), x = dot(a, along), y = dot(a, across);
  return {(-(y * across.y) - x * along.y) / determinant,
          (y * across.x + x * along.x) / determinant};
}

/// `a`: from the centre to the start; `b`: its quarter turn in the sense of the curve.
template <class N>
geometry::BasicVector<N> point_on_conic(const geometry::BasicVector<N>& centre,
                                        geometry::BasicVector<N> a, geometry::BasicVector<N> b,
                                        double parameter) {
  const double quarter = std::floor(parameter);
  for (double q = 0.0; q < quarter; ++q) {
    const geometry::BasicVector<N> before = a;
    a = b;
    b = -before;
  }
  const N u(parameter - quarter), one(1.0), weight = one + u * u;  // the difference is exact
  return centre + (((one - u * u) / weight) * a + ((u + u) / weight) * b);
}

}  // namespace carom::motion
