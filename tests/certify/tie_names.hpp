// What a sentence about an exact tie names, whatever its words: tests of words are in
// tests/cli/messages.txt.
#pragma once

#include <algorithm>
#include <cctype>
#include <string>

namespace carom::tests {

/// Its numbers, its names in quotes and its multiples of pi, in their order, separated by blanks:
/// "7 left bottom pi/2" of "event 7: … 'left' … 'bottom' … pi/2".
inline std::string named_in(const std::string& sentence) {
  std::string names;
  const auto add = [&](const std::string& name) { names += (names.empty() ? "" : " ") + name; };
  for (std::size_t i = 0; i < sentence.size(); ++i) {
    if (sentence[i] == '\'') {
      const std::size_t end = sentence.find('\'', i + 1);
      if (end == std::string::npos) break;
      add(sentence.substr(i + 1, end - i - 1));
      i = end;
    } else if (std::isdigit(static_cast<unsigned char>(sentence[i])) != 0 ||
               sentence.compare(i, 3, "pi/") == 0) {
      const std::size_t end = std::min(sentence.find_first_of(" ,:", i), sentence.size());
      add(sentence.substr(i, end - i));
      i = end;
    }
  }
  return names;
}

}  // namespace carom::tests
