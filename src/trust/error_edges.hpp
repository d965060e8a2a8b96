// The two edges of a beam of orbits: what the engine does with them tells whether an error can
// change a decision.
#pragma once

#include "carom/events/decisions.hpp"
#include "carom/events/event.hpp"
#include "carom/motion/state.hpp"
#include "carom/motion/tangent.hpp"
#include "events/flight/next_hit.hpp"

namespace carom::trust {

/// Flies neighbours of an orbit from one event to the next, deciding as the engine does.
class ErrorEdges {
 public:
  explicit ErrorEdges(const Table& table) : table_(table), finder_(table) {}

  /// The wall that was hit, the cell of its copy and the point there.
  struct Arrival {
    int wall = -1;
    geometry::Cell cell;
    geometry::Vector position;
  };

  /// Does the orbit that deviates by d from `start` arrive at the same copy of the same wall, not
  /// farther than `farthest` from there, beside its holes, and after at most `latest`?
  bool same_arrival(const Particle&, const State& start, const Deviation& d, const Arrival&,
                    double farthest, double latest);
  /// Is that certain without a flight, if the error of the point is so small? A straight flight in
  /// a convex table that arrives between the joints of a wall has met no other.
  bool surely_same_arrival(const Particle&, const HitEvent&, double error) const;
  /// Does it leave through that hole?
  bool same_hole(const Particle&, const State& start, const Deviation& d, int hole, double latest);

 private:
  bool begin(const Particle&, const State& start, const Deviation& d, events::Flight& flight);
  bool land(const Particle&, const State& start, const Deviation& d, double latest,
            events::PieceTable::Landing& landing);

  const Table& table_;
  events::HitFinder finder_;
  DecisionCounts counts_;
};

}  // namespace carom::trust
