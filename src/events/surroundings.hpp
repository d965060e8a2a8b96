// The walls that a particle may meet within a step.
#pragma once

#include <optional>
#include <vector>

#include "carom/geometry/curve.hpp"
#include "carom/geometry/lattice.hpp"
#include "carom/table/table.hpp"
#include "events/barrier.hpp"

namespace carom {

/// The curve, on a lattice with its copies in the cells around.
std::vector<Barrier<double>> barriers_of(const geometry::Curve&, int wall, const std::optional<geometry::Lattice>&);

/// How far a step may lead where there are walls: through a bounded table a thousand times, as it would
/// hit them about as often; on a lattice to the next cell.
double longest_way(const Table&);

}  // namespace carom
