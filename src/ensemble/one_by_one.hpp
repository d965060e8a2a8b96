// The engine that flies one trajectory after the other in a World: whatever particles do to each
// other.
#pragma once

#include "carom/ensemble/engine.hpp"
#include "carom/events/world.hpp"

namespace carom::ensemble {

class OneByOne : public Engine, private Observer {
 public:
  OneByOne(const System&, const EngineOptions&, World);
  OneByOne(const OneByOne&) = delete;
  OneByOne& operator=(const OneByOne&) = delete;

  bool run(Starts&, Listener&, const std::function<bool()>& stopped) override;
  DecisionCounts decisions() const override { return world_.decisions(); }

 private:
  void add_particles();
  void hit(const HitEvent&) override;
  void contact(const ContactEvent&) override { ++end_.contacts; }
  void sample(int particle, Time, const State&) override;
  bool sampled(Time) override {
    ++samples_;
    return true;
  }
  void crossing(int particle, Time, const State&, int direction) override;
  void end(const EndEvent&) override;

  const System& system_;
  const EngineOptions options_;
  World world_;
  Listener* listener_ = nullptr;
  Trajectory trajectory_;
  TrajectoryEnd end_;
  std::size_t samples_ = 0;  ///< times of this trajectory that are sampled
};

}  // namespace carom::ensemble
