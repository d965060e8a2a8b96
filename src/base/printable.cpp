#include "printable.hpp"

namespace carom::base {
namespace {

constexpr char digits[] = "0123456789abcdef";

std::string hexadecimal(char32_t number, int count) {
  std::string text;
  for (int shift = 4 * (count - 1); shift >= 0; shift -= 4) text += digits[number >> shift & 15];
  return text;
}

bool in(char32_t number, char32_t first, char32_t last) {
  return number >= first && number <= last;
}

}  // namespace

CodePoint code_point(std::string_view text, std::size_t at) {
  const auto byte = [&](std::size_t i) {
    return at + i < text.size() ? static_cast<unsigned char>(text[at + i]) : 0U;
  };
  const unsigned first = byte(0);
  if (first < 0x80) return {1, first};
  const std::size_t bytes = in(first, 0xc2, 0xdf) ? 2 : in(first, 0xe0, 0xef) ? 3 : 4;
  if (first < 0xc2 || first > 0xf4) return {};
  char32_t number = first & (0x7fU >> bytes);
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xc0U) != 0x80) return {};
    number = number << 6 | (byte(i) & 0x3fU);
  }
  // Written longer than needed, half of a pair of UTF-16, or beyond Unicode.
  const char32_t least = bytes == 2 ? 0x80 : bytes == 3 ? 0x800 : 0x10000;
  if (number < least || in(number, 0xd800, 0xdfff) || number > 0x10ffff) return {};
  return {bytes, number};
}

bool acts(char32_t number) {
  return number < 0x20 || in(number, 0x7f, 0x9f) || in(number, 0x200e, 0x200f) ||
         in(number, 0x2028, 0x202e) || in(number, 0x2066, 0x2069) || number == 0xfeff ||
         (number & 0xfffe) == 0xfffe;
}

std::string printable(std::string_view text, Lines lines) {
  std::string out;
  out.reserve(text.size());
  const bool many = lines == Lines::many;
  for (std::size_t at = 0; at < text.size();) {
    // Most texts are long rows of plain letters.
    std::size_t plain = at;
    while (plain < text.size() && (in(static_cast<unsigned char>(text[plain]), 0x20, 0x7e) ||
                                   (many && text[plain] == '\n')))
      ++plain;
    out += text.substr(at, plain - at);
    at = plain;
    if (at == text.size()) break;
    const auto [bytes, number] = code_point(text, at);
    const bool kept = many && number == '\t';
    if (bytes == 0) {
      out += "\\x" + hexadecimal(static_cast<unsigned char>(text[at]), 2);
    } else if (!acts(number) || kept) {
      out += text.substr(at, bytes);
    } else if (number == '\n') {
      out += "\\n";
    } else if (number < 0x20) {
      out += "\\x" + hexadecimal(number, 2);
    } else if (number > 0xffff) {
      out += "\\U" + hexadecimal(number, 8);
    } else {
      out += "\\u" + hexadecimal(number, 4);
    }
    at += bytes == 0 ? 1 : bytes;
  }
  return out;
}

}  // namespace carom::base
