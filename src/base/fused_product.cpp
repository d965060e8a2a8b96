#include "carom/base/fused_product.hpp"

#include <cmath>

#include "carom/base/fused_by_sums.hpp"

namespace carom::detail {

#if defined(__x86_64__)
bool fuses = [] {
  __builtin_cpu_init();
  return __builtin_cpu_supports("fma") != 0;
}();
#elif !defined(__wasm__)
bool fuses = true;
#endif

#if !defined(__wasm__)
// Twenty times as fast as the C library's, which changes the rounding of the processor.
double fused_in_software(double a, double b, double c) { return fused_by_sums(a, b, c); }
#endif

double fused_at_ends(double a, double b, double c) {
  return a == 0.0 || b == 0.0 ? a * b + c : std::fma(a, b, c);
}

}  // namespace carom::detail
