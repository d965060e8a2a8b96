// The table as it was written, at any precision: every number of the system file is enclosed anew,
// so that "0.1" is one tenth and "sqrt(3)/2" is that. Walls are in the order of the Table.
#pragma once

#include <optional>
#include <vector>

#include "carom/geometry/lattice.hpp"
#include "carom/table/table_spec.hpp"
#include "certify/wall/wall.hpp"

namespace carom::certify {

/// The two vectors of a lattice.
template <class Number>
struct LatticeOf {
  VectorOf<Number> first, second;

  VectorOf<Number> at(const geometry::Cell& c) const {
    const Number m(static_cast<double>(c.first)), n(static_cast<double>(c.second));
    return {m * first.x + n * second.x, m * first.y + n * second.y};
  }
};

template <class Number>
struct TableOf {
  std::vector<WallOf<Number>> walls;
  std::optional<LatticeOf<Number>> lattice;
};
using BallTable = TableOf<Ball>;

/// To the present precision. Throws InputError where a shape has no certified form.
BallTable ball_table(const TableSpec&);

}  // namespace carom::certify
