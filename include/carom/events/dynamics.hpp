// Forces on particles, and how motion under them is computed.
#pragma once

#include <memory>

#include "carom/forces/force_field.hpp"
#include "carom/integrators/plan.hpp"

namespace carom {

/// What acts besides walls and the magnetic field, and how motion under it is computed.
struct Dynamics {
  std::shared_ptr<const ForceField> forces;  ///< null: nothing
  IntegratorPlan integrator;
  bool everywhere = false;  ///< integrate also what could be flown exactly
};

}  // namespace carom
