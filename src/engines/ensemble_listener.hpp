// What every ensemble adds up, whatever else its analysis does.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>

#include "carom/engines/engine.hpp"
#include "carom/engines/trajectories.hpp"
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
  /// The trajectories that come next.
  virtual void claimed(TrajectoryRange) {}

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

/// Flies an ensemble whose trajectories are drawn block by block: on each thread an engine, and the
/// listener that `listen(engine, thread)` makes. `starts`: the system that they are drawn from.
template <class Result, class Listen>
Result fly_blocks(const System& system, const System& starts,
                  const EnsembleOptions<Result>& options, Result nothing, EngineOptions how,
                  Listen listen) {
  check_start(starts, options.interrupted);
  const Sampler sampler(starts, options.interrupted);
  const World world = make_world(system, options.decisions);  // threads share its table
  how.lanes = options.lanes;
  how.like = &world;
  EnsembleRun<Result> run(system, options, std::move(nothing));
  if (why_one_by_one(system, how).empty()) run.lanes = options.lanes;
  return run.run([&](typename EnsembleRun<Result>::Thread& thread) {
    const auto engine = make_engine(system, how);
    auto listener = listen(*engine, thread);
    const std::function<bool()> stopped = [&] { return thread.stopped(); };
    DrawnStarts drawn(sampler, [&](TrajectoryRange& block) {
      if (stopped() || !thread.claim(block)) return false;
      listener.claimed(block);
      return true;
    });
    engine->run(drawn, listener, stopped);
  });
}

}  // namespace carom::engines
