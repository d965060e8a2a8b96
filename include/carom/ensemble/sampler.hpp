// Initial states of trajectories, a function of (seed, trajectory, particle) alone.
#pragma once

#include <cstdint>

#include "carom/ensemble/system.hpp"
#include "carom/events/world.hpp"

namespace carom {

/// Draws the initial state of particle `particle` of trajectory `trajectory`. `world` answers which
/// points lie in the domain. Throws InputError when the initial condition is impossible (point
/// outside the table, a velocity that leaves it).
State draw_initial_state(const System&, const World& world, std::uint64_t trajectory, int particle);

}  // namespace carom
