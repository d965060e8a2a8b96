// How well the energies of a trajectory's particles are kept where forces act.
#pragma once

#include <cmath>
#include <cstddef>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "base/interrupt.hpp"
#include "carom/engines/engine.hpp"
#include "carom/events/energy.hpp"
#include "carom/starts/sampler.hpp"
#include "carom/system/system.hpp"

namespace carom::engines {

/// What is seen of the energies of trajectories.
struct EnergiesSeen {
  double change = 0.0;  ///< the largest of a trajectory from its start to its end
  EnergyError error;    ///< the largest of a trajectory

  EnergiesSeen& operator+=(const EnergiesSeen& other) {
    change = larger(change, other.change);
    error += other.error;
    return *this;
  }
};

/// Follows the energy of a trajectory at its start, its samples and its end: of each particle, or
/// of all together where they interact. It follows nothing where no force acts, or where particles
/// that interact enter later. The sum over all pairs may take seconds: it throws SamplingStopped
/// where `stopped` says so, and the trajectory does not count.
class EnergyWatch {
 public:
  EnergyWatch(const System& system, std::function<bool()> stopped)
      : system_(&system), stopped_(std::move(stopped)) {
    const bool forces = system.has_forces();
    const bool shared = forces && system.dynamics.forces->interacts();
    of_each_ = forces && !shared;
    of_all_ = shared && system.injections.empty();
  }

  bool watches() const { return of_each_ || of_all_; }
  void begin(const Trajectory& t) {
    if (!watches()) return;
    const std::size_t count = of_each_ ? t.starts.size() : of_all_ ? 1 : 0;
    start_.resize(count);
    largest_.assign(count, 0.0);
    for (std::size_t i = 0; i < count; ++i) start_[i] = now(t, i, t.starts).total();
  }
  void sample(const Trajectory& t, std::size_t particle, std::size_t number, const State& state) {
    if (of_each_) see(particle, energy({&t.particles[particle], 1}, {&state, 1}).total());
    if (!of_all_) return;
    if (number != number_) together_.clear();
    number_ = number;
    together_.push_back(state);
    if (together_.size() == t.particles.size()) see(0, energy(t.particles, together_).total());
  }
  /// Particles that failed do not count; where particles share their energy, all must have
  /// survived.
  EnergiesSeen end(const Trajectory& t, const TrajectoryEnd& end) {
    EnergiesSeen seen;
    if (start_.empty()) return seen;
    std::vector<State> states;
    bool all = true;
    for (const ParticleEnd& p : end.particles) {
      states.push_back(p.state);
      all = all && p.fate == Fate::survived;
    }
    for (std::size_t i = 0; i < start_.size(); ++i) {
      const ParticleEnd& p = end.particles[i];
      if (of_all_ ? !all : is_failure(p.fate)) continue;
      const Energy last = now(t, i, states);
      EnergyBalance balance;
      balance.largest = largest_[i];
      balance.kinetic = p.energy.kinetic;
      seen += {std::fabs(last.total() - start_[i]),
               balance.error_at_end(last.total() - start_[i], last.kinetic)};
    }
    return seen;
  }

 private:
  Energy energy(std::span<const Particle> particles, std::span<const State> states) const {
    base::Interrupt interrupt(&stopped_);
    const Energy sum = energy_of(particles, states, system_->dynamics, *system_->table, &interrupt);
    if (interrupt.stopped()) throw SamplingStopped();
    return sum;
  }
  Energy now(const Trajectory& t, std::size_t i, std::span<const State> states) const {
    return of_all_ ? energy(t.particles, states) : energy({&t.particles[i], 1}, {&states[i], 1});
  }
  void see(std::size_t i, double energy) {
    largest_[i] = larger(largest_[i], std::fabs(energy - start_[i]));
  }

  const System* system_;
  std::function<bool()> stopped_;
  bool of_each_ = false, of_all_ = false;
  std::vector<double> start_, largest_;
  std::vector<State> together_;  ///< at the sample of that number
  std::size_t number_ = 0;
};

}  // namespace carom::engines
