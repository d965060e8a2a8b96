// The first trajectories of an ensemble, flown a second time in another way from the same starts.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>

#include "carom/motion/state.hpp"
#include "carom/system/system.hpp"
#include "validation/rounding/paired_survival.hpp"

namespace carom {

/// How a trajectory ends in the other way: `end`, unless it is singular or that is not known.
struct OtherEnd {
  enum Kind : unsigned char { known, singular, unknown } kind = unknown;
  PairedEnd end{};
};
/// Flies a trajectory from that start in the other way.
using OtherFlight = std::function<OtherEnd(const State& start)>;

/// Which trajectories, and when two ends are the same.
struct PairedEscapeOptions {
  std::uint64_t sample = 10000;  ///< trajectories 0 … sample - 1
  /// Ends that differ by no more are the same, in times the size of the table over the speed.
  double tolerance = 1e-3;
  int threads = 0;  ///< 0: as many as OpenMP gives
  std::uint64_t swaps = 10000;
  std::function<void(std::uint64_t done)> progress;  ///< called by one thread at a time
  const std::atomic<bool>* interrupted = nullptr;
};

/// How often the two ends of a start differ, and whether the two survival curves do.
struct PairedEscapeResult {
  PairedResult pairs;
  /// Pairs that are not compared: the engine's orbit ended as singular (or unresolved; or lost: an
  /// internal error), the other one did, its end is not known.
  std::uint64_t singular = 0, unresolved = 0, lost = 0, other_singular = 0, unknown = 0;
  bool complete = true;
  int threads = 1;
  double seconds = 0.0, cpu_seconds = 0.0;
};

/// Flies them with the engine, which gives the ensemble's own bits, and by what `make` makes for
/// each thread. The system has one particle.
PairedEscapeResult compare_escapes(const System&, const std::function<OtherFlight()>& make,
                                   const PairedEscapeOptions&);

}  // namespace carom
