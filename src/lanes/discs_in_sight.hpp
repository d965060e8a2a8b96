// Which disc of a lattice a flight from another one meets: a table by its direction and by how far to the side of
// the disc's centre it begins.
//
// The table is made by asking, of all flights of an entry at once, which discs they can cut, in order. Most entries have
// one answer, others two: a disc, and the one behind it for flights that pass it. For few it is open; those
// flights go from cell to cell (docs/developer/lanes.md).
#pragma once

#include <cstdint>
#include <vector>

#include "lanes/lane_table.hpp"

namespace carom::lanes {

/// The entries, where LaneTable::sights then points to, and all numbers there that lead to them: for a cell with one disc and nothing
/// else in it. Empty where too many would be open, as among small discs.
std::vector<std::uint32_t> discs_in_sight(LaneTable&);

}  // namespace carom::lanes
