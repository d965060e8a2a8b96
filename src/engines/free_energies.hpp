// Energies of a run without forces.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <limits>
#include <vector>

#include "carom/base/twofold.hpp"
#include "carom/events/energy.hpp"
#include "carom/events/medium.hpp"
#include "carom/events/observer.hpp"
#include "carom/system/system.hpp"

namespace carom::engines {

/// What is seen of the energies of particles that nothing acts on between hits and contacts.
class FreeEnergies {
 public:
  /// `shared`: contacts pass energy on.
  FreeEnergies(const Table& table, const std::vector<Particle>& particles, bool shared)
      : table_(table),
        particles_(particles),
        shared_(shared),
        seen_(particles.size()),
        squares_(particles.size()),
        changes_(particles.size()) {}

  void begin(int particle, const EnergyBalance& before, const State& state) {
    EnergyBalance& seen = seen_[at(particle)];
    const double kinetic = kinetic_energy(particle, state.velocity);
    if (shared_ && begun_) {
      sum_ += kinetic;
    } else {
      seen = before;
      changes_[at(particle)] = {before.change, before.change_low};
      sum_ = kinetic;
      goes_on_ = before.kinetic > 0.0;
    }
    begun_ = true;
    // A part that goes on begins where an undisturbed run has no beginning: its energy there is
    // that of before, but rounded anew.
    if (!goes_on_) seen.kinetic = larger(seen.kinetic, sum_);
  }
  /// `particle`: its number in the system.
  void hit(int particle, const HitEvent& event) {
    if (shared_) return pass({{particle, event.before, event.after}});
    if (!table_.regions.empty()) return see(particle, change_in_region(particle, event));
    Squares& squares = squares_[static_cast<std::size_t>(particle)];
    const double last = dot(event.after, event.after);
    squares.last = last;
    // Nearly every hit: the change is between those that were seen. A square that is no number is
    // not.
    if (squares.least <= last && last <= squares.most) return;
    squares.least = std::min(squares.least, last);
    squares.most = std::max(squares.most, last);
    see(particle, change_of_speed(particle, last));
  }
  void contact(const ContactEvent& event) {
    pass({{event.first, event.first_before, event.first_after},
          {event.second, event.second_before, event.second_after}});
  }
  EnergyBalance of(int particle) const {
    EnergyBalance seen = seen_[at(particle)];
    const double last = squares_[at(particle)].last;
    if (last != no_hit) seen.change = change_of_speed(particle, last);
    return seen;
  }

 private:
  static constexpr double no_hit = -1.0;
  /// Of the speed after hits.
  struct Squares {
    double least = std::numeric_limits<double>::infinity();
    double most = 0.0;
    double last = no_hit;
  };
  struct Change {
    int particle;
    geometry::Vector before, after;
  };
  /// Differences are added without rounding, so that nothing but the energies' own roundings is
  /// left of them.
  void pass(std::initializer_list<Change> all) {
    for (const Change& one : all)
      changes_[0] = changes_[0] + Twofold::sum(kinetic_energy(one.particle, one.after),
                                               -kinetic_energy(one.particle, one.before));
    see(0, changes_[0].high);
    seen_[0].change_low = changes_[0].low;
  }
  void see(int particle, double change) {
    EnergyBalance& seen = seen_[at(particle)];
    seen.change = change;
    seen.largest = larger(seen.largest, std::fabs(change));
  }
  double change_in_region(int particle, const HitEvent& event) const {
    const Particle& p = particles_[static_cast<std::size_t>(particle)];
    const double speed = in_region(table_, p, region_of(table_, event.wall)).speed;
    return 0.5 * p.mass * (dot(event.after, event.after) - speed * speed);
  }
  /// Of a particle that shares its energy with none.
  double change_of_speed(int particle, double square) const {
    const Particle& p = particles_[static_cast<std::size_t>(particle)];
    return 0.5 * p.mass * square - 0.5 * p.mass * (p.speed * p.speed);
  }
  std::size_t at(int particle) const { return shared_ ? 0 : static_cast<std::size_t>(particle); }
  double kinetic_energy(int particle, const geometry::Vector& v) const {
    return 0.5 * particles_[static_cast<std::size_t>(particle)].mass * dot(v, v);
  }

  const Table& table_;
  const std::vector<Particle>& particles_;
  const bool shared_;
  bool begun_ = false, goes_on_ = false;
  double sum_ = 0.0;
  std::vector<EnergyBalance> seen_;
  std::vector<Squares> squares_;
  std::vector<Twofold> changes_;
};

}  // namespace carom::engines
