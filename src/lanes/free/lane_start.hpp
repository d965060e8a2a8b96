// Where a lane may begin, and the numbers that it begins with.
#pragma once

#include "carom/lanes/lanes.hpp"
#include "events/flight/piece_table.hpp"
#include "lanes/free/kernels.hpp"

namespace carom::lanes {

// The side of a joint, of a cell's edge and what is under a root err by 2^-44 of S =
// LaneTable::size, times the speed s, or S again. In these units signs are certain beyond this, 2^5
// times the error or more (docs/developer/lanes.md derives all margins).
inline constexpr double side_margin = 0x1p-36;

inline Turn turn_of(double omega) {
  return omega > 0.0 ? Turn::clockwise : omega < 0.0 ? Turn::counter_clockwise : Turn::straight;
}
/// Squares and products of four such numbers are far from the ends of the doubles' range.
inline bool moderate(double x) { return x > 1e-30 && x < 1e30; }

/// May lanes fly from this state? Not from a joint, nor along a wall, nor from beyond the lengths
/// that margins are measured by. Puts the position on its wall where it is another one, as
/// World::add does.
bool can_start(const LaneTable&, const events::PieceTable&, LaneStart&);

/// A flight whose next disc is looked up begins anew.
inline void look_again(LanePack& pack, int lane) {
  pack.aside[lane] = pack.aside_home[lane];
  pack.passed_cell[lane] = 0;
}

/// All numbers of a lane but whether it is active.
void put_into(LanePack&, int lane, const LaneTable&, const LaneStart&);

/// The same of the particle in a lane of another pack, after its last hit there. Not on a lattice.
void move_into(LanePack&, int lane, const LaneTable&, const Particle&, const LanePack& from,
               int other);

}  // namespace carom::lanes
