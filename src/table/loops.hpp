// The loops that a table's walls form.
#pragma once

#include <cstddef>
#include <vector>

#include "carom/geometry/region.hpp"
#include "carom/table/table.hpp"

namespace carom::table {

/// The walls of each loop, in order, from its first wall of the list on.
std::vector<std::vector<int>> wall_loops(const Table&);
/// Their curves, with their names.
geometry::Loop curves_of(const Table&, const std::vector<int>& loop);
/// What is wrong with the region that all of them bound, at most `limit` faults.
std::vector<geometry::RegionFault> faults_of(const Table&, std::size_t limit);

}  // namespace carom::table
