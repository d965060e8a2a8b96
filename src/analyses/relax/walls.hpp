// Hard walls that hold particles: which particles are on them, and in which corners.
#pragma once

#include "analyses/relax/landscape.hpp"
#include "carom/events/world.hpp"

namespace carom::analyses {

/// Particles that are outside now are put on the wall that they went through. Were there any?
bool keep_inside(const Landscape&, const World&, const Sites& before, Sites& now);

/// Particles beyond the end of their wall are put there, and where the force pushes them on, on the
/// next wall, or in the corner if that one does not let them go along it. Were there any?
bool turn_corners(const Landscape&, Sites&);

/// Lets the particle go that its force pulls most off its wall, or out of its corner along a wall;
/// false if none is pulled by more than `least`.
bool release_one(const Landscape&, Sites&, double least);

}  // namespace carom::analyses
