// The parts of a text between separators.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

namespace carom::base {

/// "a,,b" has three parts; a text without the separator is one part.
inline std::vector<std::string> parts_of(const std::string& text, char between) {
  std::vector<std::string> parts;
  for (std::size_t start = 0; start <= text.size();) {
    const std::size_t end = std::min(text.find(between, start), text.size());
    parts.push_back(text.substr(start, end - start));
    start = end + 1;
  }
  return parts;
}

}  // namespace carom::base
