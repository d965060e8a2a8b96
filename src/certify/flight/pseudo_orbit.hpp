// One hit after another in plain arithmetic, which is taken at its word: no errors are carried.
#pragma once

#include "certify/flight/larmor_flight.hpp"
#include "certify/flight/scene.hpp"

namespace carom::certify {

template <class N>
struct PseudoState {
  VectorOf<N> position, velocity;  ///< in the cell of the last hit
  N time{};
  int standing = -1;
  geometry::Cell cell;
};

/// A point near a circle or ellipse, moved onto it by one Newton step.
template <class N>
VectorOf<N> put_back(const WallOf<N>& w, const VectorOf<N>& P) {
  const N half(0.5);
  const VectorOf<N> e = P - w.centre;
  if (w.form == Form::circle) return P + (half * (w.radius2 - dot(e, e)) / w.radius2) * e;
  const N X = dot(e, w.along), Y = dot(e, w.across);
  const VectorOf<N> normal = X * w.along + Y * w.across;
  return P + (half * (N(1) - (X * X + Y * Y)) / dot(normal, normal)) * normal;
}

/// Flies to the wall. The landing is put back to its speed, and on the circle that it stayed on, by
/// one Newton step each: otherwise the errors of both feed each other.
template <class N>
void fly_to(const SceneOf<N>& scene, const Copy& copy, PseudoState<N>& s) {
  const WallOf<N>& wall = scene.walls[static_cast<std::size_t>(copy.wall)];
  const bool same = copy.wall == s.standing && copy.cell == geometry::Cell{};
  if (!(copy.cell == geometry::Cell{})) {
    s.position = s.position - scene.translation(copy.cell);
    s.cell = {s.cell.first + copy.cell.first, s.cell.second + copy.cell.second};
  }
  const LandingOf<N> landing = flight_to<N, N>(wall, s.position, s.velocity, scene.motion, same);
  const N half(0.5);
  const N stretch = half * (scene.motion.speed2 - dot(landing.velocity, landing.velocity)) *
                    scene.motion.inverse_speed2;
  s.velocity = landing.velocity + stretch * landing.velocity;
  s.position = landing.position;
  if (same && wall.form != Form::segment) s.position = put_back(wall, s.position);
  s.time = s.time + landing.time;
  s.standing = copy.wall;
}

}  // namespace carom::certify
