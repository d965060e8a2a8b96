#include "carom/base/fused_product.hpp"

#include <bit>
#include <cmath>
#include <cstdint>

#include "carom/base/twofold.hpp"

namespace carom::detail {

#if defined(__x86_64__)
bool fuses = [] {
  __builtin_cpu_init();
  return __builtin_cpu_supports("fma") != 0;
}();
#else
bool fuses = true;
#endif

namespace {

/// a + b, rounded to the one of its two neighbours whose last digit is odd, if it is no double.
double odd_sum(double a, double b) {
  const Twofold s = Twofold::sum(a, b);
  auto bits = std::bit_cast<std::uint64_t>(s.high);
  if (s.low != 0.0 && (bits & 1) == 0) bits = (s.low > 0.0) == (s.high > 0.0) ? bits + 1 : bits - 1;
  return std::bit_cast<double>(bits);
}

}  // namespace

// A sum of three doubles is rounded right if what two of them leave is rounded to odd before the
// last sum (Boldo and Melquiond 2008): so no middle between two doubles is met by chance. Twenty
// times as fast as the C library's, which changes the rounding of the processor.
double fused_in_software(double a, double b, double c) {
  const auto moderate = [](double x, double least, double largest) {
    return std::fabs(x) > least && std::fabs(x) < largest;
  };
  if (a == 0.0 || b == 0.0) return a * b + c;
  if (!moderate(a, 0x1p-400, 0x1p400) || !moderate(b, 0x1p-400, 0x1p400)) return std::fma(a, b, c);
  if (c == 0.0) return a * b;
  if (!moderate(c, 0x1p-900, 0x1p900)) return std::fma(a, b, c);
  const Twofold product = Twofold::product(a, b);
  const Twofold low = Twofold::sum(c, product.low);
  const Twofold high = Twofold::sum(product.high, low.high);
  return high.high + odd_sum(low.low, high.low);
}

}  // namespace carom::detail
