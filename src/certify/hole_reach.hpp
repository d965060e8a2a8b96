// Does a hole begin or end where its wall does? Decided by the numbers as they were written.
#pragma once

#include "carom/certify/exact_system.hpp"
#include "certify/wall.hpp"

namespace carom::certify {

/// Signs; undecided where neither balls of 2^14 bits nor algebra tell.
struct HoleReach {
  Sign before_start = Sign::undecided;  ///< of the arc length at which the hole starts
  Sign past_end = Sign::undecided;      ///< of that at which it ends, less the wall's length

  bool opens_at_start() const { return before_start == Sign::zero || before_start == Sign::negative; }
  bool opens_at_end() const { return past_end == Sign::zero || past_end == Sign::positive; }
};

HoleReach reach_of(const ExactSystem&, const HoleSpec&);

/// Is the hole all of its wall? Of a closed one it is if it is as wide, wherever it begins.
bool is_all_of_its_wall(const ExactSystem&, const HoleSpec&, const WallOf<Ball>&);

}  // namespace carom::certify
