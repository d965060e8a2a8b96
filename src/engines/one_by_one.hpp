// The engine that flies one trajectory after the other in a World: whatever particles do to each
// other.
#pragma once

#include "carom/engines/engine.hpp"
#include "carom/events/world.hpp"
#include "engines/group_tangent.hpp"
#include "motion/free_tangent.hpp"

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
  void make_groups();
  void begin_deviations();
  /// The lengths of deviations at times before `time`, or also at it.
  void stretch(std::size_t particle, const Time& time, bool also_at);
  void carry_over_hit(std::size_t particle, const State&);
  void put_back(GroupTangent&, const Time&);

  /// Deviations of a particle: across its orbit where it is free and alone; else those of its
  /// group, which are reported with the group's first member.
  struct Followed {
    motion::FreeTangent tangent;
    GroupTangent* group = nullptr;
    std::size_t marked = 0;  ///< times that were reported
    std::uint64_t hits = 0;
  };
  const System& system_;
  const EngineOptions options_;
  World world_;
  Listener* listener_ = nullptr;
  Trajectory trajectory_;
  TrajectoryEnd end_;
  std::size_t samples_ = 0;  ///< times of this trajectory that are sampled
  motion::TangentWalls walls_;
  std::vector<std::unique_ptr<GroupTangent>> groups_;
  std::vector<Followed> followed_;  ///< one a particle, if deviations are followed
  const std::function<bool()>* stopped_ = nullptr;
  bool in_parts_ = false;  ///< a step of this trajectory was halved: deviations take its steps
};

}  // namespace carom::engines
