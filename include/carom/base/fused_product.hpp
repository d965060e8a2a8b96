// a b + c, rounded once: on every machine the same number.
//
// A processor is asked once, when the program starts, whether it has an instruction for it; others
// compute it from exact products and sums. So formulas may round less and still give the same bits
// everywhere.
#pragma once

#include <type_traits>

namespace carom {

namespace detail {
/// Has this processor the instruction? False until the program's start has asked.
#if defined(__wasm__)
inline constexpr bool fuses = false;  // browsers have none whose result is certain
#else
extern bool fuses;
#endif
double fused_in_software(double a, double b, double c);
/// The same where a number is zero or near the ends of the doubles' range.
double fused_at_ends(double a, double b, double c);

// Exact products and sums of doubles, the last but one rounded to odd: so no middle between two
// doubles is met by chance (Boldo and Melquiond 2008). Here the product's rounding error is added
// last. If the sum of both errors is no double, a b + c was not one either; then that sum is below
// two last digits of a b + c, which is far enough from its last digit for the proof.
[[gnu::always_inline]] inline double fused_by_sums(double a, double b, double c) {
  const double p = a * b;
  const auto size = [](double x) { return __builtin_fabs(x); };
  // Products of halves, and what they leave, are doubles then.
  if (__builtin_expect(!(size(a) + size(b) + size(c) < 0x1p500) | !(size(p) > 0x1p-900), 0))
    return fused_at_ends(a, b, c);
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
}  // namespace detail

/// What fused_product does with a kind of number: of exact numbers, balls and the like product and
/// sum as they are.
template <class Number>
struct FusedProduct {
  static constexpr Number of(const Number& a, const Number& b, const Number& c) {
    return a * b + c;
  }
};

template <>
struct FusedProduct<double> {
#if defined(__x86_64__) && !defined(__FMA__)
  [[gnu::always_inline]] static double by_instruction(double a, double b, double c) {
    // Made for processors without it, a program has no other way to name the instruction than this.
    asm("vfmadd231sd %2, %1, %0" : "+x"(c) : "x"(a), "xm"(b));
    return c;
  }
  [[gnu::always_inline]] static constexpr double of(double a, double b, double c) {
    if (std::is_constant_evaluated()) return __builtin_fma(a, b, c);
    return __builtin_expect(detail::fuses, 1) ? by_instruction(a, b, c)
                                              : detail::fused_in_software(a, b, c);
  }
#elif defined(__wasm__)
  [[gnu::always_inline]] static constexpr double of(double a, double b, double c) {
    if (std::is_constant_evaluated()) return __builtin_fma(a, b, c);
    return detail::fused_by_sums(a, b, c);
  }
#else
  [[gnu::always_inline]] static double of(double a, double b, double c) {
    return __builtin_fma(a, b, c);
  }
#endif
};

/// a b + c. Of doubles and of registers of them: rounded once.
template <class Number>
[[gnu::always_inline]] constexpr Number fused_product(const Number& a, const Number& b,
                                                      const Number& c) {
  return FusedProduct<Number>::of(a, b, c);
}

}  // namespace carom
