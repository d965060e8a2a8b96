#include "carom/integrators/make_stepper.hpp"

#include <limits>

#include "carom/integrators/scheme.hpp"
#include "integrators/arkode_stepper.hpp"
#include "integrators/cvode_stepper.hpp"
#include "integrators/splitting.hpp"
#include "integrators/spreiter_walter.hpp"

namespace carom {

using namespace integrators;

std::unique_ptr<Stepper<double>> make_stepper(const IntegratorPlan& plan,
                                              const ForceLaw<double>& law,
                                              std::span<const double> omega) {
  check_plan(plan);
  check_step(plan);
  const double tolerance = plan.tolerance > 0.0 ? plan.tolerance : default_tolerance;
  if (plan.scheme == "arkode") return std::make_unique<ArkodeStepper>(law, omega, tolerance);
  const double longest = plan.step > 0.0 ? plan.step : std::numeric_limits<double>::infinity();
  if (plan.scheme == "cvode") return std::make_unique<CvodeStepper>(law, omega, tolerance, longest);
  const Scheme& scheme = find_scheme(plan.scheme);
  if (scheme.form == Scheme::Form::spreiter_walter) {
    return std::make_unique<SpreiterWalterStepper<double>>(law, omega);
  }
  return std::make_unique<SplittingStepper<double>>(scheme, law, omega);
}

}  // namespace carom
