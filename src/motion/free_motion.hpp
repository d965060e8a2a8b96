// How a free particle moves between events, and what a reflection does to its velocity.
#pragma once

#include <utility>

#include "carom/geometry/formulas.hpp"
#include "carom/geometry/vector.hpp"
#include "carom/motion/state.hpp"

namespace carom::motion {

/// The energy shell of particles of this speed.
geometry::EnergyShell<double> energy_shell(double speed);

/// Velocity after the n reflections at a corner of angle pi/n between the wall that ends there,
/// with normal `before`, and the one that begins, with normal `after`. An even number is a turn by
/// pi; an odd one is taken alternately at the two walls (the order does not matter in the limit).
geometry::Vector reflected_at_corner(geometry::Vector v, geometry::Vector before,
                                     geometry::Vector after, int n);

/// Position and velocity after `duration` >= 0 of a straight or Larmor flight.
std::pair<geometry::Vector, geometry::Vector> moved(geometry::Vector position,
                                                    geometry::Vector velocity, double omega,
                                                    double duration);

/// A particle's state on its flight from its last event, at a time that is not before that.
State flown(const State& last, double omega, Time t);

}  // namespace carom::motion
