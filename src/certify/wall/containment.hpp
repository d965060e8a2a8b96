// On which side of the walls does a point lie? By signs of balls.
#pragma once

#include <vector>

#include "carom/table/table.hpp"
#include "certify/flight/scene.hpp"

namespace carom::certify {

/// Walls one after the other, back to the first: the whole boundary of the table, or that of an
/// obstacle.
struct WallLoop {
  std::vector<int> walls;
  bool obstacle = false;
};
std::vector<WallLoop> loops_of(const Table&);

/// A loop, in a cell of the lattice.
struct LoopCopy {
  const WallLoop* loop = nullptr;
  geometry::Cell cell;
};

/// The loops of a table that a point may lie in or on.
class Containment {
 public:
  /// Walls and point are balls of the present precision.
  Containment(const std::vector<WallLoop>&, const BallTable&, const BallVector& point);
  /// Are there more than could be looked for?
  bool too_far() const { return too_far_; }
  /// Does the point lie on the domain's side of all of them?
  Verdict verdict() const { return verdict_; }
  /// The loops for which this is undecided.
  const std::vector<LoopCopy>& in_doubt() const { return in_doubt_; }

 private:
  void ask(const LoopCopy&, const BallTable&, const BallVector& seen);

  bool too_far_ = false;
  Verdict verdict_ = Verdict::yes;
  std::vector<LoopCopy> in_doubt_;
};

}  // namespace carom::certify
