// Compiled for registers of CAROM_WIDTH numbers: the text of one number, base/elementary_fast.hpp.
#include "base/kernel/elementary_kernel.hpp"

#include <cstring>

#include "base/elementary_fast.hpp"
#include "carom/base/elementary.hpp"

namespace carom::base {

namespace {

constexpr int width = CAROM_WIDTH;
typedef double Numbers __attribute__((vector_size(8 * width)));

#if defined(__FMA__) || !(defined(__x86_64__) || defined(__wasm__))
using Products = fast::Fusing;
#else
using Products = fast::Splitting;
#endif

constexpr std::size_t block = 64;

/// By the quick way; what that leaves open, one by one.
CAROM_INLINE void each(double* x, std::size_t n, auto quick, auto one) {
  alignas(64) double before[block], spreads[block];
  for (std::size_t from = 0; from < n; from += block) {
    const std::size_t count = n - from < block ? n - from : block;
    Numbers all_spreads{};  // none is negative
    for (std::size_t i = 0; i < count; i += width) {
      Numbers numbers;
      std::memcpy(&numbers, x + from + i, sizeof numbers);
      std::memcpy(before + i, &numbers, sizeof numbers);
      const fast::Result<Numbers> r = quick(numbers);
      std::memcpy(x + from + i, &r.value, sizeof numbers);
      std::memcpy(spreads + i, &r.spread, sizeof numbers);
      all_spreads += r.spread;
    }
    double sum = 0.0;
    for (int i = 0; i < width; ++i) sum += all_spreads[i];
    if (sum != 0.0) [[unlikely]]
      for (std::size_t i = 0; i < count; ++i)
        if (spreads[i] != 0.0) x[from + i] = one(before[i]);
  }
}

}  // namespace

template <>
void exp_of_many<width>(double* x, std::size_t n) {
  const fast::ExpTable& table = fast::exp_table();
  each(
      x, n,
      [&](const Numbers& a)
          __attribute__((always_inline)) { return fast::exp<Products>(table, a); },
      [](double a) { return elementary::exp(a); });
}

template <>
void atan2_of_many<width>(double* y, double x, std::size_t n) {
  const fast::AngleTable& table = fast::angle_table();
  each(
      y, n,
      [&](const Numbers& a) __attribute__((always_inline)) {
        return fast::atan2<Products>(table, a, fast::all<Numbers>(x));
      },
      [x](double a) { return elementary::atan2(a, x); });
}

}  // namespace carom::base
