// Names of what integration has cost, in archives.
#pragma once

#include <cstdint>

#include "carom/events/step_counts.hpp"

namespace carom::io {

struct StepNumber {
  const char* name;
  std::uint64_t StepCounts::*value;
  const char* text;
};
inline constexpr StepNumber step_numbers[] = {
    {"steps", &StepCounts::steps, "Steps and parts of steps"},
    {"force_evaluations", &StepCounts::force_evaluations, "Evaluations of the forces"},
    {"unresolved_steps", &StepCounts::unresolved,
     "Steps longer than the forces they swept allow, which were counted"},
};
inline constexpr const char* first_unresolved = "first_unresolved";
/// Of a run: from where it counts further.
inline constexpr const char *going_on = "evaluations_going_on", *predicted = "predicted";

}  // namespace carom::io
