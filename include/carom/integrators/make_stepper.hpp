// From the plan of the system file to a stepper.
#pragma once

#include <memory>
#include <span>

#include "carom/integrators/plan.hpp"
#include "carom/integrators/stepper.hpp"

namespace carom {

/// `omega`: one entry a particle. Refers to `law`, which must outlive the stepper and always give
/// the same accelerations for the same positions: those at the ends of steps are remembered. An
/// InputError if the scheme is unknown, or needs a step or tolerance that the plan does not have.
std::unique_ptr<Stepper<double>> make_stepper(const IntegratorPlan&, const ForceLaw<double>& law,
                                              std::span<const double> omega);

}  // namespace carom
