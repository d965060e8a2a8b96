// A character of a text as a message shows it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>

namespace carom::base {

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

/// "PROBLEM at character N of "TEXT"": the text if it is short and can be printed.
inline std::string at_character(const std::string& problem, std::size_t character,
                                std::string_view text) {
  std::string message = problem + " at character " + std::to_string(character);
  const auto control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; };
  const bool printable = std::none_of(text.begin(), text.end(), control);
  if (text.size() <= 60 && printable) message.append(" of \"").append(text).append("\"");
  return message;
}

}  // namespace carom::base
