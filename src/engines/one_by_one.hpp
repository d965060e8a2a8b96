// The engine that flies one trajectory after the other in a World: whatever particles do to each
// other.
#pragma once

#include <optional>
#include <vector>

#include "carom/engines/engine.hpp"
#include "carom/events/world.hpp"
#include "engines/followed_deviations.hpp"

namespace carom::engines {

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
  void contact(const ContactEvent&) override;
  void stepped(int particle, Time, bool part) override;
  void sample(int particle, Time, const State&) override;
  bool sampled(Time) override {
    ++samples_;
    return true;
  }
  void crossing(int particle, Time, const State&, int direction) override;
  void end(const EndEvent&) override;
  /// The lengths of deviations at times before `time`, or also at it.
  void stretch(std::size_t particle, const Time& time, bool also_at);
  void carry_over_hit(std::size_t particle, const State&);

  /// What the listener has heard of a particle or a group.
  struct Heard {
    std::size_t marks = 0;  ///< times that were reported
    std::uint64_t hits = 0;
  };
  const System& system_;
  const EngineOptions options_;
  World world_;
  Listener* listener_ = nullptr;
  Trajectory trajectory_;
  TrajectoryEnd end_;
  std::size_t samples_ = 0;  ///< times of this trajectory that are sampled
  std::optional<FollowedDeviations> deviations_;
  std::vector<Heard> heard_;
  const std::function<bool()>* stopped_ = nullptr;
};

}  // namespace carom::engines
