// Can an orbit start here? The table must be the one of the doubles except for rounding, and the
// start inside it as it was written, or on the wall it is said to be on, and moving.
#pragma once

#include "carom/certify/exact_system.hpp"

namespace carom::certify {

/// Throws InputError unless that is proven. A start on a lattice that is too far away to look for
/// walls around it is left to the orbit, and so is one along its wall.
void check_system(const ExactSystem&);
/// Throws InputError where the start's velocity is zero, or cannot be distinguished from it.
void check_velocity(const ExactStart&);

}  // namespace carom::certify
