// An orbit in 34 digits: what schemes in doubles are compared with.
#pragma once

#include <optional>

#include "ensemble/compare/orbit.hpp"

namespace carom::ensemble {

struct PreciseOrbit {
  std::vector<std::vector<PlaneState>> states;  ///< as Orbit::states
  double step = 0.0;
  double error = 0.0;  ///< of the states, rounding to doubles included
};

/// Follows the start until t by `scheme` in 34 digits, with steps of about `step`, of a half, of a
/// quarter … until the error is far below that of a double; forces by the formulas of the
/// documentation. Walls are not seen. Empty: it would cost too much, or halving the step does not
/// lower the error as the scheme's order says twice running, or a force has no value.
std::optional<PreciseOrbit> precise_orbit(const Runs&, const std::string& scheme, double step,
                                          double t, const ErrorUnits&);

}  // namespace carom::ensemble
