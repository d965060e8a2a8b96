// Small random changes of states on walls.
#pragma once

#include <vector>

#include "carom/geometry/curve_frame.hpp"
#include "carom/motion/state.hpp"
#include "carom/table/table.hpp"

namespace carom {
class RandomStream;
}  // namespace carom

namespace carom::analyses {

/// Turns the velocity of a state that has just hit: v_parallel changes, the place on the wall does
/// not. Grazing directions fold it back, so that the invariant measure ds d(v_parallel) is kept. A
/// move along the wall would have to be folded at ends of walls and holes, and there it bends the
/// populations: folded copies lie on the other side of the orbits that pass that end
/// (docs/physics/rare-events.md).
class Kick {
 public:
  explicit Kick(const Table&);

  /// v_parallel / speed changes by up to delta, uniformly. Where rounding leaves nothing to turn
  /// into the domain, the state is given back as it is.
  State operator()(const State&, double speed, double delta, RandomStream&) const;

 private:
  std::vector<geometry::CurveFrame> frames_;  // one a wall
};

}  // namespace carom::analyses
