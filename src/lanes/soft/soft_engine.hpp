// What a pack of particles under forces needs besides its kernel: the numbers of a step, the cell
// of a lattice, the walls around, and the scalar engine's own means for the steps that lanes leave
// to it.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "carom/events/decisions.hpp"
#include "carom/events/dynamics.hpp"
#include "carom/events/event.hpp"
#include "carom/events/step_counts.hpp"
#include "carom/lanes/instruction_set.hpp"
#include "events/flight/locator.hpp"
#include "events/flight/next_hit.hpp"
#include "events/step/group.hpp"
#include "forces/resolution.hpp"
#include "integrators/stages.hpp"
#include "lanes/soft/soft_pack.hpp"

namespace carom::lanes {

/// What acts there that steps in lanes do not know, as a phrase; "" where they know all.
std::string unknown_to_steps(const Table&, const Dynamics&);

/// What a trajectory under way needs besides its phase in the pack.
struct SoftTrack {
  State state;  ///< after its last event in the scalar engine; in lanes its cell, and u, are kept
  std::uint64_t hits = 0;
  int last_wall = -1;
  int hole = -1;
  Fate fate = Fate::survived;
  Time ended;
  bool finished = false;
  std::string report;
  StepCounts counts;     ///< as a World would count them
  double fastest = 0.0;  ///< the largest v^2 where a step began
  bool arc_known =
      false;  ///< the search for walls has evaluated the force where the next step begins
};

class SoftEngine {
 public:
  SoftEngine(const Table& table, const Dynamics& dynamics, InstructionSet set,
             DecisionOptions options);
  SoftEngine(const SoftEngine&) = delete;
  SoftEngine& operator=(const SoftEngine&) = delete;

  void set_kind(const Particle&);
  void limit_hits(std::uint64_t hits) { limit_ = hits; }
  /// Called with each hit; false: the track ends there, as one that survives.
  void report_hits(std::function<bool(const SoftTrack&)> hit) { reported_hit_ = std::move(hit); }
  double step() const { return step_; }

  /// Puts a state into a lane, and its cell right; accelerations are not set.
  void put(State& state, SoftPack& pack, int lane) const;
  /// A step of that length.
  void take_step(double duration, SoftPack& pack);
  /// Fills in which lanes call after a step of that length.
  void find_calls(double duration, SoftPack& pack);
  /// Accelerations of these lanes, if the pack's are fresh.
  void refresh(SoftPack& pack, std::span<const int> which);
  /// Copies what a step needs from a lane of one pack to that of another.
  static void copy(const SoftPack& from, int lane, SoftPack& to, int there);
  /// Takes over the lane's phase after its step, or at the start of it; the cell stays.
  static void read(const SoftPack& pack, int lane, const Time& time, State& state);
  static void read_start(const SoftPack& pack, int lane, const Time& time, State& state);

  enum class Outcome {
    at_step_end,
    on_a_wall,  ///< where the step's end found it: lanes cannot begin there
    over,       ///< what comes next comes after t_end
    ended,
  };
  using Sample = std::function<void(std::size_t, const State&)>;
  /// The track's events until its step ends, or until `t_end` if that comes first, by the scalar
  /// engine. `sample` receives the states at these times, none of them later than either.
  /// `from_lane`: a lane has evaluated the force at its start.
  Outcome follow(SoftTrack& track, bool from_lane, double t_end, std::span<const double> times = {},
                 const Sample& sample = {});

  // What lanes do for a track, counted as a World would.
  /// It has left its lane after this many steps there, the last of which was tried only if `tried`.
  void count_lane(SoftTrack& track, std::uint64_t steps, bool tried, double fastest) const;
  void count_sample(SoftTrack& track) const { track.counts.force_evaluations += sample_cost_; }
  /// The force at the start of its next step was evaluated anew: a lane has begun, or its particle
  /// was put back into the cell.
  void count_start(SoftTrack& track) const { track.counts.force_evaluations += keeps_forces_; }
  double kinetic_energy(const SoftTrack& track) const {
    return 0.5 * particle_.mass * track.fastest;
  }
  const DecisionCounts& decisions() const { return counts_; }

 private:
  static void add_other(const SoftForces&, int potential, SoftPack&);
  Outcome end_step(SoftTrack& track);
  bool hit(SoftTrack& track, const events::Barrier<double>& barrier);
  bool inside(geometry::Vector x);
  Outcome end(SoftTrack& track, Fate fate, std::string_view fault) const;

  const Table& table_;
  const ForceField& field_;
  double step_;
  std::vector<integrators::Stage<double>> stages_;
  bool keeps_forces_;  ///< the force at a step's end is that at the start of the next
  std::uint64_t step_cost_, sample_cost_;  ///< evaluations of a step in a lane, and of a part of it
  events::Group::Surroundings surroundings_;
  SoftKernel kernel_;
  forces::resolution::Span span_;    ///< of the latest step, about each of its ends
  forces::ForceMap* map_ = nullptr;  ///< of the kind that is flown
  SoftForces forces_;
  Particle particle_;
  std::vector<SoftStage> made_;  ///< the stages of the latest step
  double made_for_ = 0.0, made_with_ = 0.0;

  // Of the scalar engine.
  events::PieceTable walls_;
  events::Group group_;
  std::unique_ptr<events::Locator> locator_;
  std::uint64_t limit_ = std::numeric_limits<std::uint64_t>::max();
  std::function<bool(const SoftTrack&)> reported_hit_;
  DecisionCounts counts_;
  StepCounts steps_;  ///< of the scalar engine, since it was last asked
};

}  // namespace carom::lanes
