// Flights on Larmor circles to a wall that is known, and the reflection there.
#pragma once

#include "certify/flight/larmor_quartic.hpp"

namespace carom::certify {

/// a kappa^2 + b kappa + c, which has the sign of the distance on the domain's side.
template <class N>
struct LarmorQuadratic {
  N a{}, b{}, c{};
};

/// Of a segment or circle. `standing`: P lies on it, so that a is zero.
template <class N, class C>
LarmorQuadratic<N> larmor_quadratic(const WallOf<C>& w, const VectorOf<N>& P, const VectorOf<N>& v,
                                    const MotionOf<C>& motion, bool standing) {
  const C& h = motion.half_omega;
  LarmorQuadratic<N> f;
  if (w.form == Form::segment) {
    f.b = dot2(v, w.normal);
    f.c = -(h * dot2(v, w.chord));
    if (standing) return f;
    f.a = dot2(minus(P, w.from), w.normal);
    f.c = f.c + f.a * square(h);
    return f;
  }
  const VectorOf<N> e = minus(P, w.centre);
  const N ev = dot2(e, v);
  f.b = ev + ev;
  f.c = (h + h) * (e.x * v.y - e.y * v.x) + (square(v.x) + square(v.y));
  if (!standing) {
    f.a = (square(e.x) + square(e.y)) - w.radius2;
    f.c = f.c + f.a * square(h);
  }
  return w.turn > 0 ? LarmorQuadratic<N>{-f.a, -f.b, -f.c} : f;
}

template <class N>
N discriminant_of(const LarmorQuadratic<N>& f) {
  const N product = f.a * f.c, twice = product + product;
  return square(f.b) - (twice + twice);
}

/// Where the flight leaves the domain: the root at which the quadratic rises with kappa. Of the two
/// formulas the one in which nothing cancels is taken.
template <class N>
Kappa<N> rising_root(const LarmorQuadratic<N>& f, const N& discriminant) {
  using std::sqrt;
  const N root = sqrt(discriminant);
  if (middle_of(f.b) < 0.0) return {root - f.b, f.a + f.a};
  return {-(f.c + f.c), f.b + root};
}
/// On the wall that the flight comes from one root is known, and the other is rational.
template <class N>
Kappa<N> second_root(const LarmorQuadratic<N>& f) {
  return {-f.c, f.b};
}

/// Where a flight in a field from P with velocity v meets the wall `w`.
template <class N, class C>
Kappa<N> larmor_place(const WallOf<C>& w, const VectorOf<N>& P, const VectorOf<N>& v,
                      const MotionOf<C>& motion, bool standing) {
  if (w.form == Form::ellipse) return ellipse_exit(w, P, v, motion, standing);
  const LarmorQuadratic<N> f = larmor_quadratic<N, C>(w, P, v, motion, standing);
  return standing ? second_root(f) : rising_root(f, discriminant_of(f));
}

/// The flight in a field from P with velocity v to the wall `w` and the reflection there.
template <class N, class C>
LandingOf<N> fly_larmor(const WallOf<C>& w, const VectorOf<N>& P, const VectorOf<N>& v,
                        const MotionOf<C>& motion, bool standing) {
  const Kappa<N> k = larmor_place<N, C>(w, P, v, motion, standing);
  LandingOf<N> r = larmor_state<N, C>(k, P, v, motion.half_omega);
  r.time = time_at(k, motion);
  VectorOf<N>& u = r.velocity;
  if (w.form == Form::segment) {
    const N factor = dot2(u, w.normal) * w.double_inverse;
    u = {u.x - factor * w.normal.x, u.y - factor * w.normal.y};
    return r;
  }
  u = reflected(u, normal_at<N, C>(w, r.position));
  return r;
}

/// Straight or on a Larmor circle, as the particle moves.
template <class N, class C>
LandingOf<N> flight_to(const WallOf<C>& w, const VectorOf<N>& P, const VectorOf<N>& v,
                       const MotionOf<C>& motion, bool standing) {
  return motion.turns ? fly_larmor<N, C>(w, P, v, motion, standing)
                      : fly<N, C>(w, P, v, motion, standing);
}

}  // namespace carom::certify
