// The forces of all Coulomb pairs at once, and their energy.
#pragma once

#include <span>

#include "carom/geometry/vector.hpp"
#include "carom/motion/state.hpp"

namespace carom::base {
class Interrupt;
}  // namespace carom::base

namespace carom::forces {

/// Adds strength q_i q_j d / |d|^3, d = x_i - x_j, of every pair to `force`; the other feels the
/// opposite, exactly. The sums are taken in an order that depends on the number of particles alone,
/// so the bits are the same on every instruction set. Where `interrupt`, if there is one, says so,
/// it stops half done.
void add_coulomb_pairs(double strength, std::span<const Particle> particles,
                       std::span<const geometry::Vector> x, std::span<geometry::Vector> force,
                       base::Interrupt* interrupt = nullptr);
/// The sum of strength q_i q_j / |d| over every pair, in such an order.
double coulomb_energy(double strength, std::span<const Particle> particles,
                      std::span<const geometry::Vector> x, base::Interrupt* interrupt = nullptr);

}  // namespace carom::forces
