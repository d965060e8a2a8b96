// The cases of carom validate: systems, published values, sizes.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "carom/ensemble/validation.hpp"

namespace carom::cli {

struct PlannedCase {
  std::string name, source;
  Allowance allowance;  ///< beside four standard errors
  std::function<ValidationCase(const ValidationOptions&)> run;
};

/// `scale` multiplies the number of trajectories of each case.
std::vector<PlannedCase> planned_cases(bool soak, double scale);

}  // namespace carom::cli
