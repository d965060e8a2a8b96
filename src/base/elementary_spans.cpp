// Elementary functions of many numbers at once, by the widest registers there are.
#include <cstddef>

#include "carom/base/elementary.hpp"
#include "kernel/elementary_kernel.hpp"

namespace carom::elementary {

namespace {

int widest() {
#if defined(CAROM_WIDE_REGISTERS)
  if (__builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl")) return 8;
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return 4;
#endif
  return 2;
}

using AngleOfMany = void (*)(double* y, double x, std::size_t n);
AngleOfMany atan2_by([[maybe_unused]] int width) {
#if defined(CAROM_WIDE_REGISTERS)
  if (width >= 8) return base::atan2_of_many<8>;
  if (width >= 4) return base::atan2_of_many<4>;
#endif
  return base::atan2_of_many<2>;
}

}  // namespace

ExpOfMany exp_by(int multiple) {
  [[maybe_unused]] static const int most = widest();
  [[maybe_unused]] const int width = most < multiple ? most : multiple;
#if defined(CAROM_WIDE_REGISTERS)
  if (width >= 8) return base::exp_of_many<8>;
  if (width >= 4) return base::exp_of_many<4>;
#endif
  return base::exp_of_many<2>;
}

void exp(std::span<double> x) {
  static const ExpOfMany several = exp_by(8);
  const std::size_t whole = x.size() / 8 * 8;
  several(x.data(), whole);
  for (double& one : x.subspan(whole)) one = exp(one);
}

void atan2(std::span<double> y, double x) {
  static const AngleOfMany several = atan2_by(widest());
  const std::size_t whole = y.size() / 8 * 8;
  several(y.data(), x, whole);
  for (double& one : y.subspan(whole)) one = atan2(one, x);
}

}  // namespace carom::elementary
