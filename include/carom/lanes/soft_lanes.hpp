// Many independent particles under external forces at once, in the lanes of SIMD registers.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "carom/events/dynamics.hpp"
#include "carom/lanes/instruction_set.hpp"
#include "carom/motion/state.hpp"
#include "carom/table/table.hpp"

namespace carom {

/// Steps of a splitting scheme with many particles, each by itself: the same orbits as World, bit for bit.
class SoftLanes {
 public:
  /// Can such particles be stepped so? Where forces act everywhere, and nothing but forces and a magnetic
  /// field: no walls, no interaction, a fixed step.
  static bool suits(const Table&, const Dynamics&);

  /// Keeps references to both, which must live as long.
  SoftLanes(const Table& table, const Dynamics& dynamics, InstructionSet set);
  ~SoftLanes();
  SoftLanes(SoftLanes&&) noexcept;

  /// A particle on its way.
  struct Walk {
    State state;        ///< at time 0; then after the last whole step before the end
    bool lost = false;  ///< it left the numbers: World says how
  };
  using Sample = std::function<void(std::size_t walk, std::size_t time, const State&)>;
  /// Follows particles of one kind until `t_end`. `sample` receives the state of each at the given times,
  /// which increase; of one that is lost those before. `interrupted`, if set, is asked now and then; true
  /// returns early and false.
  bool run(const Particle& kind, std::span<Walk> walks, double t_end, std::span<const double> times,
           const Sample& sample, const std::function<bool()>& interrupted = {});

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace carom
