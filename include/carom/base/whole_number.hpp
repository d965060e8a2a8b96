// Whole numbers among the exact ones.
#pragma once

#include <charconv>
#include <cstdint>
#include <optional>
#include <string>
#include <system_error>

#include "carom/base/exact_number.hpp"

namespace carom {

/// The value as a whole number from `least` to `most`; nothing where it is none of them.
inline std::optional<std::uint64_t> whole_number(const ExactNumber& value, std::uint64_t least = 0,
                                                 std::uint64_t most = UINT64_MAX) {
  const auto rational = value.to_rational();
  if (!rational || rational->denominator != "1") return {};
  const std::string& digits = rational->numerator;
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  const bool fits = error == std::errc{} && end == digits.data() + digits.size();
  if (!fits || number < least || number > most) return {};
  return number;
}

}  // namespace carom
