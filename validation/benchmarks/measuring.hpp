// CPU time, alone and in links of a chain of dependent square roots and divisions in the same run.
#pragma once

#include <time.h>

#include <algorithm>
#include <cmath>

namespace carom::bench {

inline double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Nanoseconds of one link of x -> 1 + 1/sqrt(x).
inline double chain() {
  static double x = 1.5;
  const double start = cpu_seconds();
  for (int i = 0; i < 100'000; ++i) x = 1.0 + 1.0 / std::sqrt(x);
  return (cpu_seconds() - start) / 1e5 * 1e9 + (x < 0.0 ? 1.0 : 0.0);
}

/// Of something done several times: the best of nanoseconds and of links.
struct Best {
  double each = 1e300, ratio = 1e300;
  /// `run` returns how many it did.
  template <class Run>
  void repeat(int times, const Run& run) {
    for (int i = 0; i < times; ++i) {
      const double link = chain();
      const double start = cpu_seconds();
      const double done = run();
      const double now = (cpu_seconds() - start) / done * 1e9;
      each = std::min(each, now);
      ratio = std::min(ratio, now / std::min(link, chain()));
    }
  }
};

}  // namespace carom::bench
