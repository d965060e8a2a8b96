// Flights on Larmor circles to a wall that is known, and the reflection there.
#pragma once

#include "certify/flight/larmor_quartic.hpp"

namespace carom::certify {

using geometry::Quadratic;

/// The quadratic in kappa of a segment or circle, which has the sign of the distance on the
/// domain's side. `standing`: P lies on it, so that a is zero.
template <class N, class C>
Quadratic<N> larmor_quadratic(const WallOf<C>& w, const VectorOf<N>& P, const VectorOf<N>& v,
                              const MotionOf<C>& motion, bool standing) {
  const C& h = motion.half_omega;
  const C half(0.5);
  Quadratic<N> f;
  if (w.form == Form::segment) {
    f.b = half * dot2(v, w.normal);
    f.c = -(h * dot2(v, w.chord));
    if (standing) return f;
    f.a = dot2(minus(P, w.from), w.normal);
    f.c = f.c + f.a * square(h);
    return f;
  }
  const VectorOf<N> e = minus(P, w.centre);
  f.b = dot2(e, v);
  f.c = (h + h) * cross(e, v) + (square(v.x) + square(v.y));
  if (!standing) {
    f.a = (square(e.x) + square(e.y)) - w.radius2;
    f.c = f.c + f.a * square(h);
  }
  return w.turn > 0 ? -f : f;
}

/// As discriminant_of, with the square of an enclosure.
template <class N>
N discriminant(const Quadratic<N>& f) {
  return square(f.b) - f.a * f.c;
}

/// Where the flight leaves the domain: the root at which the quadratic rises with kappa. Of the two
/// formulas the one in which nothing cancels is taken.
template <class N>
Kappa<N> rising_root(const Quadratic<N>& f, const N& squared_root) {
  using std::sqrt;
  const N root = sqrt(squared_root);
  if (middle_of(f.b) < 0.0) return {root - f.b, f.a};
  return {-f.c, f.b + root};
}
/// On the wall that the flight comes from one root is known, and the other is rational.
template <class N>
Kappa<N> second_root(const Quadratic<N>& f) {
  return {-f.c, f.b + f.b};
}

/// Where a flight in a field from P with velocity v meets the wall `w`.
template <class N, class C>
Kappa<N> larmor_place(const WallOf<C>& w, const VectorOf<N>& P, const VectorOf<N>& v,
                      const MotionOf<C>& motion, bool standing) {
  if (w.form == Form::ellipse) return ellipse_exit(w, P, v, motion, standing);
  const Quadratic<N> f = larmor_quadratic<N, C>(w, P, v, motion, standing);
  return standing ? second_root(f) : rising_root(f, discriminant(f));
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
    u = reflected<N, C>(u, w.normal, dot2(u, w.normal) * w.double_inverse);
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
