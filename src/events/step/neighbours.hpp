// Interactions of finite range: which bodies are near each other, and are integrated together.
#pragma once

#include <limits>
#include <vector>

#include "carom/events/dynamics.hpp"
#include "carom/table/table.hpp"
#include "events/bodies.hpp"
#include "events/step/groups.hpp"

namespace carom::events {

/// Two free particles a distance d apart cannot come within the range R before (d - R)/(v_1 + v_2),
/// for nothing makes a free particle faster: each looks around again then. A group looks around at
/// the end of each of its steps, which all groups take at the same times. Whatever could come
/// within the range during the next step is taken into a group beforehand: to integrate a pair
/// beyond its range is as right as to leave it alone, since either errs by less than the tail's
/// bound. A group falls apart where its members have twice that distance from each other.
class Neighbours {
 public:
  Neighbours(const Table& table, const Dynamics& dynamics, const Bodies& bodies,
             const Groups& groups)
      : table_(table), dynamics_(dynamics), bodies_(bodies), groups_(groups) {}

  struct Found {
    std::vector<int> members;
    /// How long the first member has no free particle within its range, if none was added.
    double free_for = std::numeric_limits<double>::infinity();
  };
  /// Adds to `members`, which are at `now`, all bodies that could come within the range of one of
  /// them during the next step, and again those that are near these. No group's step may end at
  /// `now`: its bodies would be somewhere else.
  Found around(std::vector<int> members, const Time& now) const;
  /// The parts of a group that are far from each other.
  std::vector<std::vector<int>> parts(const std::vector<int>& members) const;

 private:
  double gap(geometry::Vector x, geometry::Vector y) const;

  const Table& table_;
  const Dynamics& dynamics_;
  const Bodies& bodies_;
  const Groups& groups_;
};

}  // namespace carom::events
