// Names of what integration has cost, in archives.
#pragma once

#include <cstdint>

#include "carom/events/step_counts.hpp"

namespace carom::io {

struct StepNumber {
  const char* name;
  std::uint64_t StepCounts::*value;
  const char* text;
  bool later = false;  ///< archives of earlier versions lack it
};
inline constexpr StepNumber step_numbers[] = {
    {"steps", &StepCounts::steps, "Steps and parts of steps"},
    {"force_evaluations", &StepCounts::force_evaluations, "Evaluations of the forces"},
    {"unresolved_steps", &StepCounts::unresolved,
     "Steps longer than the forces they swept allow, which were counted"},
    {"halved_steps", &StepCounts::halved,
     "Parts of steps that were halved until they resolve the forces", true},
};
inline constexpr const char *first_unresolved = "first_unresolved",
                            *shortest_part = "shortest_step";
/// Of a run: from where it counts further.
inline constexpr const char *going_on = "evaluations_going_on", *predicted = "predicted";

}  // namespace carom::io
