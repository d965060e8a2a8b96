// Many independent trajectories of free particles at once, in the lanes of SIMD registers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "carom/events/world.hpp"
#include "carom/lanes/instruction_set.hpp"
#include "carom/lanes/lane_effort.hpp"

namespace carom {

/// A trajectory of one free particle that is to be followed.
struct LaneStart {
  std::uint64_t tag = 0;     ///< the caller's own
  Particle particle;
  State state;               ///< as for World::add
  std::uint64_t hits = 0;
};

/// Its end.
struct LaneEnd {
  std::uint64_t tag = 0;
  Fate fate = Fate::survived;
  Time time;                 ///< of the end; survivors: that of their last event
  State state;               ///< after the last event
  int hole = -1;
  std::uint64_t hits = 0;
  int last_wall = -1;        ///< as World::last_wall
  std::string report;        ///< as World::report
  StepCounts steps = {};     ///< under forces: as World::step_counts
  double kinetic = 0.0;      ///< under forces: the largest kinetic energy where a step began
};

/// Runs free particles on one table, each by itself: the same orbits as World, bit for bit. A lane decides
/// only what is certain in double precision; everything else is decided by a World.
class LaneWorld {
 public:
  /// Can lanes fly such particles on that table? Straight flights, or Larmor circles that all turn the same way,
  /// between segments, circles and ellipses: at most 64 pieces. On a lattice among discs that
  /// lie inside the cell; Larmor circles there that come to at most 64 pieces.
  static bool suits(const Table& table, const std::vector<Particle>& particles) { return hindrance(table, particles).empty(); }
  /// What keeps them out of lanes, as a phrase ("more than 64 walls…"); "" where nothing does.
  static std::string hindrance(const Table&, const std::vector<Particle>&);

  /// `particles` suit, and every start is one of them. Keeps a reference to the table, which must live as long.
  LaneWorld(const Table& table, const std::vector<Particle>& particles, InstructionSet set, DecisionOptions options = {});
  LaneWorld(Table&&, const std::vector<Particle>&, InstructionSet, DecisionOptions = {}) = delete;
  ~LaneWorld();

  void limit_hits(std::uint64_t hits);
  /// A trajectory's state (not its wall) at the time of that number.
  using Sampled = std::function<void(std::uint64_t tag, std::size_t number, const State&)>;
  /// Increasing times; `sampled` is told of each trajectory what World's observer would be, in order and before its end.
  void sample_at(std::vector<double> times, Sampled sampled);
  /// Follows all trajectories that `next` gives (until it returns false) to their end or until `t_end`; `ended`
  /// receives each, in no particular order. `interrupted`, if set, is asked now and then; true
  /// returns early, and those under way are forgotten.
  void run_until(double t_end, const std::function<bool(LaneStart&)>& next, const std::function<void(const LaneEnd&)>& ended,
                 const std::function<bool()>& interrupted = {});

  DecisionCounts decisions() const;
  const LaneEffort& effort() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace carom
