// The trajectories under way, one array a quantity, indexed by lane; and the kernel that flies each
// of them to its next hit.
#pragma once

#include "lanes/free/lane_table.hpp"

namespace carom::lanes {

/// What a lane waits for.
enum class Call : unsigned char {
  none,
  undecided,  ///< a decision that the scalar engine must take; nothing has changed
  over,  ///< the next hit, at the time in `met`, comes after `until`; nothing has changed but which
         ///< disc was looked for
  escaped,    ///< `met` holds the piece, a hole, and the time; nothing has changed
  unbounded,  ///< no wall follows; nothing has changed
  capped      ///< its last hit is made
};

struct LanePack {
  static constexpr int lanes = 64;

  // A load waits for a store before it whose address has the same last twelve bits. With arrays
  // like this no stage loads what seems to be stored in the register before.
  static constexpr int alignment = lanes * sizeof(double);

  alignas(alignment) double x[lanes] = {};
  double y[lanes] = {}, vx[lanes] = {}, vy[lanes] = {};
  double high[lanes] = {}, low[lanes] = {};  ///< time
  double piece[lanes] = {};                  ///< that it is on; -1: none
  double born[lanes] = {};                   ///< the sweep at which it would have had no hits
  // On a lattice: the cell of the last hit, and the cell of the flight, counted from there.
  double home_first[lanes] = {}, home_second[lanes] = {}, cell_first[lanes] = {},
         cell_second[lanes] = {};
  // Constants of its particle.
  double speed[lanes] = {}, square_speed[lanes] = {}, shell_weight[lanes] = {},
         shell_rest[lanes] = {};
  double sides[lanes] = {};     ///< margins of signs of the sizes size * speed …
  double roots[lanes] = {};     ///< … and of its square;
  double order[lanes] = {};     ///< of two times
  double shortest[lanes] = {};  ///< flight along a circle that ends by such a sign
  // Of flights that are looked up (next_disc_table.hpp): LaneTable::directions_per_unit and
  // offsets_per_length over the speed; cut_within, cut_within_far and passed_beyond times it; the
  // side v x (centre - start) of the disc it began on, and of the one it passes now; and the cell
  // of that one, counted from home, twice, in four signed bytes.
  double directions[lanes] = {}, offsets[lanes] = {}, cut[lanes] = {}, cut_far[lanes] = {},
         passed[lanes] = {};
  double aside_home[lanes] = {}, aside[lanes] = {};
  alignas(64) unsigned passed_cell[lanes] = {};
  int cells[2 * lanes] = {};  ///< of hits, since home_first and home_second were written
  double omega[lanes] = {};
  double inverse_half[lanes] = {};  ///< 1/|omega/2|
  double pace[lanes] = {};          ///< power of two beyond speed + |omega| size
  double joint_margin[lanes] = {};  ///< of |c|^2 - v^2 (larmor.hpp)
  double active[lanes] = {};        ///< 1, or 0 for a lane without a trajectory
  double until[lanes] = {};         ///< the end of the run, or the next report time

  double end = 0.0;    ///< of the run
  double limit = 0.0;  ///< of hits

  // A lane's hits are the sweeps since it was born: a sweep without a hit makes it a sweep younger.
  double sweep = 0.0;
  double next_cap = 0.0;  ///< no lane has all its hits before this sweep
  double hits(int i) const { return sweep - born[i]; }

  int used = lanes;  ///< lanes beyond are not looked at

  // A bit for each lane that began off the discs and goes from cell to cell to its first one
  // (next_disc.hpp); and where it does.
  static constexpr int fewest_searching = 8, longest_wait = 16;
  unsigned long long searching = 0;
  LanePack* search_pack = nullptr;

  int calls = 0;
  int lane[lanes] = {};  ///< of each call
  Call call[lanes] = {};
  struct Met {
    double piece = 0.0, high = 0.0, low = 0.0;
  } met[lanes] = {};  ///< of each call
};

/// Flies every active lane to its next hit and reflects it there, or leaves a call.
using Advance = void (*)(const LaneTable&, LanePack&);

}  // namespace carom::lanes
