// Texts of strangers as they may be shown: titles, names and messages go to terminals and into
// SVG, HTML and pictures.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace carom::base {

/// What a text may have beside visible characters.
enum class Lines { one, many };

/// The text with a visible name in place of each byte or character that a terminal or XML takes
/// for a command: \x1b for control characters and for bytes that are no UTF-8, \u202e for those
/// that turn the direction of writing, end lines or are no characters. `many`: ends of lines and
/// tabs stay. Names of characters above 0x7e are as in JSON, so that JSON stays what it is.
std::string printable(std::string_view text, Lines lines = Lines::one);

/// The number of bytes of the UTF-8 character at `at`, and its number; 0 bytes: it is none.
struct CodePoint {
  std::size_t bytes = 0;
  char32_t number = 0;
};
CodePoint code_point(std::string_view text, std::size_t at);
/// Is it a character that acts on what shows it: a control, a sign of direction, none at all?
bool acts(char32_t number);

}  // namespace carom::base
