// Which piece a straight flight from another one meets first, decided by the sides of all joints
// alone.
//
// The directed lines that have given joints on their left and the others on their right are a
// convex set, so any two of them can be moved into each other without passing a joint. On the way
// what a flight crosses can change only where it touches an arc from the domain's side: never, if
// all arcs bulge out of it. So flights from one piece with the same joints on their right leave by
// the same piece, and one of them tells (docs/developer/lanes.md).
#pragma once

#include "carom/geometry/vector.hpp"
#include "lanes/free/lane_table.hpp"

namespace carom::lanes {

/// Do the sides of the joints tell? Makes the table of answers, all unknown.
void prepare_exits(LaneTable&);

/// The entry of flights from a piece; -1 if a joint is within `margin` of velocity times distance.
int entry_of(const LaneTable&, int start, geometry::Vector position, geometry::Vector velocity,
             double margin);

}  // namespace carom::lanes
