// Energy, momentum and angular momentum of the particles of one instant.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "carom/base/fields.hpp"
#include "carom/events/dynamics.hpp"
#include "carom/table/table.hpp"

namespace carom::base {
class Interrupt;
}  // namespace carom::base

namespace carom {

/// The parts of the total energy.
struct Energy {
  double kinetic = 0.0, external = 0.0, pair = 0.0;
  double total() const { return kinetic + external + pair; }
};

/// The larger one of two numbers, none of them negative; one that is no number counts as infinite.
inline double larger(double a, double b) {
  if (std::isnan(a) || std::isnan(b)) return std::numeric_limits<double>::infinity();
  return std::max(a, b);
}

/// How far energy is from what it was at the start, relative to the largest kinetic energy seen.
struct EnergyError {
  double end = 0.0;      ///< at the end
  double largest = 0.0;  ///< the largest seen, without its sign
  /// Adds other trajectories: keeps the largest of each error, without a sign.
  EnergyError& operator+=(const EnergyError& other) {
    end = larger(std::fabs(end), std::fabs(other.end));
    largest = larger(largest, other.largest);
    return *this;
  }
};

template <>
struct Fields<EnergyError> {
  static constexpr std::tuple list{
      field("energy_error.end", "1",
            "Largest change of an energy until the end, relative to the largest kinetic energy",
            &EnergyError::end),
      field("energy_error.largest", "1",
            "Largest change of an energy seen, relative to the largest kinetic energy",
            &EnergyError::largest)};
};

/// What is seen of the energy of a particle under forces, or of all particles together where they
/// interact.
struct EnergyBalance {
  double change = 0.0;      ///< since the start, at the end of the latest step
  double largest = 0.0;     ///< the largest change after a step or at a hit, without its sign
  double kinetic = 0.0;     ///< the largest kinetic energy where a step began
  double change_low = 0.0;  ///< what a double does not hold of the change
  /// The energy after the latest step, from which the next change counts; NaN: it is not known.
  double last = std::numeric_limits<double>::quiet_NaN();

  /// With what is seen at the end.
  EnergyError error_at_end(double change_at_end, double kinetic_at_end) const;
};

/// |change| / kinetic, or 0 where nothing has changed.
double relative_to(double kinetic, double change);

/// One state a particle, all at the same time. Pairs on a lattice see their nearest copies, as in
/// the motion. Where `interrupt` says so, it stops half done.
Energy energy_of(std::span<const Particle>, std::span<const State>, const Dynamics&, const Table&,
                 base::Interrupt* interrupt = nullptr);

/// Sum of m v. Conserved without walls, external forces and field.
geometry::Vector momentum_of(std::span<const Particle>, std::span<const State>);

/// Sum of m (x cross v + omega r^2 / 2) about the origin of the plane, positions unwrapped: the
/// canonical angular momentum, conserved where walls and forces are round about the origin.
double angular_momentum_of(std::span<const Particle>, std::span<const State>, const Table&);

}  // namespace carom
