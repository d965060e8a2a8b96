// Survival probability and escape rate as exact counts.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "carom/results/binary_bins.hpp"
#include "carom/results/fate_counts.hpp"
#include "carom/results/interval.hpp"

namespace carom {

namespace analyses {
class SortedEnds;
}

/// Numbers of escapes in bins of time, 64 bins to a factor of two.
using EscapeTimes = BinaryBins<6>;

/// Numbers of hits n at which survival by hits is reported: 0, 1, 2, 3, 5, 10, 20, 30, 50, … <
/// 2^63.
const std::vector<std::uint64_t>& reported_hits();

/// Trajectories that are gone, by time, by hits, by hole.
struct GoneCounts {
  std::vector<std::uint64_t> gone_in;       ///< gone in (times[i-1], times[i]]; from 0 for i = 0
  std::vector<std::uint64_t> gone_in_hits;  ///< gone after (n[i-1], n[i]] hits, n = reported_hits()
  std::vector<std::uint64_t> hole_escapes;  ///< by hole_names()

  void merge(const GoneCounts& other);
};
/// Those of one replicate of quasi-random starts.
struct Replicate : GoneCounts {
  std::uint64_t followed = 0;
};

/// What is one number for all trajectories. A new one is added here, and nowhere else.
struct SurvivalNumbers {
  std::uint64_t most_hits = 0;
  std::uint64_t fewest_hits_of_survivor = std::numeric_limits<std::uint64_t>::max();
  double energy_change = 0.0;  ///< set by the ensemble

  void note(Fate fate, std::uint64_t hits) {
    most_hits = std::max(most_hits, hits);
    if (fate == Fate::capped || fate == Fate::survived)
      fewest_hits_of_survivor = std::min(fewest_hits_of_survivor, hits);
  }
};
template <>
struct Fields<SurvivalNumbers> {
  using S = SurvivalNumbers;
  static constexpr std::tuple list{
      archived(joined(
          Join::largest,
          field("most_hits", "1", "Most reflections of a single trajectory", &S::most_hits))),
      archived(joined(Join::least,
                      field("fewest_hits_of_survivor", "1",
                            "Fewest reflections of a survivor that is not pinned; 2^64 - 1: none",
                            &S::fewest_hits_of_survivor))),
      reported_if(&System::has_forces,
                  joined(Join::largest,
                         field("energy_change", "energy",
                               "The largest change of a particle's energy", &S::energy_change)))};
};

/// Counts of an ensemble; merging is addition, so that order cannot matter.
///
/// A trajectory is *gone* when it escaped or is unbounded. The cap on hits ends a trajectory while
/// it is still there: it counts as a survivor at every time, and among those that survived.
struct SurvivalCounts : EndCounts, GoneCounts, SurvivalNumbers {
  std::vector<double> times;  ///< report times, increasing
  EscapeTimes gone_at;        ///< gone_in in fine bins, at all times
  /// Hits of those that are gone, less one: a bin from a to b, both rounded up, counts those that
  /// were gone after more than a hits and at most b. One that is gone after one hit or none is in
  /// no bin.
  EscapeTimes gone_after;
  /// Of quasi-random starts, which are not independent: the same counts of each replicate, whose
  /// spread tells the errors. Else empty.
  std::vector<Replicate> parts;

  SurvivalCounts() = default;
  /// `quasi_random`: are there replicates?
  SurvivalCounts(std::vector<double> times, std::size_t holes, bool quasi_random = false);
  /// One trajectory's end. `time` is the time it was gone for escaped and unbounded ones;
  /// `trajectory` is its index, which tells the replicate.
  void add(Fate fate, double time, std::uint64_t hits, int hole, std::uint64_t trajectory = 0);
  /// Adds the counts of another part of the same ensemble (same times, same holes).
  void merge(const SurvivalCounts& other);
  /// Trajectories whose fate is known: neither singular nor unresolved nor lost. Shares are taken
  /// of these.
  std::uint64_t followed() const { return trajectories - singular - unresolved - lost; }

 private:
  std::shared_ptr<const analyses::SortedEnds> ends_;  ///< of bins of times; none: no times
};

/// Share `p` that is still there at time t, with its 95 % interval (low, high).
struct SurvivalPoint {
  double t, p, low, high;
};
/// Share `p` that was not gone within n hits, with its 95 % interval.
struct SurvivalHitsPoint {
  std::uint64_t n;
  double p, low, high;
};
/// Escapes per unit time, normalised to all non-singular trajectories: p_e(t) = -dP/dt averaged
/// over (from, to]; `t` is the middle of it (geometric where from > 0).
struct RatePoint {
  double t, from, to, value, low, high;
};
template <>
struct Fields<SurvivalPoint> {
  using P = SurvivalPoint;
  static constexpr std::tuple list{field("t", "time", "Time", &P::t),
                                   field("p", "1", "Fraction still inside after t", &P::p),
                                   field("low", "1", "95 % interval, low end", &P::low),
                                   field("high", "1", "95 % interval, high end", &P::high)};
};
template <>
struct Fields<SurvivalHitsPoint> {
  using P = SurvivalHitsPoint;
  static constexpr std::tuple list{field("n", "1", "Reflections", &P::n),
                                   field("p", "1", "Fraction still inside after n hits", &P::p),
                                   field("low", "1", "95 % interval, low end", &P::low),
                                   field("high", "1", "95 % interval, high end", &P::high)};
};
template <>
struct Fields<RatePoint> {
  using P = RatePoint;
  static constexpr std::tuple list{field("t", "time", "Middle of the interval", &P::t),
                                   field("from", "time", "Start of the interval", &P::from),
                                   field("to", "time", "End of the interval", &P::to),
                                   field("value", "1/time", "Escape rate", &P::value),
                                   field("low", "1/time", "95 % interval, low end", &P::low),
                                   field("high", "1/time", "95 % interval, high end", &P::high)};
};

/// Share `p` that left through a hole, with its 95 % interval.
struct ExitPoint {
  double p, low, high;
};
/// p(t) at every report time.
std::vector<SurvivalPoint> survival(const SurvivalCounts&);
/// Up to the first reported number that no trajectory exceeded.
std::vector<SurvivalHitsPoint> survival_by_hits(const SurvivalCounts&);
/// Between each report time and the one before; from 0 to the first.
std::vector<RatePoint> escape_rate(const SurvivalCounts&);

/// By hole_names(), of all that were followed.
std::vector<ExitPoint> exits(const SurvivalCounts&);

}  // namespace carom
