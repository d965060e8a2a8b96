// What is seen of the energies of integrated particles.
#include <cmath>

#include "events/world_implementation.hpp"

namespace carom {

EnergyBalance& World::Implementation::balance_of(const Group& group) {
  return balances[share_energy() ? 0 : static_cast<std::size_t>(group.bodies().front())];
}

/// Before a step. What others brought or took along since the last one is no change.
void World::Implementation::look_at_start(Group& group) {
  if (!group.between_steps()) return;
  double kinetic = 0.0;
  if (share_energy()) {
    for (const Body& b : bodies)
      if (!b.finished) kinetic += 0.5 * b.particle.mass * dot(b.state.velocity, b.state.velocity);
  } else {
    kinetic = group.kinetic_energy();
  }
  EnergyBalance& balance = balance_of(group);
  balance.kinetic = larger(balance.kinetic, kinetic);
  if (surroundings.remember_energy && !group.has_energy()) group.change_of_energy();
}

/// After a step, and at a hit before its reflection.
void World::Implementation::look_at_end(Group& group) {
  if (!surroundings.remember_energy || !group.between_steps()) return;
  EnergyBalance& balance = balance_of(group);
  Twofold& change = changes[static_cast<std::size_t>(&balance - balances.data())];
  change = change + group.change_of_energy();
  balance.change = change.value();
  balance.largest = larger(balance.largest, std::fabs(balance.change));
}

const StepCounts& World::step_counts() const { return implementation_->steps; }

void World::watch_energy() { implementation_->surroundings.remember_energy = true; }

const EnergyBalance& World::energy_balance(int particle) const {
  const Implementation& w = *implementation_;
  return w.balances[w.share_energy() ? 0 : static_cast<std::size_t>(particle)];
}

void World::set_energy_balance(int particle, const EnergyBalance& before) {
  Implementation& w = *implementation_;
  const std::size_t i = w.share_energy() ? 0 : static_cast<std::size_t>(particle);
  w.balances[i] = before;
  w.changes[i] = before.change;
}

}  // namespace carom
