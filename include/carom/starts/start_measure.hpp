// By which measure starts are distributed. Averages over time are those of the flow from the first
// moment on only where starts have its invariant measure.
#pragma once

#include <string>

#include "carom/system/system.hpp"

namespace carom {

/// Why the starts are not distributed by an invariant measure of the flow, as a phrase about them;
/// "" where they are. They are where positions are uniform in all that particles can reach and
/// directions uniform, for then
///
///   (1) free particles, with or without a magnetic field, keep dx dy d(angle) at each speed;
///   (2) a particle of one energy under potentials keeps delta(E - H) d^2x d^2p = m d^2x d(angle);
///   (3) so do several that do not act on each other, and quasi-random starts in the mean.
///
/// Particles that act on each other start with equal kinetic energies, or with given speeds: with
/// two of them that is not the microcanonical ensemble any more. Where particles leave, those that
/// stay have no invariant measure of starts that could be drawn.
std::string why_not_stationary(const System&);
/// The part of this that is due to walls and regions: why they do not keep uniform positions and
/// directions of free particles, "" if they do. Whether a formula for `reflection` has a detailed
/// balance is decided by its values at 63 angles.
std::string why_not_uniform(const System&);

/// Do free particles start from all walls of a closed table by the cosine law? That is the natural
/// measure of the map from hit to hit. Along the flow it counts each flight once, and time counts
/// it by its duration.
bool starts_of_the_map(const System&);

/// The same system with uniform starts where they are those of the map: what they turn into, if the
/// map's orbits are weighted by time. (In a magnetic field uniform starts are also on circles that
/// meet no wall; no orbit from a wall is.)
System with_starts_of_the_flow(System);

}  // namespace carom
