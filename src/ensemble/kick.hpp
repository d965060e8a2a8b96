// Small random changes of states on walls.
#pragma once

#include <vector>

#include "carom/geometry/curve_frame.hpp"
#include "carom/motion/state.hpp"
#include "carom/table/table.hpp"

namespace carom {

class RandomStream;

/// Moves a state that has just hit in its Birkhoff coordinates, uniformly within a box around it. At the ends
/// of its wall, at holes and at grazing directions the move is folded back, so that the invariant measure ds
/// d(v_parallel) is kept, and no state ever lies in a hole.
class Kick {
 public:
  explicit Kick(const Table&);

  /// s changes by up to delta times the length of the wall, v_parallel / speed by up to delta. Where rounding
  /// would leave the wall, the state is given back as it is.
  State operator()(const State&, double speed, double delta, RandomStream&) const;

 private:
  /// A part of a wall between holes.
  struct Piece {
    double from = 0.0, to = 0.0;    ///< parameter; `to` does not belong to it
    double start = 0.0, end = 0.0;  ///< arc length
  };
  struct Side {
    geometry::CurveFrame frame;
    double length = 0.0;
    std::vector<Piece> pieces;
  };
  std::vector<Side> sides_;  // one a wall
};

}  // namespace carom
