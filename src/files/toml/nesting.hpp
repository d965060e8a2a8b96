// How deep and how long a TOML text is, before it is parsed: the parser calls itself for each level
// and keeps each value, so a small text could take all of the stack, and a long one all memory.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "carom/base/error.hpp"

namespace carom::files {

/// Parts of a dotted key and of a header, lists and tables in each other, together. System files
/// need about six; at 64 no function that follows the levels needs more than a few 10 kB of stack.
inline constexpr std::size_t most_levels = 64;
/// Values of one text. A million starts of four numbers are five million; each takes about 250
/// bytes.
inline constexpr std::size_t most_values = 6'000'000;

/// Throws InputError, with line and column, where the text has more levels or more values.
void check_nesting(std::string_view toml, const std::string& file);
/// The same for a value alone; the error has this place.
void check_nesting_of_value(std::string_view value, const Place& place);

}  // namespace carom::files
