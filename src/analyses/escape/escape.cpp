// Adds up the ends of trajectories, block by block.
#include "carom/analyses/escape.hpp"

#include <algorithm>
#include <cstdint>
#include <list>
#include <utility>
#include <vector>

#include "carom/engines/engine.hpp"
#include "carom/table/hole_names.hpp"
#include "engines/energy_watch.hpp"
#include "engines/ensemble_run.hpp"
#include "engines/record_of.hpp"

namespace carom {

namespace {

/// One thread's. Lanes go from block to block without a pause, so several are under way at once.
class EscapeListener : public engines::EnsembleListener<EscapeResult> {
 public:
  /// `none`: the counts of no trajectory.
  EscapeListener(const System& system, const Engine& engine, Thread& thread,
                 const SurvivalCounts& none)
      : EnsembleListener(system, engine, thread),
        record_of_(system),
        wants_records_(thread.wants_records()),
        none_(none),
        watch_(system, [this] { return thread_.stopped(); }) {}

  void claimed(TrajectoryRange block) override {
    blocks_.push_back({block, block.last - block.first, {}, {}});
    blocks_.back().part.counts = none_;
  }

  void begin(const Trajectory& t) override {
    if (under_way_.size() <= t.slot) {
      under_way_.resize(t.slot + 1);
      if (watch_.watches()) energies_.resize(t.slot + 1, watch_);
    }
    under_way_[t.slot] = std::prev(blocks_.end());
    if (watch_.watches()) energies_[t.slot].begin(t);
  }

  void end(const Trajectory& t, const TrajectoryEnd& end) override {
    Block& block = *under_way_[t.slot];
    EscapeResult& sum = block.part;
    if (watch_.watches()) {
      const engines::EnergiesSeen energies = energies_[t.slot].end(t, end);
      sum.counts.energy_change = larger(sum.counts.energy_change, energies.change);
      sum.energy_error += energies.error;
    }
    if (hash_.of_states()) add_steps(sum, sum.counts.contacts, end);
    std::uint64_t hits = 0;
    for (std::size_t p = 0; p < end.particles.size(); ++p) {
      const ParticleEnd& particle = end.particles[p];
      const std::uint64_t index = index_of(t, p);
      const int hole = record_of_.hole_of(particle);
      sum.counts.add(particle.fate, particle.time, particle.hits, hole, t.number);
      add_end(sum, index, particle.fate, particle.report,
              hash_(index, particle.fate, particle.time, particle.hits, particle.last_wall,
                    particle.state));
      if (wants_records_) block.records.push_back(record_of_(index, t.starts[p], particle));
      hits += particle.hits;
    }
    thread_.report(1, hits);
    if (--block.left > 0) return;
    deliver(block);
    blocks_.erase(under_way_[t.slot]);
  }

 private:
  struct Block {
    TrajectoryRange range;
    std::uint64_t left = 0;  ///< trajectories that have not ended
    EscapeResult part;
    std::vector<TrajectoryRecord> records;
  };
  void deliver(Block& block) {
    std::sort(block.records.begin(), block.records.end(),
              [](const auto& a, const auto& b) { return a.index < b.index; });
    const LaneEffort effort = engine_.effort();
    block.part.effort = effort - std::exchange(effort_, effort);
    add_done(block.part, block.range);
    thread_.deliver(
        block.range, [&](EscapeResult& sum) { sum.add(block.part); }, std::move(block.records));
  }

  const engines::RecordMaker record_of_;
  const bool wants_records_;
  const SurvivalCounts& none_;
  std::list<Block> blocks_;
  std::vector<std::list<Block>::iterator> under_way_;  ///< by slot of a trajectory
  const engines::EnergyWatch watch_;                   ///< of a trajectory that has not begun
  std::vector<engines::EnergyWatch> energies_;         ///< by slot, if they are watched
  LaneEffort effort_;
};

}  // namespace

bool EscapeResult::add(const EscapeResult& other) {
  if (!add_common(other)) return false;
  counts.merge(other.counts);
  effort += other.effort;
  return true;
}

EscapeResult run_escape(const System& system, const EscapeOptions& options) {
  EscapeResult nothing;
  nothing.counts =
      SurvivalCounts(system.run.times, hole_names(*system.table).size(), system.quasi_random());
  EngineOptions engine_options{.t_end = system.run.t_max};
  engine_options.states = (options.journal && options.journal->wants_records()) ||
                          engines::ParticleHash(system).of_states();
  return engines::fly_blocks<EscapeResult>(
      system, system, options, nothing, engine_options,
      [&](const Engine& engine, EscapeListener::Thread& thread) {
        return EscapeListener(system, engine, thread, nothing.counts);
      });
}

}  // namespace carom
