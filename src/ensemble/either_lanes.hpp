// The lanes that an ensemble's particles fly in: free ones from hit to hit, those under forces step by step.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "carom/ensemble/system.hpp"
#include "carom/lanes/lane_world.hpp"
#include "carom/lanes/soft_world.hpp"

namespace carom {

/// Either of two engines with the same calls.
class EitherLanes {
 public:
  /// What keeps an ensemble out of both, as a phrase; "" where nothing does. They fly free particles, all of them from the start
  /// on, and particles that feel forces everywhere; none interact.
  static std::string hindrance(const System& system) {
    if (!system.injections.empty()) return "particles enter later ([[injection]])";
    if (is_free(system)) return LaneWorld::hindrance(*system.table, system.particles);
    return SoftWorld::hindrance(*system.table, system.dynamics, system.particles);
  }
  /// Where nothing acts the first of these flies, else the second.
  static bool is_free(const System& system) {
    const Dynamics& d = system.dynamics;
    return !d.everywhere && (!d.forces || d.forces->empty()) && !system.of_discs();
  }

  EitherLanes(const System& system, InstructionSet set, DecisionOptions options) {
    if (is_free(system))
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
  std::unique_ptr<LaneWorld> free_;
  std::unique_ptr<SoftWorld> soft_;
};

}  // namespace carom
