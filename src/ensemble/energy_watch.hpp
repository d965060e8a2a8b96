// How well the energies of an escape ensemble's particles are kept where forces act.
#pragma once

#include <span>

#include "carom/ensemble/system.hpp"
#include "carom/events/energy.hpp"

namespace carom {

class EnergyWatch {
 public:
  explicit EnergyWatch(const System& system)
      : system_(system), forces_(system.dynamics.forces && !system.dynamics.forces->empty()) {}

  /// Forces act, and each particle has an energy of its own.
  bool of_each() const { return forces_ && !system_.dynamics.forces->interacts(); }
  /// Particles share their energy, from the start on.
  bool of_all() const { return forces_ && system_.dynamics.forces->interacts() && system_.injections.empty(); }

  double energy(const Particle& particle, const State& state) const {
    return energy_of({&particle, 1}, {&state, 1}, system_.dynamics, *system_.table).total();
  }
  double energy(std::span<const State> states) const {
    return energy_of(system_.particles, states, system_.dynamics, *system_.table).total();
  }

 private:
  const System& system_;
  bool forces_;
};

}  // namespace carom
