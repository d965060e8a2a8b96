// Text in SVG and HTML.
#pragma once

#include <string>

#include "base/printable.hpp"

namespace carom::cli {

/// The characters that begin or end marks are replaced by their names, and those that XML does not
/// know by what shows them.
inline std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : base::printable(text, base::Lines::many))
    out += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
  return out;
}

}  // namespace carom::cli
