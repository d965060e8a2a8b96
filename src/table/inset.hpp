// The table as the centre of a disc sees it.
#pragma once

#include "carom/table/table.hpp"

namespace carom::table {

/// The curves at the distance `radius` from the walls, on the domain's side: where centres of discs
/// are when they touch. Wall k of the result belongs to wall k of the table, and holes keep their
/// numbers: a disc leaves where it would touch the wall within the hole. Built for walls that are
/// segments and circular arcs whose joints are smooth or convex corners between segments, and for
/// full circles: there the curve at a distance is of the same kind. Throws InputError, naming the
/// wall, for others and where the disc does not fit.
Table inset_table(const Table& table, double radius);

/// The parameter on a wall of the table of the point that a disc touches whose centre is at u of
/// the moved wall, at `centre`.
double touched_parameter(const Wall& wall, double u, geometry::Vector centre);

}  // namespace carom::table
