// What integration has cost, and whether its steps resolved the forces they crossed.
#pragma once

#include <algorithm>
#include <cstdint>

#include "carom/base/fields.hpp"

namespace carom {

/// Counts of integrated motion; parts of an ensemble are added.
struct StepCounts {
  std::uint64_t steps = 0;  ///< steps and parts of steps that were taken, each for a whole group
  std::uint64_t force_evaluations =
      0;  ///< of one particle's force, or of all forces in a group, each counted once
  std::uint64_t unresolved =
      0;  ///< steps longer than the forces they swept allow (unresolved = "count")
  double first_unresolved = 0.0;  ///< time at which the earliest of them began; 0 if there is none
  std::uint64_t halved = 0;  ///< of `steps`: parts of steps that were halved (unresolved = "halve")
  double shortest_part = 0.0;  ///< the plan's step over a power of two, of the shortest; 0: none

  StepCounts& operator+=(const StepCounts& o) {
    if (o.unresolved > 0)
      first_unresolved =
          unresolved > 0 ? std::min(first_unresolved, o.first_unresolved) : o.first_unresolved;
    steps += o.steps;
    force_evaluations += o.force_evaluations;
    unresolved += o.unresolved;
    if (o.halved > 0)
      shortest_part = halved > 0 ? std::min(shortest_part, o.shortest_part) : o.shortest_part;
    halved += o.halved;
    return *this;
  }
};

template <>
struct Fields<StepCounts> {
  using S = StepCounts;
  static constexpr std::tuple list{
      field("steps", "1", "Steps and parts of steps", &S::steps),
      field("force_evaluations", "1", "Evaluations of the forces", &S::force_evaluations),
      field("unresolved_steps", "1", "Steps too long to resolve the forces", &S::unresolved),
      field("halved_steps", "1", "Parts of halved steps", &S::halved),
      field("first_unresolved", "time", "Start of the earliest unresolved step",
            &S::first_unresolved),
      field("shortest_step", "time", "The shortest part of a halved step; 0: none",
            &S::shortest_part)};
};

/// Evaluations of the forces that a trajectory which goes on makes again: for states within the
/// steps under way.
struct StepsUnderWay {
  std::uint64_t evaluations = 0;
  bool predicted = true;  ///< not those of the steps themselves; false: an interrupt dropped these
};

}  // namespace carom
