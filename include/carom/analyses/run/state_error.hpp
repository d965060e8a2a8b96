// How far an integrated orbit can be believed: the same run with half the step.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "carom/system/system.hpp"

namespace carom {

/// Twice the largest distance, over all particles and the last eighth of the run, of a run's states
/// from those of the same run with half the step (adaptive schemes: three times that from a 64th of
/// the tolerance, 1e-15 at least). Of a small error of order p the distance is all but a 2^p-th. To
/// it is added what the roundings on the way, and the tails of bumps that are left out, may have
/// grown to: docs/physics/integrators.md.
struct StateError {
  double position = 0.0, velocity = 0.0;
  double until = 0.0;  ///< the time they are of: that asked for; earlier where the runs separate,
                       ///< or after most_compared steps
};

/// Steps, times the square of the number of particles, that are compared at most.
inline constexpr double most_compared = 4e6;

/// The error of a run of that trajectory at the time t_end or before. Nothing where no force acts,
/// for hard discs, or if it was stopped. `reached`: the particles at t_end. A run in parts differs
/// from the same in one piece where the scheme chooses its steps: by that the error is larger.
std::optional<StateError> state_error(const System&, std::uint64_t trajectory, double t_end,
                                      const std::function<bool()>& stopped = {},
                                      const std::vector<State>& reached = {});

}  // namespace carom
