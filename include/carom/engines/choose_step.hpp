// The step of a system under forces that names none.
#pragma once

#include <functional>

#include "carom/system/system.hpp"

namespace carom {

/// A fixed step and what is known of it.
struct ChosenStep {
  double step = 0.0;
  double energy_error = 0.0;  ///< largest of the trial runs, relative to their kinetic energy
};

/// Must a step be chosen: do forces act, and is neither a step nor a tolerance given?
bool needs_step(const System&);

/// May the field turn velocities by as much as it does in such a step? Up to where check_turn
/// warns, or refuses where there are walls.
bool turn_allowed(const System&, double step);

/// The longest of 1, 2, 5, 10, ... times a power of ten that resolves the forces
/// (docs/physics/resolution.md) over what is accessible of a bounded table or a lattice's cell, and
/// on trial runs, and that keeps their energy to 1e-10; where none does, the one that keeps it
/// best. A function of the system alone. Throws InputError where no step resolves the forces, or
/// the first trajectory cannot start, and SamplingStopped.
ChosenStep choose_step(const System&, const std::function<bool()>& stopped = {});

}  // namespace carom
