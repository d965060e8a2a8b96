// The cases of carom validate: systems, published values, sizes.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "validation/cases/checks.hpp"

namespace carom::validation {

struct Case {
  std::string name, source;
  Allowance allowance;  ///< beside four standard errors
  std::function<Check(const CheckOptions&)> run;
};

/// `scale` multiplies the number of trajectories of each case.
std::vector<Case> all_cases(bool soak, double scale);

/// Equilibria of potential energies.
void add_equilibria(std::vector<Case>&);

}  // namespace carom::validation
