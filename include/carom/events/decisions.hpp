// How the signs behind every event are decided, and by which stage.
#pragma once

#include <cstdint>

namespace carom {

/// How decisions are taken. Results never depend on it, only the time they take.
struct DecisionOptions {
  double filter_inflation = 1.0;  ///< factor on every bound of the filter (>= 1)
  int grid_from = 16;  ///< pieces of walls from which on a grid tells which are near a flight
};

/// Where decisions were taken.
struct DecisionCounts {
  std::uint64_t filter = 0;  ///< by double precision with its bound
  std::uint64_t exact = 0;   ///< by exact arithmetic
  DecisionCounts& operator+=(const DecisionCounts& o) {
    filter += o.filter;
    exact += o.exact;
    return *this;
  }
  friend DecisionCounts operator-(const DecisionCounts& a, const DecisionCounts& b) {
    return {a.filter - b.filter, a.exact - b.exact};
  }
};

}  // namespace carom
