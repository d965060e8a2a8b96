#include "carom/events/energy.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/interrupt.hpp"
#include "forces/nearest_copy.hpp"

namespace carom {

using geometry::Vector;

double relative_to(double kinetic, double change) {
  if (change == 0.0) return 0.0;
  return std::isnan(change) ? std::numeric_limits<double>::infinity() : std::fabs(change) / kinetic;
}

EnergyError EnergyBalance::error_at_end(double change_at_end, double kinetic_at_end) const {
  const double scale = larger(kinetic, kinetic_at_end);
  const double end = relative_to(scale, change_at_end);
  return {change_at_end < 0.0 ? -end : end,
          relative_to(scale, larger(largest, std::fabs(change_at_end)))};
}

Energy energy_of(std::span<const Particle> particles, std::span<const State> states,
                 const Dynamics& dynamics, const Table& table, base::Interrupt* interrupt) {
  Energy e;
  for (std::size_t i = 0; i < states.size(); ++i)
    e.kinetic += 0.5 * particles[i].mass * dot(states[i].velocity, states[i].velocity);
  if (!dynamics.forces) return e;
  const ForceField& forces = *dynamics.forces;
  Vector unused{};
  for (std::size_t i = 0; i < states.size(); ++i) {
    if (interrupt && interrupt->after(10.0 * static_cast<double>(states.size() - i))) return e;
    if (forces.external())
      e.external += forces.add_external(particles[i], states[i].position, unused);
    for (std::size_t j = i + 1; j < states.size() && forces.interacts(); ++j) {
      Vector d = states[i].position - states[j].position;
      if (table.lattice) d = forces::nearest_copy(d, *table.lattice);
      e.pair += forces.add_pair(particles[i], particles[j], d, unused);
    }
  }
  return e;
}

Vector momentum_of(std::span<const Particle> particles, std::span<const State> states) {
  Vector sum{};
  for (std::size_t i = 0; i < states.size(); ++i)
    sum = sum + particles[i].mass * states[i].velocity;
  return sum;
}

double angular_momentum_of(std::span<const Particle> particles, std::span<const State> states,
                           const Table& table) {
  double sum = 0.0;
  for (std::size_t i = 0; i < states.size(); ++i) {
    const Particle& p = particles[i];
    Vector x = states[i].position;
    if (table.lattice) x = x + table.lattice->translation(states[i].cell);
    // d/dt (x cross v) = omega (x cross Jv) = -omega (x . v) = -d/dt (omega r^2 / 2)
    sum += p.mass * (cross(x, states[i].velocity) + 0.5 * p.omega * dot(x, x));
  }
  return sum;
}

}  // namespace carom
