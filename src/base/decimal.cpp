#include "carom/base/decimal.hpp"

#include <charconv>
#include <cmath>
#include <system_error>
#if !defined(__cpp_lib_to_chars)  // libc++
#include <fast_float/fast_float.h>
#endif

namespace carom {

namespace {
#if defined(__cpp_lib_to_chars)
using std::from_chars;
#else
using fast_float::from_chars;
#endif
}  // namespace

std::optional<double> nearest_double(std::string_view decimal) {
  double x = 0.0;
  const char* const last = decimal.data() + decimal.size();
  const auto [end, error] = from_chars(decimal.data(), last, x);
  if (error != std::errc{} || end != last) return {};
  // Some readers give infinity and zero for what is outside of the range.
  const std::string_view digits = decimal.substr(0, decimal.find_first_of("eE"));
  if ((std::isinf(x) || x == 0.0) && digits.find_first_of("123456789") != digits.npos) return {};
  return x;
}

}  // namespace carom
