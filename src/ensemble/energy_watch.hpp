// How well the energies of an ensemble's particles are kept where forces act.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "carom/ensemble/system.hpp"
#include "carom/events/energy.hpp"

namespace carom {

/// Which energies of a trajectory are kept: of each particle, of all together, or none.
class EnergyWatch {
 public:
  explicit EnergyWatch(const System& system)
      : system_(system), forces_(system.dynamics.forces && !system.dynamics.forces->empty()) {}

  /// Forces act, and each particle has an energy of its own.
  bool of_each() const { return forces_ && !system_.dynamics.forces->interacts(); }
  /// Particles share their energy, from the start on.
  bool of_all() const { return forces_ && system_.dynamics.forces->interacts() && system_.injections.empty(); }

  Energy energy(const Particle& particle, const State& state) const {
    return energy_of({&particle, 1}, {&state, 1}, system_.dynamics, *system_.table);
  }
  Energy energy(std::span<const State> states) const {
    return energy_of(system_.particles, states, system_.dynamics, *system_.table);
  }

 private:
  const System& system_;
  bool forces_;
};

/// What is seen of the energies of trajectories.
struct EnergiesSeen {
  double change = 0.0;  ///< the largest of a trajectory from its start to its end
  EnergyError error;    ///< the largest of a trajectory

  /// One of them: its energy at the start and at the end, the largest change seen between, and its largest kinetic energy until
  /// the end.
  void add(double start, const Energy& end, double largest, double kinetic) {
    EnergyBalance balance;
    balance.largest = largest;
    balance.kinetic = kinetic;
    change = larger(change, std::fabs(end.total() - start));
    error += balance.error_at_end(end.total() - start, end.kinetic);
  }
};

/// Of one trajectory at the times of its samples, and at its end.
class SampledEnergies {
 public:
  explicit SampledEnergies(const System& system) : watch_(system), particles_(system.particles) {}

  void begin(std::span<const State> starts) {
    const std::size_t count = watch_.of_each() ? starts.size() : watch_.of_all() ? 1 : 0;
    start_.assign(count, 0.0);
    largest_.assign(count, 0.0);
    for (std::size_t i = 0; i < count; ++i) start_[i] = now(i, starts).total();
  }
  /// Of a particle that has an energy of its own.
  void sample(std::size_t particle, const State& state) {
    if (watch_.of_each()) see(particle, watch_.energy(particles_[particle], state).total());
  }
  /// Of all particles, where they share their energy.
  void sample(std::span<const State> states) {
    if (watch_.of_all() && states.size() == particles_.size()) see(0, watch_.energy(states).total());
  }
  /// How a particle ended; `kinetic`: as EnergyBalance.
  struct End {
    State state;
    Fate fate = Fate::survived;
    double kinetic = 0.0;
  };
  /// Of a particle that failed nothing is known; of particles that share their energy, all must be left.
  EnergiesSeen end(std::span<const End> ends) const {
    EnergiesSeen seen;
    std::vector<State> states;
    bool all = true;
    for (const End& end : ends) {
      states.push_back(end.state);
      all = all && end.fate == Fate::survived;
    }
    for (std::size_t i = 0; i < start_.size(); ++i)
      if (watch_.of_all() ? all : !is_failure(ends[i].fate)) seen.add(start_[i], now(i, states), largest_[i], ends[i].kinetic);
    return seen;
  }

 private:
  Energy now(std::size_t i, std::span<const State> states) const {
    return watch_.of_all() ? watch_.energy(states) : watch_.energy(particles_[i], states[i]);
  }
  void see(std::size_t i, double energy) { largest_[i] = larger(largest_[i], std::fabs(energy - start_[i])); }

  EnergyWatch watch_;
  const std::vector<Particle>& particles_;
  std::vector<double> start_, largest_;
};

}  // namespace carom
