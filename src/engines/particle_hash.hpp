// What one particle of a trajectory adds to the digest of its ensemble.
#pragma once

#include <cstdint>
#include <span>

#include "carom/base/digest.hpp"
#include "carom/system/system.hpp"

namespace carom::engines {

using carom::mix;

/// The bits of a state: where in the plane, how fast and when it is. Not the wall: that of a
/// particle in a step is none.
inline std::uint64_t mix(std::uint64_t so_far, const State& state) {
  for (const std::int64_t number : {state.cell.first, state.cell.second})
    so_far = mix(so_far ^ static_cast<std::uint64_t>(number));
  for (const double value : {state.position.x, state.position.y, state.velocity.x, state.velocity.y,
                             state.time.high, state.time.low})
    so_far = mix(so_far, value);
  return so_far;
}

/// The hash of a free particle contains its end and its number of hits. A particle under forces, or
/// a disc among others, may never hit a wall: its hash also contains the state after its last event
/// and its samples.
class ParticleHash {
 public:
  explicit ParticleHash(const System& system)
      : of_states_(system.is_integrated() || system.of_discs()) {}

  bool of_states() const { return of_states_; }
  /// `end_time`: t_max of survivors; `state`: after the last event; `samples`: at the report times
  /// before the end.
  std::uint64_t operator()(std::uint64_t index, Fate fate, double end_time, std::uint64_t hits,
                           int last_wall, const State& state,
                           std::span<const double> samples = {}) const {
    std::uint64_t h =
        trajectory_hash(index, static_cast<std::uint64_t>(fate), end_time, hits, last_wall);
    if (!of_states_) return h;
    h = mix(h, state);
    for (const double sample : samples) h = mix(h, sample);
    return h;
  }

 private:
  bool of_states_;
};

}  // namespace carom::engines
