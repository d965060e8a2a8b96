// The lanes that an ensemble's particles fly in: free ones from hit to hit, those under forces step by step.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "carom/ensemble/system.hpp"
#include "carom/lanes/lane_world.hpp"
#include "carom/lanes/soft_world.hpp"

namespace carom {

/// Either of two engines with the same calls.
class EitherLanes {
 public:
  /// Of free particles, all of them from the start on, or of particles that feel forces everywhere; none interact.
  static bool suits(const System& system) { return suits_free(system) || suits_soft(system); }
  /// The first of these.
  static bool suits_free(const System& system) {
    const Dynamics& d = system.dynamics;
    return are_apart(system) && !d.everywhere && (!d.forces || d.forces->empty()) &&
           LaneWorld::suits(*system.table, system.particles);
  }

  EitherLanes(const System& system, InstructionSet set, DecisionOptions options) {
    if (suits_free(system))
      free_ = std::make_unique<LaneWorld>(*system.table, system.particles, set, options);
    else
      soft_ = std::make_unique<SoftWorld>(*system.table, system.dynamics, system.particles.at(0), set, options);
  }

  void limit_hits(std::uint64_t hits) { free_ ? free_->limit_hits(hits) : soft_->limit_hits(hits); }
  void run_until(double t_end, const std::function<bool(LaneStart&)>& next,
                 const std::function<void(const LaneEnd&)>& ended, const std::function<bool()>& interrupted) {
    free_ ? free_->run_until(t_end, next, ended, interrupted) : soft_->run_until(t_end, next, ended, interrupted);
  }
  DecisionCounts decisions() const { return free_ ? free_->decisions() : soft_->decisions(); }
  const LaneEffort& effort() const { return free_ ? free_->effort() : soft_->effort(); }

 private:
  static bool suits_soft(const System& system) {
    return are_apart(system) && SoftWorld::suits(*system.table, system.dynamics, system.particles);
  }
  static bool are_apart(const System& system) { return system.injections.empty() && !system.of_discs(); }

  std::unique_ptr<LaneWorld> free_;
  std::unique_ptr<SoftWorld> soft_;
};

}  // namespace carom
