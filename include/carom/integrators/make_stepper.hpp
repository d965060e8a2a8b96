// From the plan of the system file to a stepper.
#pragma once

#include <memory>
#include <span>

#include "carom/integrators/plan.hpp"
#include "carom/integrators/stepper.hpp"

namespace carom {

/// `omega`: one entry a particle. Refers to `law` and `omega`, which must outlive the stepper.
std::unique_ptr<Stepper<double>> make_stepper(const IntegratorPlan&, const ForceLaw<double>& law,
                                              std::span<const double> omega);

}  // namespace carom
