#include "carom/integrators/make_stepper.hpp"

#include "carom/integrators/scheme.hpp"
#include "integrators/splitting.hpp"
#include "integrators/spreiter_walter.hpp"

namespace carom {

std::unique_ptr<Stepper<double>> make_stepper(const IntegratorPlan& plan, const ForceLaw<double>& law,
                                              std::span<const double> omega) {
  const Scheme& scheme = find_scheme(plan.scheme);
  if (!(plan.step > 0.0)) {
    throw InputError({"", 0, 0, "integrator.step"},
                     "the scheme '" + std::string(scheme.name) + "' needs a step",
                     "a time > 0; or an adaptive scheme, arkode or cvode, with a tolerance");
  }
  if (scheme.form == Scheme::Form::spreiter_walter) {
    return std::make_unique<SpreiterWalterStepper<double>>(law, omega);
  }
  return std::make_unique<SplittingStepper<double>>(scheme, law, omega);
}

}  // namespace carom
