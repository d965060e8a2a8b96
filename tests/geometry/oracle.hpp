// Which wall a flight meets first, decided apart from the engine: from the definitions of the
// curves in rational numbers, with CGAL's circular kernel for lines and circles and its algebraic
// kernel for ellipses. Slow and plain: all points at which the flight passes through a piece, the
// nearest of them.
#pragma once

#include <memory>

#include "carom/table/table.hpp"

namespace carom::tests {

struct Expected {
  enum class Kind { none, wall, joint, cusp } kind = Kind::none;
  int wall = -1;      ///< the one passed, or the one that starts at the joint
  double turn = 0.0;  ///< rounded: how far along the flight (time; Larmor: 1 - cos, or 3 + cos
                      ///< beyond half a turn)
};

class Oracle {
 public:
  explicit Oracle(const Table& table);
  ~Oracle();
  /// From the exact point u of a wall, or from the exact `point` if wall < 0.
  Expected first(int wall, double u, geometry::Vector point, geometry::Vector velocity,
                 double omega) const;
  /// Is the crossing found by the last call of `first` within [from, to) of its wall?
  bool within(double from, double to) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace carom::tests
