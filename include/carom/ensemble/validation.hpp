// Checks of the engine against identities and published values.
#pragma once

#include <cstdint>
#include <string>

#include "carom/ensemble/system.hpp"

namespace carom {

/// A number with its own standard error beside the number it should be.
struct Comparison {
  double value = 0.0, error = 0.0, expected = 0.0;
  double distance() const { return error > 0.0 ? (value - expected) / error : value - expected; }
};

/// Mean time between hits from cosine starts on all walls (the invariant measure of the boundary map),
/// which is pi (A - A0) / L: A0 is the area of the centres of Larmor circles that meet no wall (Santalo;
/// Chernov 1997). The error is from the scatter over trajectories, since orbits need not be ergodic.
/// `system` starts on its boundary; its run.collisions and run.trajectories say how much is done.
Comparison mean_flight(const System& system, double expected);

/// Hits of a closed table, with what became of them.
struct Soak {
  std::uint64_t hits = 0, lost = 0, singular = 0, digest = 0;
  double filter_share = 1.0;  ///< of decisions, by double precision with its bound
  double cpu_seconds = 0.0;
  std::string report;         ///< the first state that was lost
};
Soak soak(const System& system, int threads);

}  // namespace carom
