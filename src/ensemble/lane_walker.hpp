// Trajectories of a diffusion run of free particles, in lanes from hit to hit.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "carom/lanes/lane_world.hpp"
#include "ensemble/diffusion_walker.hpp"
#include "ensemble/either_lanes.hpp"

namespace carom {

class LaneWalker {
 public:
  LaneWalker(const System& system, const Sampler& sampler, InstructionSet set, DecisionOptions decisions,
             DiffusionTally tally)
      : system_(system),
        sampler_(sampler),
        world_(*system.table, decisions),
        lanes_(*system.table, system.particles, set, decisions),
        tally_(tally) {
    if (system.run.collisions > 0) lanes_.limit_hits(system.run.collisions);
    lanes_.sample_at(system.run.times, [this](std::uint64_t tag, std::size_t, const State& state) {
      Member& p = member(tag);
      p.squares.push_back(square_of_displacement(system_, p.start, state));
    });
  }

  LaneWalker(const LaneWalker&) = delete;  // its lanes know where it is
  LaneWalker& operator=(const LaneWalker&) = delete;

  /// Runs the blocks that `next` gives, one after the other without a pause, until it gives none or the run is stopped.
  void run(const std::function<bool(TrajectoryRange&)>& next) {
    const auto source = [&](LaneStart& start) {
      if (members_begun_ == each()) {
        while (block_.first == block_.last)
          if (tally_.stopped() || !next(block_)) return false;
        begin(block_.first++);
      }
      start.tag = begun_ * each() + members_begun_;
      start.particle = system_.particles[members_begun_++];
      start.state = member(start.tag).start;
      start.hits = 0;
      return true;
    };
    lanes_.run_until(system_.run.times.back(), source, [this](const LaneEnd& end) { note(end); },
                     [this] { return tally_.stopped(); });
  }

 private:
  struct Member {
    State start;
    std::vector<double> squares;
  };
  /// A trajectory under way. Its place is used again, so there are as many as lanes hold.
  struct Open {
    std::uint64_t trajectory = 0;
    std::size_t left = 0;  ///< particles that have not ended
    std::vector<Member> members;
    std::vector<DiffusingParticle> ends;
  };

  std::size_t each() const { return system_.particles.size(); }
  Member& member(std::uint64_t tag) { return open_[tag / each()].members[tag % each()]; }

  void begin(std::uint64_t trajectory) {
    if (free_.empty()) {
      free_.push_back(open_.size());
      open_.push_back({0, 0, std::vector<Member>(each()), std::vector<DiffusingParticle>(each())});
    }
    begun_ = free_.back();
    free_.pop_back();
    members_begun_ = 0;
    Open& open = open_[begun_];
    open.trajectory = trajectory;
    open.left = each();
    const std::vector<State> starts = sampler_.draw_all(world_, trajectory);
    const bool on_walls = std::any_of(starts.begin(), starts.end(), [](const State& s) { return s.wall >= 0; });
    if (on_walls) {  // a world puts them there, and refuses what cannot be
      world_.clear();
      add_starts(world_, sampler_, trajectory);
    }
    for (std::size_t p = 0; p < each(); ++p) {
      open.members[p].start = on_walls ? world_.state(static_cast<int>(p)) : starts[p];
      open.members[p].squares.clear();
    }
  }

  void note(const LaneEnd& end) {
    Open& open = open_[end.tag / each()];
    const std::size_t p = end.tag % each();
    const bool to_the_end = end.fate == Fate::survived || end.fate == Fate::pinned;
    open.ends[p] = {open.trajectory * each() + p, end.fate, to_the_end ? system_.run.times.back() : end.time.value(),
                    end.hits, end.last_wall, end.state, &open.members[p].squares, is_failure(end.fate) ? end.report : ""};
    if (--open.left > 0) return;
    const DecisionCounts now = lanes_.decisions();
    tally_.add(open.trajectory, open.ends, {}, {}, now - std::exchange(decisions_, now));
    free_.push_back(end.tag / each());
  }

  const System& system_;
  const Sampler& sampler_;
  World world_;  ///< answers the sampler
  LaneWorld lanes_;
  DiffusionTally tally_;
  DecisionCounts decisions_;  ///< that were told
  TrajectoryRange block_;
  std::vector<Open> open_;
  std::vector<std::size_t> free_;
  std::size_t begun_ = 0;  ///< the last one that began
  std::size_t members_begun_ = system_.particles.size();  ///< of that
};

}  // namespace carom
