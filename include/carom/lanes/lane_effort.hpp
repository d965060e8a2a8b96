// What lanes did, and what they left to the scalar engine.
#pragma once

#include <cstdint>

#include "carom/base/fields.hpp"

namespace carom {

/// Counts of what lanes did.
struct LaneEffort {
  std::uint64_t hits = 0;    ///< decided and made in lanes
  std::uint64_t scalar = 0;  ///< hits and ends left to the scalar engine
  std::uint64_t steps = 0;   ///< of single lanes, those included …
  std::uint64_t idle = 0;    ///< … that stood idle

  /// Share of lane steps in which a trajectory was under way.
  double busy() const {
    return steps > 0 ? static_cast<double>(steps - idle) / static_cast<double>(steps) : 0.0;
  }
  /// Share of events that lanes did not decide.
  double left() const {
    return hits + scalar > 0 ? static_cast<double>(scalar) / static_cast<double>(hits + scalar)
                             : 0.0;
  }
  LaneEffort& operator+=(const LaneEffort& o) {
    hits += o.hits;
    scalar += o.scalar;
    steps += o.steps;
    idle += o.idle;
    return *this;
  }
  friend LaneEffort operator-(const LaneEffort& a, const LaneEffort& b) {
    return {a.hits - b.hits, a.scalar - b.scalar, a.steps - b.steps, a.idle - b.idle};
  }
};

/// Attributes of /provenance.
template <>
struct Fields<LaneEffort> {
  using E = LaneEffort;
  static constexpr std::tuple list{
      field("lanes_hits", "1", "Hits decided and made in lanes", &E::hits),
      field("lanes_left", "1", "Hits and ends left to the scalar engine", &E::scalar),
      field("lanes_steps", "1", "Steps of single lanes", &E::steps),
      field("lanes_idle", "1", "Steps of lanes that were idle", &E::idle)};
};

}  // namespace carom
