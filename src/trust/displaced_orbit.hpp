// How errors of an orbit grow: the same orbit from a start beside its own.
#pragma once

#include "carom/events/world.hpp"
#include "carom/system/system.hpp"

namespace carom::trust {

/// The share of positions and velocities by which the start is displaced: far above what rounding
/// does to them, and far below what a run can be believed with.
inline constexpr double displacement = 0x1p-40;
/// Each evaluation of a force, and the sums made with it, displace a run by about so much of its
/// size, in directions of their own.
inline constexpr double rounding_of_evaluation = 0x1.8p-50;

/// The size of positions: the table's or the cell's; in the plane that of the positions of the
/// world's particles now, and where all are at the origin the way of the fastest in `time`.
double size_of_positions(const System&, const World&, double time);

/// Adds the particles of another world, displaced; undisplaced where walls are too near.
void add_displaced(World&, const World& others, double size);

}  // namespace carom::trust
