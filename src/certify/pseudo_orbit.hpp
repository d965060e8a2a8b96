// One hit after another in plain arithmetic, which is taken at its word: no errors are carried.
#pragma once

#include "certify/scene.hpp"

namespace carom::certify {

template <class N>
struct PseudoState {
  VectorOf<N> position, velocity;  ///< in the cell of the last hit
  N time{};
  int standing = -1;
  geometry::Cell cell;
};

/// Flies to the wall. The landing is put back to its speed, and on the circle that it stayed on, by one Newton
/// step each: otherwise the errors of both feed each other.
template <class N>
void fly_to(const SceneOf<N>& scene, const Copy& copy, PseudoState<N>& s) {
  const WallOf<N>& wall = scene.walls[static_cast<std::size_t>(copy.wall)];
  const bool same = copy.wall == s.standing && copy.cell == geometry::Cell{};
  if (!(copy.cell == geometry::Cell{})) {
    s.position = s.position - scene.translation(copy.cell);
    s.cell = {s.cell.first + copy.cell.first, s.cell.second + copy.cell.second};
  }
  const LandingOf<N> landing = fly<N, N>(wall, s.position, s.velocity, scene.motion, same);
  const N half(0.5);
  const N stretch =
      half * (scene.motion.speed2 - dot(landing.velocity, landing.velocity)) * scene.motion.inverse_speed2;
  s.velocity = landing.velocity + stretch * landing.velocity;
  s.position = landing.position;
  if (same && wall.form == Form::circle) {
    const VectorOf<N> e = s.position - wall.centre;
    s.position = s.position + (half * (wall.radius2 - dot(e, e)) / wall.radius2) * e;
  }
  s.time = s.time + landing.time;
  s.standing = copy.wall;
}

}  // namespace carom::certify
