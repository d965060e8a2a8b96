// What happens to a member of a group at a wall.
#pragma once

#include <cstddef>
#include <vector>

#include "carom/events/decisions.hpp"
#include "carom/motion/state.hpp"
#include "carom/table/table.hpp"
#include "events/flight/piece_table.hpp"
#include "events/step/group.hpp"

namespace carom::events {

struct GroupHit {
  State state;  ///< on the wall; its velocity is that after the hit, or, if it escapes, before
  geometry::Vector before;
  int hole = -1;       ///< through which it escapes
  bool inward = true;  ///< else the reflected velocity does not point into the domain
};
/// A member has come to a barrier, which is a wall. `finder` finds that table's walls.
GroupHit hit_of(const PieceTable& pieces, const Table&, const Group&, std::size_t member,
                const Barrier<double>&, DecisionCounts&);

/// Is the point on one of the first `walls` walls, to rounding?
bool on_some_wall(const std::vector<Barrier<double>>&, int walls, geometry::Vector);
/// Does the short way between two points touch one of them, to rounding?
bool meets_some_wall(const std::vector<Barrier<double>>&, int walls, geometry::Vector,
                     geometry::Vector);

}  // namespace carom::events
