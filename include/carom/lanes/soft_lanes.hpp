// Lanes of particles under external forces, which go from step to step.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "carom/events/dynamics.hpp"
#include "carom/lanes/lanes.hpp"
#include "carom/table/table.hpp"

namespace carom {

/// A lane takes whole steps that meet no wall; all other steps are a World's.
class SoftLanes : public Lanes {
 public:
  /// What keeps such particles out of lanes, as a phrase; "" where nothing does: forces act
  /// everywhere, and only forces, a magnetic field and walls: no interaction, a fixed step,
  /// walls = "reflect". The particles are accelerated alike.
  static std::string hindrance(const Table&, const Dynamics&, const std::vector<Particle>&);

  /// `particle` is of the kind that all starts are. Keeps references to table and dynamics, which
  /// must live as long.
  SoftLanes(const Table&, const Dynamics&, const Particle&, InstructionSet, DecisionOptions = {});
  SoftLanes(Table&&, const Dynamics&, const Particle&, InstructionSet,
            DecisionOptions = {}) = delete;
  ~SoftLanes() override;

  void limit_hits(std::uint64_t hits) override;
  void sample_at(std::vector<double> times, Sampled sampled) override;
  void report_hits(Hit) override;
  /// Trajectories begin at time 0.
  void run_until(double t_end, const std::function<bool(LaneStart&)>& next,
                 const std::function<void(const LaneEnd&)>& ended,
                 const std::function<bool()>& interrupted = {}) override;
  DecisionCounts decisions() const override;
  /// Steps count as hits do.
  const LaneEffort& effort() const override;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace carom
