// Adds up the ends of trajectories, block by block.
#pragma once

#include <cstdint>
#include <list>
#include <utility>
#include <vector>

#include "carom/analyses/escape.hpp"
#include "carom/engines/engine.hpp"
#include "carom/table/hole_names.hpp"
#include "engines/energy_watch.hpp"
#include "engines/ensemble_listener.hpp"
#include "engines/ordered_output.hpp"
#include "engines/record_of.hpp"

namespace carom::analyses {

/// One thread's. Lanes go from block to block without a pause, so several are under way at once;
/// where records are wanted in order, one block after the other: a thread that waits for its turn
/// must not keep others waiting.
class EscapeListener : public engines::EnsembleListener<EscapeResult> {
 public:
  using Output = engines::OrderedOutput<TrajectoryRecord>;

  EscapeListener(const System& system, const Engine& engine, Thread& thread, Output& output)
      : EnsembleListener(system, engine, thread),
        writer_(output),
        wants_records_(writer_.is_wanted() || thread.wants_records()),
        record_of_(system),
        none_(system.run.times, hole_names(*system.table).size(), system.quasi_random()),
        watch_(system, [this] { return thread_.stopped(); }) {}

  /// The next block, as DrawnStarts asks for it.
  bool claim(TrajectoryRange& block) {
    if (pause_ || thread_.stopped()) return false;
    std::uint64_t number = 0;
    if (exhausted_ = !thread_.claim(block, number); exhausted_) return false;
    writer_.await_turn(number);
    pause_ = writer_.is_wanted();
    blocks_.push_back({block, number, block.last - block.first, {}, {}});
    blocks_.back().part.counts = none_;
    return true;
  }
  /// After a pause; false if there are no blocks left.
  bool go_on() {
    pause_ = false;
    return !exhausted_ && !thread_.stopped();
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
    engines::EnergiesSeen energies;
    if (watch_.watches()) energies = energies_[t.slot].end(t, end);
    sum.counts.energy_change = larger(sum.counts.energy_change, energies.change);
    add_end(sum, sum.counts.contacts, end, energies.error);
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
    std::uint64_t number = 0, left = 0;  ///< trajectories that have not ended
    EscapeResult part;
    std::vector<TrajectoryRecord> records;
  };
  void deliver(Block& block) {
    std::sort(block.records.begin(), block.records.end(),
              [](const auto& a, const auto& b) { return a.index < b.index; });
    if (writer_.is_wanted() && !writer_.deliver(block.number, block.records)) return;
    const LaneEffort effort = engine_.effort();
    block.part.effort = effort - std::exchange(effort_, effort);
    add_done(block.part, block.range);
    thread_.deliver(
        block.range, [&](EscapeResult& sum) { sum.add(block.part); }, std::move(block.records));
  }

  Output::Writer writer_;
  const bool wants_records_;
  const engines::RecordMaker record_of_;
  const SurvivalCounts none_;  ///< of no trajectory yet
  std::list<Block> blocks_;
  std::vector<std::list<Block>::iterator> under_way_;  ///< by slot of a trajectory
  const engines::EnergyWatch watch_;                   ///< of a trajectory that has not begun
  std::vector<engines::EnergyWatch> energies_;         ///< by slot, if they are watched
  bool pause_ = false, exhausted_ = false;
  LaneEffort effort_;
};

}  // namespace carom::analyses
