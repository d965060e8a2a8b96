// Is a point inside the domain?
#pragma once

#include "events/flight/next_hit.hpp"
#include "events/flight/wall_touch.hpp"

namespace carom::events {

/// A straight flight from a point of the domain meets the boundary from inside first; one from
/// outside meets it from outside first, which is from inside for the table turned inside out. Both
/// first hits are decided exactly; a direction that cannot tell them apart (both at one joint, a
/// start on a wall) is replaced by another.
class Locator {
 public:
  explicit Locator(const Table& table, const DecisionOptions& options = {});
  bool contains(geometry::Vector point);

 private:
  HitFinder domain_, complement_;
  Table bare_;  // the lattice alone
  PieceTable cell_;
  WallTouch touch_;
};

}  // namespace carom::events
