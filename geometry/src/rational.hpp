// Rational numbers and the doubles next to them.
#pragma once

#include <gmpxx.h>

#include <cmath>

namespace carom::geometry {

/// The nearest double, ties to even. mpq's own conversion cuts off.
inline double nearest(const mpq_class& q) {
  const double cut = q.get_d();
  if (!std::isfinite(cut)) return cut;
  const mpq_class rest = abs(q - mpq_class(cut));
  if (sgn(rest) == 0) return cut;
  const double next = std::nextafter(cut, sgn(q) * HUGE_VAL);
  if (!std::isfinite(next)) return cut;
  const mpq_class gap = abs(mpq_class(next) - mpq_class(cut));
  const int order = cmp(mpq_class(rest + rest), gap);
  if (order < 0) return cut;
  if (order > 0) return next;
  int exponent = 0;
  const double mantissa = std::ldexp(std::frexp(cut, &exponent), 53);
  return std::fmod(mantissa, 2.0) == 0.0 ? cut : next;
}

/// The largest double below q > 0.
inline double largest_below(const mpq_class& q) {
  const double cut = q.get_d();
  return mpq_class(cut) < q ? cut : std::nextafter(cut, 0.0);
}

}  // namespace carom::geometry
