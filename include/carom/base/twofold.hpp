// Numbers of twice the digits: the unevaluated sum of two doubles.
#pragma once

#include <cmath>
#include <type_traits>

#include "carom/base/fused_product.hpp"

namespace carom {

/// high + low, |low| at most about an ulp of high. Results are good to some 2^-100 of their size,
/// so what a double lost in rounding can be computed. (Dekker 1971; Knuth's two-sum.)
struct Twofold {
  double high = 0.0, low = 0.0;

  constexpr Twofold() = default;
  constexpr Twofold(double value) : high(value) {}  // NOLINT: exact
  constexpr Twofold(double h, double l) : high(h), low(l) {}

  constexpr double value() const { return high + low; }

  /// a + b, exactly.
  static constexpr Twofold sum(double a, double b) {
    const double s = a + b, part = s - a;
    return {s, (a - (s - part)) + (b - part)};
  }
  /// The same where |a| >= |b| or nearly.
  static constexpr Twofold quick_sum(double a, double b) {
    const double s = a + b;
    return {s, b - (s - a)};
  }
  /// a b, exactly for numbers between 1e-140 and 1e140.
  static constexpr Twofold product(double a, double b) {
    const double p = a * b;
    // What p has lost is a double, so both ways find the same.
    if (!std::is_constant_evaluated() && detail::fuses) return {p, fused_product(a, b, -p)};
    constexpr double split = 134217729.0;  // 2^27 + 1
    const double ca = split * a, cb = split * b;
    const double a1 = ca - (ca - a), b1 = cb - (cb - b), a2 = a - a1, b2 = b - b1;
    return {p, ((a1 * b1 - p) + a1 * b2 + a2 * b1) + a2 * b2};
  }

  friend constexpr Twofold operator+(const Twofold& a, const Twofold& b) {
    const Twofold s = sum(a.high, b.high), t = sum(a.low, b.low);
    const Twofold r = quick_sum(s.high, s.low + t.high);
    return quick_sum(r.high, r.low + t.low);
  }
  friend constexpr Twofold operator-(const Twofold& a) { return {-a.high, -a.low}; }
  friend constexpr Twofold operator-(const Twofold& a, const Twofold& b) { return a + (-b); }
  friend constexpr Twofold operator*(const Twofold& a, const Twofold& b) {
    const Twofold p = product(a.high, b.high);
    return quick_sum(p.high, p.low + (a.high * b.low + a.low * b.high));
  }
  friend constexpr Twofold operator/(const Twofold& a, const Twofold& b) {
    const double q = a.high / b.high;
    const Twofold rest = a - Twofold(q) * b;
    return quick_sum(q, rest.value() / b.high);
  }
  friend constexpr Twofold square(const Twofold& a) { return a * a; }
  friend Twofold sqrt(const Twofold& a) {
    const double root = std::sqrt(a.high);
    if (root == 0.0) return {};
    return quick_sum(root, (a - product(root, root)).value() / (root + root));
  }
  friend bool operator==(const Twofold&, const Twofold&) = default;
};

}  // namespace carom
