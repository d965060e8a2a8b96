// Energy, momentum and angular momentum of the particles of one instant.
#pragma once

#include <span>

#include "carom/events/dynamics.hpp"
#include "carom/table/table.hpp"

namespace carom {

/// The parts of the total energy.
struct Energy {
  double kinetic = 0.0, external = 0.0, pair = 0.0;
  double total() const { return kinetic + external + pair; }
};

/// One state a particle, all at the same time. Pairs on a lattice see their nearest copies, as in the
/// motion.
Energy energy_of(std::span<const Particle>, std::span<const State>, const Dynamics&, const Table&);

/// Sum of m v. Conserved without walls, external forces and field.
geometry::Vector momentum_of(std::span<const Particle>, std::span<const State>);

/// Sum of m (x cross v + omega r^2 / 2) about the origin of the plane, positions unwrapped: the canonical
/// angular momentum, conserved where walls and forces are round about the origin.
double angular_momentum_of(std::span<const Particle>, std::span<const State>, const Table&);

}  // namespace carom
