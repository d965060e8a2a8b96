// From a system to a world, and to trajectories that an observer follows.
#pragma once

#include "carom/events/decisions.hpp"
#include "carom/events/observer.hpp"
#include "carom/events/world.hpp"
#include "carom/results/trajectory_ranges.hpp"
#include "carom/system/system.hpp"

namespace carom {

/// A world with the table, the forces, the integrator and the cap on hits of a system; no particles
/// yet. It refers to the system's table, which must live as long.
World make_world(const System&, DecisionOptions = {});
World make_world(System&&, DecisionOptions = {}) = delete;

/// Follows the trajectories of a range one after the other, each from its start until
/// System::run.t_max or the cap on hits, with the particles that enter meanwhile, and samples every
/// System::run.sample. The observer learns of every event, and at last of the end of each particle:
/// also of those that survive, in the order of their numbers. Throws InputError where the initial
/// condition is impossible.
void for_each_trajectory(const System&, TrajectoryRange, Observer&);

}  // namespace carom
