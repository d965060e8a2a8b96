// Formulas of starts that are drawn.
#pragma once

#include <algorithm>
#include <cmath>

#include "carom/geometry/vector.hpp"
#include "carom/motion/state.hpp"
#include "carom/starts/sampler.hpp"

namespace carom::starts {

/// Of initial conditions that cannot be.
inline InputError impossible(const InitialCondition& initial, const std::string& problem,
                             const std::string& expected = {}) {
  Place place = initial.place;
  if (place.key.empty()) place.key = "initial";
  return InputError(place, problem, expected);
}

inline geometry::Vector unit(geometry::Vector v) {
  v = (1.0 / std::max(std::abs(v.x), std::abs(v.y))) * v;  // no overflow in the squares
  v = (1.0 / std::sqrt(dot(v, v))) * v;
  // One Newton step: |v| = 1 to rounding.
  return (1.5 - 0.5 * dot(v, v)) * v;
}

/// `right` and `up` are shares of the box's sides.
inline geometry::Vector point_of_box(geometry::Vector low, geometry::Vector high, double right,
                                     double up) {
  return {low.x + right * (high.x - low.x), low.y + up * (high.y - low.y)};
}

/// Number by number (motion/take_state.hpp).
inline void put_off_walls(State& state, const Table& table, geometry::Vector position,
                          geometry::Vector velocity) {
  state.wall = -1;
  state.u = 0.0;
  state.position.x = position.x;
  state.position.y = position.y;
  state.velocity.x = velocity.x;
  state.velocity.y = velocity.y;
  state.cell.first = state.cell.second = 0;
  state.time.high = state.time.low = 0.0;
  if (table.lattice) fold_into_cell(table, state.position, state.cell);
}

}  // namespace carom::starts
