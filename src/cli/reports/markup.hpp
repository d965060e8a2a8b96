// Text in SVG and HTML.
#pragma once

#include <string>

namespace carom::cli {

/// The characters that begin or end marks are replaced by their names.
inline std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text)
    out += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
  return out;
}

}  // namespace carom::cli
