// Blocks of an escape ensemble in lanes. A lane that is free takes the next trajectory, if need be of the next
// block: so several blocks are under way at once.
#pragma once

#include <functional>
#include <map>
#include <vector>

#include "carom/ensemble/sampler.hpp"
#include "ensemble/either_lanes.hpp"
#include "ensemble/energy_watch.hpp"
#include "ensemble/escape_tally.hpp"

namespace carom {

/// One thread's lanes.
class LaneRunner {
 public:
  struct Block {
    std::uint64_t first = 0, end = 0;  ///< trajectories
  };
  struct Done {
    Block block;
    EscapeTally tally;
    std::vector<TrajectoryRecord> records;  ///< by index, if asked for
  };

  LaneRunner(const System& system, const Sampler& sampler, InstructionSet set, DecisionOptions decisions)
      : system_(system), sampler_(sampler), world_(*system.table, decisions), lanes_(system, set, decisions), energies_(system) {
    if (system.run.collisions > 0) lanes_.limit_hits(system.run.collisions);
  }

  /// Runs the blocks that `next` gives until it gives no more; `done` receives each one that is complete.
  /// `ended` is told of every trajectory's end with its hits.
  void run(const std::function<bool(Block&)>& next, const std::function<void(Done&&)>& done, bool records,
           const std::function<void(std::uint64_t)>& ended, const std::function<bool()>& interrupted) {
    records_ = records;
    const auto source = [&](LaneStart& start) {
      while (particle_ == states_.size()) {
        if (trajectory_ == block_.end) {
          if (!next(block_)) return false;
          trajectory_ = block_.first;
          open(block_);
        }
        states_ = sampler_.draw_all(world_, trajectory_++);
        particle_ = 0;
      }
      start.particle = system_.particles[particle_];
      start.state = states_[particle_];
      start.hits = 0;
      start.tag = (trajectory_ - 1) * system_.particles.size() + particle_;
      ++particle_;
      if (records_) note_start(start);
      if (energies_.of_each()) energy_of(start.tag) = energies_.energy(start.particle, start.state).total();
      return true;
    };
    const auto sink = [&](const LaneEnd& end) {
      note_end(end);
      ended(end.hits);
      const auto at = block_of(end.tag);
      if (--at->second.left > 0) return;
      done(std::move(at->second.done));
      open_.erase(at);
    };
    lanes_.run_until(system_.run.t_max, source, sink, interrupted);
  }

  DecisionCounts decisions() const { return lanes_.decisions(); }
  const LaneEffort& effort() const { return lanes_.effort(); }

 private:
  struct Open {
    std::uint64_t first = 0, left = 0;  ///< index of its first particle, and particles that have not ended
    Done done;
    std::vector<double> energies;  ///< at the start, under forces
  };
  using Blocks = std::map<std::uint64_t, Open>;  // by the index of their first particle

  void open(const Block& block) {
    const std::uint64_t each = system_.particles.size();
    Open b{block.first * each, (block.end - block.first) * each, {block, EscapeTally(system_), {}}, {}};
    if (energies_.of_each()) b.energies.resize(b.left);
    if (records_) b.done.records.resize(b.left);
    open_.emplace(b.first, std::move(b));
  }
  Blocks::iterator block_of(std::uint64_t index) { return std::prev(open_.upper_bound(index)); }
  TrajectoryRecord& record_of(std::uint64_t index) {
    Open& b = block_of(index)->second;
    return b.done.records[index - b.first];
  }
  double& energy_of(std::uint64_t index) {
    Open& b = block_of(index)->second;
    return b.energies[index - b.first];
  }

  void note_start(const LaneStart& start) {
    TrajectoryRecord& record = record_of(start.tag);
    record = start_of(*system_.table, start.state);
    record.index = start.tag;
  }
  void note_end(const LaneEnd& end) {
    TrajectoryRecord record;
    if (records_) record = record_of(end.tag);
    record.index = end.tag;
    record.fate = end.fate;
    if (end.hole >= 0) record.hole = holes_[static_cast<std::size_t>(end.hole)];
    record.hits = end.hits;
    const bool to_the_end = end.fate == Fate::survived || end.fate == Fate::pinned;
    record.time = to_the_end ? system_.run.t_max : end.time.value();
    EscapeTally& tally = block_of(end.tag)->second.done.tally;
    tally.add(record, end.last_wall, end.state, end.report);
    tally.steps += end.steps;
    if (energies_.of_each() && !is_failure(end.fate)) {
      const Particle& particle = system_.particles[end.tag % system_.particles.size()];
      tally.energies.add(energy_of(end.tag), energies_.energy(particle, end.state), 0.0, end.kinetic);
    }
    if (records_) record_of(end.tag) = record;
  }

  const System& system_;
  const Sampler& sampler_;
  const std::vector<int> holes_ = hole_numbers(*system_.table);
  World world_;  ///< answers the sampler
  EitherLanes lanes_;
  EnergyWatch energies_;
  Blocks open_;
  Block block_;
  std::uint64_t trajectory_ = 0;
  std::vector<State> states_;
  std::size_t particle_ = 0;
  bool records_ = false;
};

}  // namespace carom
