// Periodic orbits against closed forms and published values.
#pragma once

#include <vector>

#include "validation/cases/cases.hpp"

namespace carom::validation {

/// Adds the cases of carom orbit.
void add_orbit_cases(std::vector<Case>&);

}  // namespace carom::validation
