// How an orbit ends between two hits: out through a hole, or at the last time.
#pragma once

#include "certify/tangent.hpp"

namespace carom::certify {

/// The velocity that a particle came with, which is `after` once it was reflected at P.
template <class N>
VectorOf<N> before_reflection(const WallOf<N>& w, const VectorOf<N>& P, const VectorOf<N>& after) {
  const VectorOf<N> t = tangent_of(w, P);
  const N twice = N(2) * dot(after, t);
  return {twice * t.x - after.x, twice * t.y - after.y};
}

/// Position and velocity after a time without hits.
template <class N>
void fly_for(const N& time, VectorOf<N>& position, VectorOf<N>& velocity, const MotionOf<N>& motion) {
  if (!motion.turns) {
    position = {position.x + time * velocity.x, position.y + time * velocity.y};
    return;
  }
  const LandingOf<N> there = larmor_state_after<N>(time, position, velocity, motion.half_omega);
  position = there.position;
  velocity = there.velocity;
}

}  // namespace carom::certify
