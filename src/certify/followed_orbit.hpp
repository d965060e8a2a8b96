// What a certified orbit is followed by: along walls of segments and conics, or among curves.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include "carom/certify/certified_orbit.hpp"
#include "certify/enclosure/state_enclosure.hpp"
#include "certify/number/enclosure_of.hpp"

namespace carom::certify {

/// As CertifiedOrbit's functions of these names.
class FollowedOrbit {
 public:
  virtual ~FollowedOrbit() = default;
  virtual std::optional<CertifiedHit> next() = 0;
  virtual const CertifiedEnd& end() const = 0;
  virtual const CertifiedEffort& effort() = 0;
};

/// Where walls are curves, without a lattice.
std::unique_ptr<FollowedOrbit> orbit_among_curves(const ExactSystem&, const CertifiedTask&,
                                                  std::function<bool()> interrupted);

inline void fill(CertifiedState& state, BallState s) {
  state.t = number_of(std::move(s.time));
  state.x = number_of(std::move(s.position.x));
  state.y = number_of(std::move(s.position.y));
  state.vx = number_of(std::move(s.velocity.x));
  state.vy = number_of(std::move(s.velocity.y));
}

}  // namespace carom::certify
