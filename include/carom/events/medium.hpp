// What a particle is in a region of a table.
#pragma once

#include "carom/motion/state.hpp"
#include "carom/table/table.hpp"

namespace carom {

/// The particle as it flies in that region (-1: outside of all, as it is): its speed, 0 where the
/// potential is too high for it, and its Larmor frequency.
Particle in_region(const Table&, const Particle& outside, int region);

/// The length of the momentum there, outside of all regions 1: the refractive index. That of a
/// potential is the ratio of the speeds.
double momentum_in(const Table&, const Particle& outside, int region);

}  // namespace carom
