// Intervals of two doubles: fast enclosures for what needs few digits (which wall is next, how
// errors grow). Each end is rounded to nearest and then moved outwards by more than its rounding.
#pragma once

#include <algorithm>
#include <cmath>

#include "carom/base/sign.hpp"
#include "certify/number/ball.hpp"

namespace carom::certify {

struct Interval {
  double low = 0.0, high = 0.0;

  Interval() = default;
  Interval(double x) : low(x), high(x) {}  // NOLINT: exact
  Interval(double l, double h) : low(l), high(h) {}

  /// The ends rounded outwards: half an ulp is at most 2^-53 |x|, or 2^-1075 where doubles are
  /// denormal. (An end that ran over in the wrong direction becomes no number: of such an interval
  /// no sign is known.)
  static Interval outwards(double l, double h) {
    return {l - (std::fabs(l) * 0x1p-52 + 0x1p-1074), h + (std::fabs(h) * 0x1p-52 + 0x1p-1074)};
  }

  friend Interval operator+(const Interval& a, const Interval& b) {
    return outwards(a.low + b.low, a.high + b.high);
  }
  friend Interval operator-(const Interval& a, const Interval& b) {
    return outwards(a.low - b.high, a.high - b.low);
  }
  friend Interval operator-(const Interval& a) { return {-a.high, -a.low}; }
  friend Interval operator*(const Interval& a, const Interval& b) {
    return around(a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high);
  }
  friend Interval operator/(const Interval& a, const Interval& b) {
    if (!(b.low > 0.0 || b.high < 0.0)) return {-HUGE_VAL, HUGE_VAL};
    return around(a.low / b.low, a.low / b.high, a.high / b.low, a.high / b.high);
  }

  double middle() const { return 0.5 * low + 0.5 * high; }
  double size() const { return std::max(std::fabs(low), std::fabs(high)); }

 private:
  /// A product of infinite ends may be NaN (0 times infinity), which min and max would ignore: the
  /// result is then the whole line.
  static Interval around(double p, double q, double r, double s) {
    if (std::isnan(p + q + r + s)) return {-HUGE_VAL, HUGE_VAL};
    return outwards(std::min(std::min(p, q), std::min(r, s)),
                    std::max(std::max(p, q), std::max(r, s)));
  }
};

/// The root of a number that is known not to be negative.
inline Interval sqrt(const Interval& a) {
  const Interval r =
      Interval::outwards(std::sqrt(std::max(a.low, 0.0)), std::sqrt(std::max(a.high, 0.0)));
  return {std::max(r.low, 0.0), r.high};
}
inline Interval square(const Interval& a) {
  const Interval r = a * a;
  return {std::max(r.low, 0.0), r.high};
}
inline Sign sign(const Interval& a) {
  if (a.low > 0.0) return Sign::positive;
  if (a.high < 0.0) return Sign::negative;
  return a.low == 0.0 && a.high == 0.0 ? Sign::zero : Sign::undecided;
}

/// Encloses a ball that may be off by `error` besides.
inline Interval interval_of(const Ball& x, const Bound& error = {}) {
  const Bound all = x.radius() + error;
  const double radius = all.to_double();  // rounded up
  const double low = arf_get_d(arb_midref(x.raw()), ARF_RND_FLOOR);
  const double high = arf_get_d(arb_midref(x.raw()), ARF_RND_CEIL);
  if (radius == 0.0 && low == high) return low;
  return Interval::outwards(low - radius, high + radius);
}

// Plain doubles, taken at their word: pilots and runs without a guarantee.
inline Sign sign(double x) { return x > 0 ? Sign::positive : x < 0 ? Sign::negative : Sign::zero; }
inline double square(double x) { return x * x; }

}  // namespace carom::certify
