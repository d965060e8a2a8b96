// A character of a text as a message shows it.
#pragma once

#include <string>
#include <string_view>

namespace carom {

/// Is the byte one of a UTF-8 character's but its first?
inline bool continues_character(char c) { return (static_cast<unsigned char>(c) & 0xc0) == 0x80; }

/// The whole character that begins at `at` < text.size(), in quotes.
inline std::string shown_character(std::string_view text, std::size_t at) {
  const auto byte = static_cast<unsigned char>(text[at]);
  if (byte < 0x20 || byte == 0x7f) return "control character";
  std::size_t end = at + 1;
  while (end < text.size() && continues_character(text[end])) ++end;
  return std::string("'").append(text.substr(at, end - at)).append("'");
}

}  // namespace carom
