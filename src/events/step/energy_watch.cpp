#include "events/step/energy_watch.hpp"

#include <cmath>

#include "events/step/group.hpp"

namespace carom::events {

std::size_t EnergyWatch::entry_of(const Group& group) const {
  return entry(group.bodies().front());
}

void EnergyWatch::add(double kinetic) {
  balances_.emplace_back();
  balances_.back().kinetic = kinetic;
  changes_.emplace_back();
}

void EnergyWatch::clear() {
  balances_.clear();
  changes_.clear();
}

void EnergyWatch::before_step(const Group& group) {
  double kinetic = 0.0;
  if (together_) {
    for (int i = 0; i < bodies_.size(); ++i) {
      const Body& b = bodies_[i];
      if (b.finished) continue;
      const geometry::Vector velocity = bodies_.state(i).velocity;
      kinetic += 0.5 * b.particle.mass * dot(velocity, velocity);
    }
  } else {
    kinetic = group.kinetic_energy();
  }
  EnergyBalance& balance = balances_[entry_of(group)];
  balance.kinetic = larger(balance.kinetic, kinetic);
}

void EnergyWatch::after_step(Group& group) {
  EnergyBalance& balance = balances_[entry_of(group)];
  Twofold& change = changes_[entry_of(group)];
  change = change + group.change_of_energy();
  balance.change = change.high;
  balance.change_low = change.low;
  balance.last = group.last_energy();
  balance.largest = larger(balance.largest, std::fabs(balance.change));
}

void EnergyWatch::forget_last(int body) { balances_[entry(body)].last = EnergyBalance().last; }

void EnergyWatch::set_balance(int body, const EnergyBalance& balance) {
  balances_[entry(body)] = balance;
  changes_[entry(body)] = {balance.change, balance.change_low};
}

}  // namespace carom::events
