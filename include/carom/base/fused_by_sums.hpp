// a b + c, rounded once, where no instruction does it.
#pragma once

namespace carom::detail {

/// Where a number is zero or near the ends of the doubles' range.
double fused_at_ends(double a, double b, double c);

// a b = p + e and p + c = s + t, exactly. The sum of t and e is rounded to odd before it is added
// to s: so no middle between two doubles is met by chance (Boldo and Melquiond 2008, who add c to e
// first, by one exact sum more). Where it has to be rounded, it is below two last digits of s,
// which is near enough for their proof: if t is not 0, p and c do not cancel to less than half of
// p, and e is at most a last digit of s.
[[gnu::always_inline]] inline double fused_by_sums(double a, double b, double c) {
  const double p = a * b;
  const auto size = [](double x) { return __builtin_fabs(x); };
  const double most = size(a) + size(b) + size(c), product = size(p);
  // Products of halves, and what they leave, are doubles then.
  if (__builtin_expect(!(most < 0x1p500) | !(product > 0x1p-900), 0)) return fused_at_ends(a, b, c);
  constexpr double split = 134217729.0;  // 2^27 + 1
  const double ca = split * a, cb = split * b;
  const double a1 = ca - (ca - a), b1 = cb - (cb - b), a2 = a - a1, b2 = b - b1;
  const double e = ((a1 * b1 - p) + a1 * b2 + a2 * b1) + a2 * b2;
  const double s = p + c, c_in_s = s - p;
  const double t = (p - (s - c_in_s)) + (c - c_in_s);
  const double low = t + e, e_in_low = low - t;
  const double left = (t - (low - e_in_low)) + (e - e_in_low);
  // The neighbour of `low` on the side of what is left, or `low`: the one whose last digit is odd.
  const auto bits = __builtin_bit_cast(unsigned long long, low);
  const auto other_side = (bits ^ __builtin_bit_cast(unsigned long long, left)) >> 63;
  const auto odd = (bits - other_side) | 1;
  return s + (left != 0.0 ? __builtin_bit_cast(double, odd) : low);
}

}  // namespace carom::detail
