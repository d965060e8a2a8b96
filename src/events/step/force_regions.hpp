// The parts of the plane where particles are integrated, and which particles are so together.
#pragma once

#include <vector>

#include "carom/events/dynamics.hpp"
#include "carom/geometry/vector.hpp"
#include "carom/table/table.hpp"
#include "events/step/barrier.hpp"

namespace carom::events {

/// The table with a circle for the edge of each support, whose outside is the domain of free
/// flights: where a flight meets one, integration takes over. Without walls where free flights
/// never occur or nothing has a finite support.
Table table_with_supports(const Table& table, const Dynamics& dynamics);

/// The regions where forces act.
class ForceRegions {
 public:
  /// `walls`: the table of free flights, which begins with the walls of `table`. Throws InputError.
  ForceRegions(const Table& table, const Table& walls, const Dynamics& dynamics);

  /// Is anything ever integrated?
  bool any() const { return any_; }
  /// Do particles interact at any distance? Then all of them are one group.
  bool one_group() const { return one_group_; }
  /// Do they interact within a range? Then groups merge and split.
  bool by_range() const { return by_range_; }
  bool interact() const { return one_group_ || by_range_; }

  /// Is that wall of free flights the edge of a support?
  bool is_edge(int wall) const { return wall >= wall_count_; }
  /// How many walls are none: those of the user's table.
  int wall_count() const { return wall_count_; }
  /// The edges of supports and their copies on a lattice. Inside is positive.
  const std::vector<Barrier<double>>& edges() const { return edges_; }
  /// Is a particle integrated there? On an edge to rounding, too.
  bool hold(geometry::Vector x) const;

 private:
  int wall_count_;
  bool any_, everywhere_;
  bool one_group_ = false, by_range_ = false;
  std::vector<Barrier<double>> edges_;
};

}  // namespace carom::events
