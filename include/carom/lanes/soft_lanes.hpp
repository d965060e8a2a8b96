// Many independent particles under external forces at once, in the lanes of SIMD registers.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "carom/events/decisions.hpp"
#include "carom/events/dynamics.hpp"
#include "carom/events/event.hpp"
#include "carom/events/step_counts.hpp"
#include "carom/lanes/instruction_set.hpp"
#include "carom/motion/state.hpp"
#include "carom/table/table.hpp"

namespace carom {

/// Steps of a splitting scheme with many particles, each by itself: the same orbits as World, bit for bit. A step
/// that may meet a wall is World's, as what happens to lanes is rare.
class SoftLanes {
 public:
  /// Can such particles be stepped so? Where forces act everywhere, and nothing but forces, a magnetic
  /// field and walls: no interaction, a fixed step, walls = "reflect".
  static bool suits(const Table& table, const Dynamics& dynamics) { return hindrance(table, dynamics).empty(); }
  /// What keeps them out of lanes, as a phrase; "" where nothing does.
  static std::string hindrance(const Table&, const Dynamics&);

  /// Keeps references to both, which must live as long.
  SoftLanes(const Table& table, const Dynamics& dynamics, InstructionSet set, DecisionOptions options = {});
  ~SoftLanes();
  SoftLanes(SoftLanes&&) noexcept;

  /// As World's.
  void limit_hits(std::uint64_t hits);

  /// A particle on its way.
  struct Walk {
    State state;         ///< at time 0; then after the last event before the end
    Fate fate = Fate::survived;
    Time ended = {};     ///< unless it survived
    std::uint64_t hits = 0;
    int last_wall = -1;
    std::string report = {};
    StepCounts steps = {};  ///< as World::step_counts
    double kinetic = 0.0;   ///< the largest kinetic energy where a step began
  };
  using Sample = std::function<void(std::size_t walk, std::size_t time, const State&)>;
  /// Follows particles of one kind until `t_end`. `sample` receives the state of each at the given times,
  /// which increase; of one that ends those before. `interrupted`, if set, is asked now and then; true
  /// returns early and false.
  bool run(const Particle& kind, std::span<Walk> walks, double t_end, std::span<const double> times,
           const Sample& sample, const std::function<bool()>& interrupted = {});

  DecisionCounts decisions() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace carom
