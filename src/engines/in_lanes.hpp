// The engine that flies many trajectories at once in lanes.
#pragma once

#include <memory>
#include <vector>

#include "carom/engines/engine.hpp"
#include "carom/events/world.hpp"
#include "carom/lanes/lanes.hpp"

namespace carom::engines {

/// Puts the particles of trajectories into lanes, and the ends of particles together to ends of
/// trajectories.
class InLanes : public Engine {
 public:
  /// `like`: a world of the system.
  InLanes(const System&, const EngineOptions&, const World& like, std::unique_ptr<Lanes>);
  InLanes(const InLanes&) = delete;
  InLanes& operator=(const InLanes&) = delete;

  bool run(Starts&, Listener&, const std::function<bool()>& stopped) override;
  DecisionCounts decisions() const override { return lanes_->decisions(); }
  LaneEffort effort() const override { return lanes_->effort(); }

 private:
  /// A trajectory under way. Its place is used again, so there are as many as lanes hold.
  struct Flight {
    Trajectory trajectory;
    TrajectoryEnd end;     ///< so far, of several particles
    std::size_t left = 0;  ///< particles that have not ended
  };
  std::size_t each() const { return system_.particles.size(); }
  bool begin(Starts&);
  void note(const LaneEnd&);
  // A tag tells the slot and the particle.
  static std::uint64_t tag_of(std::size_t slot, std::size_t particle) {
    return std::uint64_t{slot} << 32 | particle;
  }
  static std::size_t particle_of(std::uint64_t tag) { return tag & 0xffffffff; }
  Flight& flight(std::uint64_t tag) { return *flights_[tag >> 32]; }

  const System& system_;
  const EngineOptions options_;
  World world_;  ///< answers what starts are asked for
  std::unique_ptr<Lanes> lanes_;
  Listener* listener_ = nullptr;
  std::vector<std::unique_ptr<Flight>> flights_;  ///< by slot
  TrajectoryEnd end_of_one_;  ///< of the latest trajectory of one particle: always at hand
  std::vector<std::size_t> free_;
  std::size_t latest_ = 0,
              begun_ = 0;  ///< the latest flight, and how many of its particles are in lanes
};

}  // namespace carom::engines
