// Escape statistics of an ensemble of independent trajectories.
#pragma once

#include "carom/analyses/escape/decay.hpp"
#include "carom/analyses/escape/survival.hpp"
#include "carom/lanes/lane_effort.hpp"
#include "carom/results/ensemble_result.hpp"
#include "carom/system/system.hpp"

namespace carom {

/// What an escape run adds up; of an interrupted one, whole blocks.
struct EscapeResult : EnsembleResult {
  SurvivalCounts counts;
  LaneEffort effort;  ///< of lanes, if any flew

  /// Adds another part of the same ensemble: counts, digest, decisions, times, reports. In any
  /// order the sum is the same. False, and no change, where a trajectory is in both.
  bool add(const EscapeResult& other);
};

using EscapeJournal = EnsembleJournal<EscapeResult>;
using EscapeOptions = EnsembleOptions<EscapeResult>;

/// Runs the ensemble, or the part that is asked for. Where a trajectory has several particles, each
/// of them is an entry of its own in every count; one that is injected counts from the time 0 on as
/// still there. Throws InputError where the initial condition is impossible, and whatever the
/// journal throws.
EscapeResult run_escape(const System&, const EscapeOptions& = {});

/// How the survival of a run of this system decays, in the window of System::run or as late as the
/// data allow.
DecayFit decay_of(const System&, const EscapeResult&);

}  // namespace carom
