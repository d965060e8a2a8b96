// How a free particle moves between events, and what a reflection does to its velocity.
#pragma once

#include <utility>

#include "carom/geometry/formulas.hpp"
#include "carom/geometry/vector.hpp"

namespace carom {

/// The step s for which v + s v has the right speed: one Newton step of 1/sqrt, with `weight` = 0.75 over
/// the squared speed. 0.75 |v|^2/speed^2 lies in the middle of a binade, where doubles are evenly spaced,
/// so that the step has no bias. It is taken from the velocity before a reflection, so that no hit waits
/// for it; what one reflection errs, the next one mends.
inline double step_to_energy_shell(geometry::Vector v, double weight) {
  return (0.75 - (weight * v.x * v.x + weight * v.y * v.y)) * (2.0 / 3.0);
}

/// Velocity after the n reflections at a corner of angle pi/n between the wall that ends there, with
/// normal `before`, and the one that begins, with normal `after`. An even number is a turn
/// by pi; an odd one is taken alternately at the two walls (the order does not matter in the limit).
geometry::Vector reflected_at_corner(geometry::Vector v, geometry::Vector before, geometry::Vector after, int n);

/// Position and velocity after `duration` >= 0 of a straight or Larmor flight.
std::pair<geometry::Vector, geometry::Vector> moved(geometry::Vector position, geometry::Vector velocity,
                                                    double omega, double duration);

}  // namespace carom
