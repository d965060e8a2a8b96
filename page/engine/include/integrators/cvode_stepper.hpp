#pragma once

#include "integrators/arkode_stepper.hpp"

namespace carom::integrators {
using CvodeStepper = SchemeOfProgram;
}  // namespace carom::integrators
