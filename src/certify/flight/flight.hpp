// Straight flights: to a wall that is known, and the reflection there. One formula for balls,
// intervals, their tangent maps and plain doubles; it chooses nothing.
#pragma once

#include "certify/number/dual.hpp"
#include "certify/wall/wall.hpp"

namespace carom::certify {

/// A vector of variables minus one of constants, and similar: derivatives need two kinds of number.
template <class N, class C>
VectorOf<N> minus(const VectorOf<N>& a, const VectorOf<C>& b) {
  return {a.x - b.x, a.y - b.y};
}
template <class N, class C>
N dot2(const VectorOf<N>& a, const VectorOf<C>& b) {
  return a.x * b.x + a.y * b.y;
}

/// The velocity after a reflection takes `factor` = 2 (v . n)/(n . n) times the normal n from v.
template <class N, class C>
VectorOf<N> reflected(const VectorOf<N>& v, const VectorOf<C>& normal, const N& factor) {
  return {v.x - factor * normal.x, v.y - factor * normal.y};
}
/// The same where v . n is known.
template <class N>
VectorOf<N> reflected_by(const N& along_normal, const VectorOf<N>& v, const VectorOf<N>& normal) {
  const N factor = (along_normal + along_normal) / (square(normal.x) + square(normal.y));
  return reflected(v, normal, factor);
}
template <class N>
VectorOf<N> reflected(const VectorOf<N>& v, const VectorOf<N>& normal) {
  return reflected_by<N>(dot(normal, v), v, normal);
}

/// The flight from P with velocity v to the wall `w` and the reflection there. `standing`: P lies
/// on w.
template <class N, class C>
LandingOf<N> fly(const WallOf<C>& w, const VectorOf<N>& P, const VectorOf<N>& v,
                 const MotionOf<C>& motion, bool standing) {
  using std::sqrt;
  LandingOf<N> r;
  if (w.form == Form::segment) {
    const N speed_to_wall = dot2(v, w.normal);
    r.time = -(dot2(minus(P, w.from), w.normal) / speed_to_wall);
    r.position = P + r.time * v;
    r.velocity = reflected<N, C>(v, w.normal, speed_to_wall * w.double_inverse);
    return r;
  }
  if (w.form == Form::circle) {
    const VectorOf<N> e = minus(P, w.centre);
    const N b = dot2(e, v);
    // The velocity along e at the hit: inwards to an obstacle, outwards from inside.
    N outwards;
    if (standing) {
      outwards = -b;
    } else {
      const N c = (square(e.x) + square(e.y)) - w.radius2;
      outwards = sqrt(square(b) - c * motion.speed2);
      if (w.turn < 0) outwards = -outwards;
    }
    r.time = (outwards - b) * motion.inverse_speed2;
    const VectorOf<N> step = r.time * v;
    r.position = P + step;
    r.velocity = reflected<N, N>(v, e + step, outwards * w.double_inverse);
    return r;
  }
  const VectorOf<N> e = minus(P, w.centre);
  const N ex = dot2(e, w.along), ey = dot2(e, w.across), vx = dot2(v, w.along),
          vy = dot2(v, w.across);
  const N a = square(vx) + square(vy);
  const N b = ex * vx + ey * vy;
  N outwards;
  if (standing) {
    outwards = -b;
  } else {
    const N c = (square(ex) + square(ey)) - C(1);
    outwards = sqrt(square(b) - a * c);
    if (w.turn < 0) outwards = -outwards;
  }
  r.time = (outwards - b) / a;
  r.position = P + r.time * v;
  const N X = ex + r.time * vx, Y = ey + r.time * vy;
  const VectorOf<N> normal{X * w.along.x + Y * w.across.x, X * w.along.y + Y * w.across.y};
  // v . normal = (X, Y) . (vx, vy) = outwards.
  r.velocity = reflected_by<N>(outwards, v, normal);
  return r;
}

}  // namespace carom::certify
