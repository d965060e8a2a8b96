// Starts of particles under forces: total energies, and particles that feel each other.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "base/interrupt.hpp"
#include "carom/base/error.hpp"
#include "carom/base/random.hpp"
#include "carom/events/energy.hpp"
#include "carom/starts/sampler.hpp"

namespace carom {

using geometry::Vector;
using Kind = InitialCondition::Kind;

namespace {

/// Draws until a start below the energy is found: rarer ones are reported as impossible.
constexpr std::int64_t most_draws = 100'000;
/// Pairs of interacting particles whose energy is computed in all draws, some nanoseconds each.
constexpr double most_pairs_of_sampling = 1e8;
std::int64_t most_draws_of_all(std::size_t particles) {
  const double n = static_cast<double>(particles), pairs = 0.5 * n * (n - 1.0);
  return std::clamp<std::int64_t>(static_cast<std::int64_t>(most_pairs_of_sampling / pairs), 4,
                                  most_draws);
}

Vector with_speed(Vector velocity, double speed) {
  return (speed / std::sqrt(dot(velocity, velocity))) * velocity;
}

// Of interacting particles the sum is shared out: what was written is the energy of each.
std::string of_all(const std::vector<double>& energies) {
  const bool equal = std::all_of(energies.begin(), energies.end(),
                                 [&](double one) { return one == energies.front(); });
  return equal ? fmt::format(", the {:.6g} of each of {} particles together", energies.front(),
                             energies.size())
               : ", the energies of all particles together";
}

InputError too_little_energy(const System& system, double energy, double lowest, bool together) {
  Place place = system.initial.place;
  place.key = "particles.energy";
  return InputError(
      place,
      fmt::format("no start has less potential energy than {:.6g}{}: the lowest seen is {:.6g}",
                  energy, together ? of_all(system.energies) : "", lowest),
      "an energy above the potential's minimum, or another region to start from");
}

InputError at_a_pole(const System& system, Vector x) {
  return InputError(
      system.initial.place,
      fmt::format("the potential or its force has no finite value at the start ({}, {})", x.x, x.y),
      "a start off the poles of the potential");
}

}  // namespace

bool Sampler::random_positions() const {
  const Kind kind = system_.initial.kind;
  return kind != Kind::point && kind != Kind::list && kind != Kind::birkhoff;
}

State Sampler::draw_external(const World& world, std::uint64_t trajectory, int particle) const {
  RandomStream random(system_.run.seed, Purpose::initial_state, trajectory,
                      static_cast<std::uint64_t>(particle));
  const Particle& p = system_.particles.at(static_cast<std::size_t>(particle));
  if (system_.energies.empty()) {
    const State state = draw_free(world, random, trajectory, particle);
    Vector force{};
    const double potential = system_.dynamics.forces->add_external(p, state.position, force);
    if (std::isfinite(potential) && std::isfinite(force.x) && std::isfinite(force.y)) return state;
    throw at_a_pole(system_, state.position);
  }
  const double energy = system_.energies.at(static_cast<std::size_t>(particle));
  double lowest = std::numeric_limits<double>::infinity();
  const std::int64_t most = random_positions() ? patience(most_draws, trajectory) : 1;
  for (std::int64_t draw = 0; draw < most; ++draw) {
    stop_if_asked(draw);
    State state = draw_free(world, random, trajectory, particle, draw > 0);
    Vector unused{};
    const double potential = system_.dynamics.forces->add_external(p, state.position, unused);
    lowest = std::min(lowest, potential);
    if (!(potential < energy)) continue;
    state.velocity = with_speed(state.velocity, std::sqrt(2.0 * (energy - potential) / p.mass));
    return state;
  }
  throw too_little_energy(system_, energy, lowest, false);
}

std::vector<State> Sampler::draw_all(const World& world, std::uint64_t trajectory) const {
  const std::size_t count = system_.particles.size();
  const Dynamics& dynamics = system_.dynamics;
  std::vector<State> states;
  if (system_.of_discs()) return draw_discs(world, trajectory);
  if (!dynamics.forces || !dynamics.forces->interacts() || count == 1) {
    for (std::size_t p = 0; p < count; ++p)
      states.push_back(draw(world, trajectory, static_cast<int>(p)));
    return states;
  }
  std::vector<RandomStream> random;
  for (std::size_t p = 0; p < count; ++p)
    random.emplace_back(system_.run.seed, Purpose::initial_state, trajectory, p);
  double energy = 0.0;
  for (const double e : system_.energies) energy += e;
  double lowest = std::numeric_limits<double>::infinity();
  const std::int64_t most = random_positions() ? patience(most_draws_of_all(count), trajectory) : 1;
  base::Interrupt interrupt(&stopped_);
  for (std::int64_t draw = 0; draw < most; ++draw) {
    states.clear();
    for (std::size_t p = 0; p < count; ++p) {
      if (interrupt.after(1000.0)) throw SamplingStopped();
      states.push_back(draw_free(world, random[p], trajectory, static_cast<int>(p)));
    }
    const Energy now = energy_of(system_.particles, states, dynamics, *system_.table, &interrupt);
    if (interrupt.stopped()) throw SamplingStopped();
    const double potential = now.external + now.pair;
    if (!std::isfinite(potential)) {
      if (random_positions()) continue;
      Place place = system_.initial.place;
      throw InputError(place, "two particles start at the same point, or at a pole of a potential",
                       "positions of their own");
    }
    if (system_.energies.empty()) return states;
    lowest = std::min(lowest, potential);
    if (!(potential < energy)) continue;
    const double each = (energy - potential) / static_cast<double>(count);
    for (std::size_t p = 0; p < count; ++p)
      states[p].velocity =
          with_speed(states[p].velocity, std::sqrt(2.0 * each / system_.particles[p].mass));
    return states;
  }
  throw too_little_energy(system_, energy, lowest, true);
}

}  // namespace carom
