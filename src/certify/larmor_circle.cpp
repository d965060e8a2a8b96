#include "certify/larmor_circle.hpp"

#include <algorithm>
#include <cmath>

#include "carom/base/elementary.hpp"

namespace carom::certify {

Ball time_at(const Kappa<Ball>& k, const MotionOf<Ball>& motion) {
  const Precision precision(std::min(Precision::bits(), motion.time_bits));
  const bool turned = arf_sgn(arb_midref(k.q.raw())) < 0;
  const Ball p = turned ? -k.p : k.p, q = turned ? -k.q : k.q;
  Ball h, angle;
  arb_abs(h.raw(), motion.half_omega.raw());
  const Ball y = h * q;
  if (sign(q) == Sign::positive)
    arb_atan2(angle.raw(), y.raw(), p.raw(), Precision::bits());
  else
    arb_indeterminate(angle.raw());  // just after the start or at the end of the turn?
  return angle / h;
}

double time_at(const Kappa<double>& k, const MotionOf<double>& motion) {
  const double h = std::fabs(motion.half_omega), turned = k.q < 0.0 ? -1.0 : 1.0;
  return elementary::atan2(h * turned * k.q, turned * k.p) / h;
}

LandingOf<Ball> larmor_state_after(const Ball& time, const BallVector& P, const BallVector& v,
                                   const Ball& h) {
  // kappa = h cos/sin (h t): p = h cos, q = sin, p^2 + h^2 q^2 = h^2.
  Kappa<Ball> k;
  const Ball angle = h * time;
  arb_sin_cos(k.q.raw(), k.p.raw(), angle.raw(), Precision::bits());
  const Ball ahead = k.p * k.q / h, aside = square(k.q) / h;
  const BallVector Jv = right_of(v);
  const Ball turned = (k.p * k.q) + (k.p * k.q), less = square(k.q) + square(k.q);
  LandingOf<Ball> r;
  r.time = time;
  r.position = {P.x + (ahead * v.x + aside * Jv.x), P.y + (ahead * v.y + aside * Jv.y)};
  r.velocity = {v.x + (turned * Jv.x - less * v.x), v.y + (turned * Jv.y - less * v.y)};
  return r;
}

}  // namespace carom::certify
