// An orbit in 34 digits: what schemes in doubles are compared with.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analyses/compare/orbit.hpp"

namespace carom::analyses {

struct PreciselyHit {
  ComparedHit seen;
  double speed = 0.0, across = 0.0;  ///< before it; the part across the wall
};

struct PreciseOrbit {
  std::vector<std::vector<PlaneState>> states;  ///< as Orbit::states
  std::vector<PreciselyHit> hits;
  double step = 0.0;
  double error = 0.0;  ///< of the states, rounding to doubles included
};

/// Follows the start until t by `scheme` in 34 digits, with steps of about eight times
/// `step_in_doubles`, then of half, of a quarter … until the error is far below that of a double;
/// forces by the formulas of the documentation. Empty: it would cost too much, or halving the step
/// does not lower the error as the scheme's order says twice running, or a force has no value, or
/// it does not hit the walls that are expected.
std::optional<PreciseOrbit> precise_orbit(const Runs&, const std::string& scheme,
                                          double step_in_doubles, double t, const ErrorUnits&,
                                          std::span<const ComparedHit> expected = {});

/// Are the hits the same to such an error of a position? The state reaches the wall earlier or
/// later by that way over the velocity across the wall, and elsewhere by as much as it goes
/// meanwhile.
bool same_hits(const std::vector<ComparedHit>&, const std::vector<PreciselyHit>&, double error);

}  // namespace carom::analyses
