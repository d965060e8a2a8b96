// Places on Larmor circles. One formula for balls, intervals, their tangent maps and plain doubles.
//
// A place on the circle is kappa = (omega/2) cot(omega t/2), which is 1/t without field and falls
// from +infinity to -infinity in one turn. It is kept as a ratio p/q with q > 0: then places just
// after the start and just before the end of a turn, where kappa is large and q small, need no
// division by q, and nothing cancels for weak fields. docs/physics/exactness.md derives the
// polynomials.
#pragma once

#include "carom/geometry/formulas.hpp"
#include "certify/flight/flight.hpp"

namespace carom::certify {

/// The place p/q on a Larmor circle, up to a common sign.
template <class N>
struct Kappa {
  N p{}, q{};
};

// For a choice between formulas of the same number.
inline double middle_of(double x) { return x; }
inline double middle_of(const Interval& x) { return x.middle(); }
inline double middle_of(const Ball& x) { return x.to_double(); }
template <class N>
double middle_of(const Dual<N>& x) {
  return middle_of(x.value);
}

/// Where a flight is at kappa, and its velocity there.
template <class N, class C>
LandingOf<N> larmor_state(const Kappa<N>& k, const VectorOf<N>& P, const VectorOf<N>& v,
                          const C& h) {
  const N hq = h * k.q;
  const N share = k.q / (square(k.p) + square(hq));
  const geometry::FlightFactors<N> f{k.p * share, hq * share};
  LandingOf<N> r;
  r.position = P + displacement(f, v);
  const C omega = h + h;
  r.velocity = geometry::turned_by<N>(omega * f.along, omega * f.across, v);
  return r;
}

/// The time from the start of the flight, within its turn.
Ball time_at(const Kappa<Ball>&, const MotionOf<Ball>&);
double time_at(const Kappa<double>&, const MotionOf<double>&);
/// For tangent maps, which need only the slopes: dt = -dkappa/(kappa^2 + omega^2/4).
template <class N>
Dual<N> time_at(const Kappa<Dual<N>>& k, const MotionOf<N>& motion) {
  const N size = square(k.p.value) + square(motion.half_omega * k.q.value);
  return Dual<N>::each(N{}, [&](std::size_t i) {
    return (k.p.value * k.q.slope[i] - k.p.slope[i] * k.q.value) / size;
  });
}

void sin_cos(Ball& sin, Ball& cos, const Ball& angle);

/// The state after a time, without a wall: kappa = h cos/sin (h t).
template <class N>
LandingOf<N> larmor_state_after(const N& time, const VectorOf<N>& P, const VectorOf<N>& v,
                                const N& h) {
  N sin, cos;
  sin_cos(sin, cos, h * time);
  const geometry::FlightFactors<N> times_h{cos * sin, square(sin)};
  LandingOf<N> r;
  r.time = time;
  r.position = P + displacement<N>({times_h.along / h, times_h.across / h}, v);
  r.velocity =
      geometry::turned_by<N>(times_h.along + times_h.along, times_h.across + times_h.across, v);
  return r;
}

/// Position and velocity after a time without hits.
template <class N>
void fly_for(const N& time, VectorOf<N>& position, VectorOf<N>& velocity,
             const MotionOf<N>& motion) {
  if (!motion.turns) {
    position = position + time * velocity;
    return;
  }
  const LandingOf<N> there = larmor_state_after<N>(time, position, velocity, motion.half_omega);
  position = there.position;
  velocity = there.velocity;
}

}  // namespace carom::certify
