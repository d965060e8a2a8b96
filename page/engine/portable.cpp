#include "portable.hpp"

#include <fast_float/fast_float.h>
#include <fmt/format.h>

#include <cstdio>
#include <string>

#include "read_double.hpp"

namespace std {

/// As printf's %g does.
to_chars_result to_chars(char* begin, char* end, double x, chars_format, int precision) {
  return {begin + snprintf(begin, static_cast<size_t>(end - begin), "%.*g", precision, x), {}};
}

/// The fewest digits that read back as x, in the shorter form, with or without an exponent.
to_chars_result to_chars(char* begin, char*, double x) {
  const double size = x < 0.0 ? -x : x;
  string text = "0";
  if (size > 0.0) {
    const auto decimal = fmt::detail::dragonbox::to_decimal(size);
    string digits = to_string(decimal.significand);
    int zeros = decimal.exponent;
    for (; digits.size() > 1 && digits.back() == '0'; digits.pop_back()) ++zeros;
    const int power = static_cast<int>(digits.size()) - 1 + zeros;
    text = zeros >= 0   ? fmt::format("{:.0f}", size)
           : power >= 0 ? string(digits).insert(static_cast<size_t>(power + 1), ".")
                        : "0." + string(static_cast<size_t>(-power - 1), '0') + digits;
    if (digits.size() > 1) digits.insert(1, ".");
    digits += fmt::format("e{}{:02}", power < 0 ? '-' : '+', power < 0 ? -power : power);
    if (digits.size() < text.size()) text = digits;
  }
  if (__builtin_signbit(x)) text.insert(0, 1, '-');
  return {copy(text.begin(), text.end(), begin), {}};
}

// What is too large is no number, as where the parser reads by streams.
from_chars_result from_chars(const char* begin, const char* end, double& x, chars_format) {
  const auto [next, error] = fast_float::from_chars(begin, end, x);
  return {next, __builtin_isinf(x) ? errc::invalid_argument : error};
}

}  // namespace std
