// Many independent trajectories of particles under external forces at once, each until it ends.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "carom/events/dynamics.hpp"
#include "carom/lanes/lane_world.hpp"

namespace carom {

/// Runs particles under forces, each by itself, as LaneWorld does free ones: the same orbits as World, bit for bit.
/// A lane takes whole steps that meet no wall; all other steps are a World's.
class SoftWorld {
 public:
  /// Can such particles be stepped so? Where forces act everywhere, and nothing but forces, a magnetic field and
  /// walls: no interaction, a fixed step, walls = "reflect". The particles are accelerated alike.
  static bool suits(const Table& table, const Dynamics& dynamics, const std::vector<Particle>& particles) {
    return hindrance(table, dynamics, particles).empty();
  }
  /// What keeps them out of lanes, as a phrase; "" where nothing does.
  static std::string hindrance(const Table&, const Dynamics&, const std::vector<Particle>&);

  /// Keeps references to table and dynamics, which must live as long.
  SoftWorld(const Table&, const Dynamics&, const Particle&, InstructionSet, DecisionOptions = {});
  SoftWorld(Table&&, const Dynamics&, const Particle&, InstructionSet, DecisionOptions = {}) = delete;
  ~SoftWorld();

  void limit_hits(std::uint64_t hits);
  /// As LaneWorld::run_until. Trajectories begin at time 0.
  void run_until(double t_end, const std::function<bool(LaneStart&)>& next,
                 const std::function<void(const LaneEnd&)>& ended, const std::function<bool()>& interrupted = {});

  DecisionCounts decisions() const;
  /// Steps count as hits do.
  const LaneEffort& effort() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace carom
