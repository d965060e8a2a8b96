// Many independent trajectories at once, in the lanes of SIMD registers: what free lanes and lanes
// under forces have in common.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "carom/events/decisions.hpp"
#include "carom/events/event.hpp"
#include "carom/events/step_counts.hpp"
#include "carom/lanes/instruction_set.hpp"
#include "carom/lanes/lane_effort.hpp"
#include "carom/motion/state.hpp"

namespace carom {

/// A trajectory of one particle that is to be followed.
struct LaneStart {
  std::uint64_t tag = 0;  ///< the caller's own
  Particle particle;
  State state;  ///< as for World::add
  std::uint64_t hits = 0;
};

/// Its end.
struct LaneEnd {
  std::uint64_t tag = 0;
  Fate fate = Fate::survived;
  Time time;    ///< of the end; survivors: that of their last event
  State state;  ///< after the last event
  int hole = -1;
  std::uint64_t hits = 0;
  int last_wall = -1;     ///< as World::last_wall
  std::string report;     ///< as World::report
  StepCounts steps = {};  ///< under forces: as World::step_counts
  double kinetic = 0.0;   ///< under forces: the largest kinetic energy where a step began
};

/// Runs particles that do not feel each other: the same orbits as World, bit for bit. A lane
/// decides only what is certain in double precision; everything else is decided by a World.
class Lanes {
 public:
  virtual ~Lanes() = default;

  /// Most hits a particle may make (default: no limit).
  virtual void limit_hits(std::uint64_t hits) = 0;
  /// A trajectory's state (not its wall) at the time of that number.
  using Sampled = std::function<void(std::uint64_t tag, std::size_t number, const State&)>;
  /// Increasing times; `sampled` receives what World's observer would, in order and
  /// before the end of the trajectory.
  virtual void sample_at(std::vector<double> times, Sampled sampled) = 0;
  /// A trajectory's state after a hit, and the hits that it has made by then. False: it ends there,
  /// as one that survives.
  using Hit = std::function<bool(std::uint64_t tag, const State&, std::uint64_t hits)>;
  virtual void report_hits(Hit) = 0;
  /// Increasing times; `stretched` receives, per trajectory and time, the logarithms of the lengths
  /// of two deviations across it and the hits by then (motion/free_tangent.hpp). No call after the
  /// last hit of a trajectory that escapes.
  using Stretched = std::function<void(std::uint64_t tag, std::size_t number,
                                       std::span<const double> logarithms, std::uint64_t hits)>;
  /// Free lanes alone can: others throw std::invalid_argument.
  virtual void follow_deviations(std::vector<double> /*times*/, double /*unit_length*/, Stretched) {
    throw std::invalid_argument("these lanes follow no deviations");
  }
  /// Follows all trajectories that `next` gives (until it returns false) to their end or until
  /// `t_end`; `ended` receives each, in no particular order. `interrupted`, if set, is asked now
  /// and then; true returns early, and those under way are forgotten.
  virtual void run_until(double t_end, const std::function<bool(LaneStart&)>& next,
                         const std::function<void(const LaneEnd&)>& ended,
                         const std::function<bool()>& interrupted = {}) = 0;

  /// From now on ends need no states.
  virtual void omit_end_states() {}

  virtual DecisionCounts decisions() const = 0;
  virtual const LaneEffort& effort() const = 0;
};

}  // namespace carom
