// The tests of every day are small; with CAROM_SOAK set they do all that they are for (ctest -C
// Soak -L soak).
#pragma once

#include <cstdlib>

namespace carom::tests {

inline bool soak() { return std::getenv("CAROM_SOAK") != nullptr; }

/// How many cases.
inline long cases(long everyday, long all) {
  static const bool soaked = soak();
  return soaked ? all : everyday;
}

}  // namespace carom::tests
