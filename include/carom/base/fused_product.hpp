// a b + c, rounded once: on every machine the same number.
//
// A processor is asked once, when the program starts, whether it has an instruction for it; others
// compute it from exact products and sums. So formulas may round less and still give the same bits
// everywhere.
#pragma once

#include <type_traits>

namespace carom {
#if !defined(__wasm__)
namespace detail {
/// Has this processor the instruction? False until the program's start has asked.
extern bool fuses;
double fused_in_software(double a, double b, double c);
}  // namespace detail
#endif
/// What fused_product does with a kind of number: of exact numbers, balls and the like product and
/// sum as they are.
template <class Number>
struct FusedProduct {
  static constexpr Number of(const Number& a, const Number& b, const Number& c) {
    return a * b + c;
  }
};
#if !defined(__wasm__)  // as below
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
#else
  [[gnu::always_inline]] static double of(double a, double b, double c) {
    return __builtin_fma(a, b, c);
  }
#endif
};
#endif
/// a b + c. Of doubles and of registers of them: rounded once.
template <class Number>
[[gnu::always_inline]] constexpr Number fused_product(const Number& a, const Number& b,
                                                      const Number& c) {
  return FusedProduct<Number>::of(a, b, c);
}

}  // namespace carom

#if defined(__wasm__)  // browsers have no instruction whose result is certain
#include "carom/base/fused_by_sums.hpp"

namespace carom {

namespace detail {
inline constexpr bool fuses = false;
}  // namespace detail

template <>
struct FusedProduct<double> {
  [[gnu::always_inline]] static constexpr double of(double a, double b, double c) {
    return std::is_constant_evaluated() ? __builtin_fma(a, b, c) : detail::fused_by_sums(a, b, c);
  }
};

}  // namespace carom
#endif
