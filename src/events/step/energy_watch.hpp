// What is seen of the energies of integrated particles.
#pragma once

#include <vector>

#include "carom/base/twofold.hpp"
#include "carom/events/energy.hpp"
#include "events/bodies.hpp"

namespace carom::events {

class Group;

class EnergyWatch {
 public:
  /// `together`: the bodies interact, and have one balance.
  EnergyWatch(const Bodies& bodies, bool together) : bodies_(bodies), together_(together) {}

  /// A body has come, with this kinetic energy.
  void add(double kinetic);
  void clear();

  /// Before a step: its kinetic energy. What others brought or took along since the last step is no
  /// change.
  void before_step(const Group& group);
  /// After a step, and at a hit before its reflection: by how much the energy has changed.
  void after_step(Group& group);

  const EnergyBalance& balance(int body) const { return balances_[entry(body)]; }
  void set_balance(int body, const EnergyBalance& balance);
  /// The body's group has other members from now on: its energy is another one.
  void forget_last(int body);

 private:
  std::size_t entry(int body) const { return together_ ? 0 : static_cast<std::size_t>(body); }
  std::size_t entry_of(const Group& group) const;

  const Bodies& bodies_;
  bool together_;
  std::vector<EnergyBalance>
      balances_;                  ///< one a body; where they interact the first is that of all
  std::vector<Twofold> changes_;  ///< their changes, without the rounding of sums
};

}  // namespace carom::events
