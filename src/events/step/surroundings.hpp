// The walls that a particle may meet within a step.
#pragma once

#include <span>
#include <vector>

#include "carom/geometry/curve.hpp"
#include "carom/table/table.hpp"
#include "events/step/barrier.hpp"

namespace carom::events {

/// The barriers of the table's walls, numbered as these. On the table's lattice: all copies that a
/// particle may meet within a step that leads no farther than longest_way(table). Throws InputError
/// if there are too many.
std::vector<Barrier<double>> barriers_of(const Table&);
/// The same of closed curves that are no walls, numbered in their order.
std::vector<Barrier<double>> barriers_of_edges(std::span<const geometry::Curve>, const Table&);

/// Is the point inside one of the supports, or on its edge to rounding, where a flight would not
/// know its side? `except` is not asked.
bool in_some_support(std::span<const Barrier<double>> supports, geometry::Vector,
                     const Barrier<double>* except);

/// How far a step may lead where there are walls: through a bounded table a thousand times, as it
/// would hit them about as often; on a lattice to the next cell.
double longest_way(const Table&);

}  // namespace carom::events
