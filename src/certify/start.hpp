// Where an orbit starts on a wall, in any arithmetic.
#pragma once

#include <cmath>

#include "certify/wall.hpp"

namespace carom::certify {

/// The point of a wall with parameter u: the wall's rational parametrisation, by half angles within quarters.
template <class N>
VectorOf<N> point_with_parameter(const WallOf<N>& w, double parameter) {
  const double quarter = w.form == Form::segment ? 0.0 : std::floor(parameter);
  const N u(parameter - quarter), one(1);
  if (w.form == Form::segment) return w.from + u * w.chord;
  VectorOf<N> a = w.from - w.centre, b = left(a);
  if (w.form == Form::ellipse) {
    // The quarter turn of the frame in which the ellipse is a circle.
    const N determinant = cross(w.along, w.across);
    const N x = dot(a, w.along), y = dot(a, w.across);
    b = {(-(y * w.across.y) - x * w.along.y) / determinant, (y * w.across.x + x * w.along.x) / determinant};
  }
  if (w.turn < 0) b = -b;
  for (double q = 0.0; q < quarter; ++q) {
    const VectorOf<N> before = a;
    a = b;
    b = -before;
  }
  const N weight = one + square(u);
  return w.centre + (((one - square(u)) / weight) * a + ((u + u) / weight) * b);
}

}  // namespace carom::certify
