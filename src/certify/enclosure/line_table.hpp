// Walls as a straight flight sees them that is known as a line: its velocity v, and its moment h =
// v x (P - c) about a point c of the wall, which is the same for all points P of the flight.
#pragma once

#include <vector>

#include "certify/enclosure/state_enclosure.hpp"

namespace carom::certify {

/// A constant factor, and the same as a quotient of two words where it is known to be one: then a
/// product is quick.
struct Factor {
  Ball value;
  long above = 0;
  unsigned long below = 0;  ///< 0: not known

  Ball times(Ball x) const;
};

struct LineWall {
  bool arc = false;
  double side = 1.0;          ///< of an arc: +1 where the domain is inside the circle, -1 outside
  BallVector anchor;          ///< the point c: the centre of an arc, the start of a segment
  BallVector tangent;         ///< of a segment, of any length
  BallVector double_tangent;  ///< 2 tangent/(tangent . tangent)
  Ball size2;      ///< of an arc: (radius speed)^2, the square of the largest moment that meets it
  Factor inverse;  ///< 1/size2
  double radius = 1.0;  ///< of an arc, nearly
};

struct LineTable {
  LineTable() = default;
  /// `few_bits`: of numbers that are read and not carried on.
  LineTable(const SceneOf<Ball>&, long few_bits);
  /// Looks for short constants among the numbers as they were written.
  void shorten(const ExactSystem&);
  /// Are all walls segments and arcs, and all flights straight?
  static bool holds(const SceneOf<Ball>&);
  void round();  ///< to the present precision

  std::vector<LineWall> walls, few_walls;
  Ball few_inverse_speed2;
  long few_bits = 64;
};

}  // namespace carom::certify
