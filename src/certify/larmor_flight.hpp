// Flights on Larmor circles: to a wall that is known, and the reflection there. One formula for balls,
// intervals, their tangent maps and plain doubles.
//
// A place on the circle is kappa = (omega/2) cot(omega t/2), which is 1/t without field and falls from
// +infinity to -infinity in one turn. It is kept as a ratio p/q with q > 0: then places just after the start and just
// before the end of a turn, where kappa is large and q small, need no division by q, and nothing cancels
// for weak fields. docs/physics/exactness.md derives the polynomials.
#pragma once

#include "certify/flight.hpp"

namespace carom::certify {

/// J v: a velocity v has the acceleration omega J v.
template <class N>
VectorOf<N> right_of(const VectorOf<N>& v) {
  return {v.y, -v.x};
}

/// The place p/q on a Larmor circle, up to a common sign.
template <class N>
struct Kappa {
  N p{}, q{};
};

/// a kappa^2 + b kappa + c, which has the sign of the distance on the domain's side.
template <class N>
struct LarmorQuadratic {
  N a{}, b{}, c{};
};

// For a choice between formulas of the same number.
inline double middle_of(double x) { return x; }
inline double middle_of(const Interval& x) { return x.middle(); }
inline double middle_of(const Ball& x) { return x.to_double(); }
template <class N>
double middle_of(const Dual<N>& x) {
  return middle_of(x.value);
}

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

/// Where a flight is at kappa, and its velocity there.
template <class N, class C>
LandingOf<N> larmor_state(const Kappa<N>& k, const VectorOf<N>& P, const VectorOf<N>& v, const C& h) {
  const N hq = h * k.q;
  const N share = k.q / (square(k.p) + square(hq));
  const N ahead = k.p * share, aside = hq * share;
  const VectorOf<N> Jv = right_of(v);
  const C omega = h + h;
  const N less = omega * aside, turned = omega * ahead;
  LandingOf<N> r;
  r.position = {P.x + (ahead * v.x + aside * Jv.x), P.y + (ahead * v.y + aside * Jv.y)};
  r.velocity = {v.x + (turned * Jv.x - less * v.x), v.y + (turned * Jv.y - less * v.y)};
  return r;
}

/// The time from the start of the flight, within its turn.
Ball time_at(const Kappa<Ball>&, const MotionOf<Ball>&);
double time_at(const Kappa<double>&, const MotionOf<double>&);
/// Of a tangent map only the slopes are asked for: dt = -dkappa/(kappa^2 + omega^2/4).
template <class N>
Dual<N> time_at(const Kappa<Dual<N>>& k, const MotionOf<N>& motion) {
  const N size = square(k.p.value) + square(motion.half_omega * k.q.value);
  return Dual<N>::each(N{}, [&](std::size_t i) {
    return (k.p.value * k.q.slope[i] - k.p.slope[i] * k.q.value) / size;
  });
}

/// The state after a time, without a wall.
LandingOf<Ball> larmor_state_after(const Ball& time, const BallVector& P, const BallVector& v, const Ball& h);

/// The flight in a field from P with velocity v to the wall `w` and the reflection there.
template <class N, class C>
LandingOf<N> fly_larmor(const WallOf<C>& w, const VectorOf<N>& P, const VectorOf<N>& v, const MotionOf<C>& motion,
                        bool standing) {
  const LarmorQuadratic<N> f = larmor_quadratic<N, C>(w, P, v, motion, standing);
  const Kappa<N> k = standing ? second_root(f) : rising_root(f, discriminant_of(f));
  LandingOf<N> r = larmor_state<N, C>(k, P, v, motion.half_omega);
  r.time = time_at(k, motion);
  VectorOf<N>& u = r.velocity;
  if (w.form == Form::segment) {
    const N factor = dot2(u, w.normal) * w.double_inverse;
    u = {u.x - factor * w.normal.x, u.y - factor * w.normal.y};
    return r;
  }
  const VectorOf<N> e = minus(r.position, w.centre);
  const N along_normal = e.x * u.x + e.y * u.y;
  const N factor = (along_normal + along_normal) / (square(e.x) + square(e.y));
  u = {u.x - factor * e.x, u.y - factor * e.y};
  return r;
}

/// Straight or on a Larmor circle, as the particle moves.
template <class N, class C>
LandingOf<N> flight_to(const WallOf<C>& w, const VectorOf<N>& P, const VectorOf<N>& v, const MotionOf<C>& motion,
                       bool standing) {
  return motion.turns ? fly_larmor<N, C>(w, P, v, motion, standing) : fly<N, C>(w, P, v, motion, standing);
}

}  // namespace carom::certify
