// Lyapunov exponents of an ensemble, and which of its orbits are chaotic.
#pragma once

#include <cstdint>
#include <string>

#include "carom/analysis/fate_counts.hpp"
#include "carom/analysis/growth.hpp"
#include "carom/ensemble/parts.hpp"
#include "carom/ensemble/system.hpp"

namespace carom {

/// What a run adds up; of an interrupted one, whole trajectories.
struct LyapunovResult : EnsembleResult, FateCounts {
  /// Of the particles that were followed to the end of the window.
  GrowthSums growth;
  /// Particles of all trajectories; the fates are those before the end of the window.
  std::uint64_t trajectories = 0;
  std::uint64_t collisions = 0;

  /// Adds another part of the same ensemble. In any order the sum is the same, bit for bit. False,
  /// and no change, where a trajectory is in both.
  bool add(const LyapunovResult& other);
};

using LyapunovJournal = EnsembleJournal<LyapunovResult>;
using LyapunovOptions = EnsembleOptions<LyapunovResult>;

/// Are all particles one orbit, because they interact?
bool interacts(const System&);
/// Times between which the growth is taken: run.window, or the last four fifths of the run.
TimeWindow growth_window(const System&);

/// Follows two deviations along each trajectory until the end of the window: exactly where
/// particles are free, and under forces by the derivative of the scheme's steps. Throws InputError
/// for adaptive schemes, where discs meet, and where particles enter later.
LyapunovResult run_lyapunov(const System&, const LyapunovOptions& = {});

}  // namespace carom
