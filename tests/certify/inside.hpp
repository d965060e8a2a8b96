// Points of the domain of a table.
#pragma once

#include <stdexcept>

#include "carom/events/world.hpp"
#include "certify/systems.hpp"
#include "random_tables.hpp"

namespace carom::tests {

/// Can a particle start there?
inline bool lies_inside(const Table& table, const geometry::Vector& position) {
  World world(table);
  State state;
  state.position = position;
  state.velocity = {1.0, 0.0};
  try {
    world.add(Particle{}, state);
    return true;
  } catch (const std::invalid_argument&) {
    return false;
  }
}

/// The same table with any start, not far from the one it has.
inline Shaped with_random_start(Shaped s, Dice& dice) {
  const Table table = build_table(s.spec);
  const geometry::Vector about{s.inside.x.to_double(), s.inside.y.to_double()};
  for (;;) {
    const geometry::Vector there =
        about + geometry::Vector{dice.between(-1.5, 1.5), dice.between(-1.5, 1.5)};
    if (!lies_inside(table, there)) continue;
    s.inside = {there.x, there.y};
    return s;
  }
}

}  // namespace carom::tests
