// Which disc of a lattice a flight meets that starts on another one, or passes it: a table by its
// direction and its offset, how far to the side of that disc's centre it goes.
//
// The table is made by asking, of all flights of an entry at once, which discs they can cut, in
// order. Most entries have one answer, others two: a disc, and the one behind it for flights that
// pass it. A flight that passes both asks again from the second (docs/developer/lanes.md).
#pragma once

#include <cstdint>
#include <vector>

#include "lanes/free/lane_table.hpp"

namespace carom::lanes {

/// The entries, where LaneTable::next_discs then points to, and all numbers there that lead to
/// them: for a cell with one disc and nothing else in it. Empty where too many would have no
/// answer, as among tiny discs.
std::vector<std::uint32_t> make_next_discs(LaneTable&);

}  // namespace carom::lanes
