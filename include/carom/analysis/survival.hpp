// Survival probability and escape rate as exact counts.
#pragma once

#include <cstdint>
#include <vector>

#include "carom/motion/state.hpp"

namespace carom {

/// 95 % interval of Wilson (1927) for k successes of n.
struct Interval {
  double low = 0.0, high = 1.0;
};
Interval wilson_interval(std::uint64_t successes, std::uint64_t trials);

/// Numbers of hits n at which survival by hits is reported: 0, 1, 2, 3, 5, 10, 20, 30, 50, … < 2^63.
const std::vector<std::uint64_t>& reported_hits();

/// Counts of an ensemble; merging is addition, so that order cannot matter.
struct SurvivalCounts {
  std::vector<double> times;              ///< report times, increasing
  std::vector<std::uint64_t> gone_by;     ///< gone_by[i]: gone at a time <= times[i]
  std::vector<std::uint64_t> gone_by_hits;///< per reported_hits()[i]: gone after at most so many hits
  std::uint64_t trajectories = 0, escaped = 0, survived = 0, pinned = 0, capped = 0, singular = 0,
                unbounded = 0, lost = 0, collisions = 0;
  std::vector<std::uint64_t> hole_escapes;

  SurvivalCounts() = default;
  SurvivalCounts(std::vector<double> times, std::size_t holes);
  /// One trajectory's end. `time` is the time it was gone for escaped and unbounded ones.
  void add(Fate fate, double time, std::uint64_t hits, int hole);
  void merge(const SurvivalCounts& other);
};

struct SurvivalPoint {
  double t, p, low, high;
};
struct SurvivalHitsPoint {
  std::uint64_t n;
  double p, low, high;
};
/// Escapes per unit time, normalised to all non-singular trajectories: p_e(t) = -dP/dt averaged over
/// [from, to); `t` is the middle of it (geometric where from > 0).
struct RatePoint {
  double t, from, to, value, low, high;
};
std::vector<SurvivalPoint> survival(const SurvivalCounts&);
std::vector<SurvivalHitsPoint> survival_by_hits(const SurvivalCounts&);
std::vector<RatePoint> escape_rate(const SurvivalCounts&);

}  // namespace carom
