// From a start to an equilibrium, by a trust region and Newton's method.
#pragma once

#include <functional>
#include <optional>

#include "analyses/relax/landscape.hpp"
#include "carom/events/world.hpp"

namespace carom::analyses {

/// Where all slopes vanish, to rounding.
struct Rest {
  Sites sites;
  Shape shape;
  double last_step = 0.0;  ///< of Newton's method: the error of a coordinate
};

/// Asked now and then; true: stop, nothing is found.
using Stopped = std::function<bool()>;

/// Downhill from `start` by a trust region, along walls where the forces press particles on them;
/// then to rounding by Newton's method. Empty where the energy falls for ever.
std::optional<Rest> downhill(const Landscape&, const World&, Sites start, const Stopped&);

/// To a place without slopes of any kind, saddles too, by Powell's hybrid method. Empty where it
/// comes to none, or to one outside the table; walls hold nothing here.
std::optional<Rest> level(const Landscape&, const World&, Sites start, const Stopped&);

/// Particles that are outside now are put on the wall that they went through. Were there any?
bool keep_inside(const Landscape&, const World&, const Sites& before, Sites& now);

/// Particles beyond the end of their wall are put there, and where the force pushes them on, on the
/// next wall, or in the corner if that one does not let them go along it. Were there any?
bool turn_corners(const Landscape&, Sites&);

/// Lets the particle go that its force pulls most off its wall, or out of its corner along a wall;
/// false if none is pulled by more than `least`.
bool release_one(const Landscape&, Sites&, double least);

}  // namespace carom::analyses
