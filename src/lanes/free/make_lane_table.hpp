// Makes a table ready for lanes.
#pragma once

#include <cmath>
#include <string>

#include "carom/table/table.hpp"
#include "events/flight/piece_table.hpp"
#include "lanes/free/lane_table.hpp"

namespace carom::lanes {

/// Why the pieces of this table cannot be held by a LaneTable, "" where they can. `reach`: how far
/// flights get from where they began. On a lattice, where that is finite, so must those of all
/// cells that they may come to.
std::string misfit(const Table&, double reach = HUGE_VAL);
LaneTable make_lane_table(const events::PieceTable& walls, double reach = HUGE_VAL);
/// The piece on which the point u of a wall lies.
int piece_at(const LaneTable&, int wall, double u);

/// Larmor circles: of an arc so short that rounding turns its chord the sides are not certain, so
/// nothing is.
void leave_short_arcs(LaneTable&);

}  // namespace carom::lanes
