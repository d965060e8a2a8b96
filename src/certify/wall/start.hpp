// Where an orbit starts on a wall, in any arithmetic.
#pragma once

#include "certify/wall/wall.hpp"
#include "motion/point_on_conic.hpp"

namespace carom::certify {

/// The point of a wall with parameter u.
template <class N>
VectorOf<N> point_with_parameter(const WallOf<N>& w, double u) {
  if (w.form == Form::segment) return w.from + N(u) * w.chord;
  const VectorOf<N> a = w.from - w.centre;
  const VectorOf<N> b =
      w.form == Form::ellipse ? motion::quarter_turn(a, w.along, w.across) : left(a);
  return motion::point_on_conic(w.centre, a, w.turn < 0 ? -b : b, u);
}

}  // namespace carom::certify
