// In place of SUNDIALS, which the page does not have: its schemes are refused by name.
#pragma once

#include <span>

#include "carom/base/error.hpp"
#include "carom/integrators/stepper.hpp"

namespace carom::integrators {

class SchemeOfProgram : public Stepper<double> {
 public:
  SchemeOfProgram(const ForceLaw<double>&, std::span<const double>, double, double = 0.0) {
    throw InputError({"", 0, 0, "integrator.scheme"},
                     "the page does not have the adaptive schemes, arkode and cvode",
                     "the program carom, or another scheme");
  }
  double step(const Phase<double>&, double at_most, Phase<double>&) override { return at_most; }
};
using ArkodeStepper = SchemeOfProgram;

}  // namespace carom::integrators
