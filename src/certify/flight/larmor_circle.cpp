#include "certify/flight/larmor_circle.hpp"

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

void sin_cos(Ball& sin, Ball& cos, const Ball& angle) {
  arb_sin_cos(sin.raw(), cos.raw(), angle.raw(), Precision::bits());
}

}  // namespace carom::certify
