// What every ensemble adds up, whatever else its analysis does.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include "carom/engines/engine.hpp"
#include "carom/starts/injection.hpp"
#include "engines/ensemble_run.hpp"
#include "engines/first_reports.hpp"
#include "engines/particle_hash.hpp"

namespace carom::engines {

/// One thread's.
template <class Result>
class EnsembleListener : public Listener {
 public:
  using Thread = typename EnsembleRun<Result>::Thread;

 protected:
  EnsembleListener(const System& system, const Engine& engine, Thread& thread)
      : system_(system), engine_(engine), thread_(thread), hash_(system) {}

  /// The number of a particle, as records, reports and the digest have it.
  std::uint64_t index_of(const Trajectory& t, std::size_t particle) const {
    return particle_index(system_, t.number, particle);
  }
  /// A particle's end: `hash` goes into the digest.
  static void add_end(EnsembleResult& sum, std::uint64_t index, Fate fate,
                      const std::string& report, std::uint64_t hash) {
    sum.digest += hash;
    if (is_failure(fate)) keep_first(sum.reports, index, report);
  }
  /// A trajectory's.
  static void add_end(EnsembleResult& sum, std::uint64_t& contacts, const TrajectoryEnd& end,
                      const EnergyError& error) {
    contacts += end.contacts;
    sum.steps += end.steps;
    sum.energy_error += error;
  }
  /// Trajectories that are counted, with the decisions since the last ones.
  void add_done(EnsembleResult& sum, TrajectoryRange range) {
    const DecisionCounts decisions = engine_.decisions();
    sum.decisions += decisions - std::exchange(decisions_, decisions);
    sum.done.add(range);
  }

  const System& system_;
  const Engine& engine_;
  Thread& thread_;
  const ParticleHash hash_;

 private:
  DecisionCounts decisions_;  ///< that were added
};

}  // namespace carom::engines
