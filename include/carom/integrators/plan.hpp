// What the system file asks of the integration ([integrator] of docs/guide/system-file.md).
#pragma once

#include <string>

#include "carom/base/error.hpp"

namespace carom {

/// The section [integrator] of a system file.
struct IntegratorPlan {
  std::string
      scheme;  ///< a name of schemes(), a magnetic scheme, "arkode" or "cvode"; "": the default
  double step = 0.0;       ///< > 0: time between two ends of steps; 0: not given
  double tolerance = 0.0;  ///< > 0: relative tolerance of an adaptive scheme; 0: not given
  bool count_unresolved =
      false;  ///< unresolved = "count": steps that do not resolve a force are counted, not fatal
  /// unresolved = "halve": a step that fails is taken in parts, each half as long as the one that
  /// failed, or a quarter, ...
  bool halve_unresolved = false;
  /// Where steps are halved, they must resolve the forces as if they were this many times as long.
  double resolution_margin = 1.0;
  double energy_tolerance =
      1e-3;  ///< largest change of the energy over the largest kinetic energy that is accepted
  bool step_chosen = false;  ///< the step is not of the file: engines/choose_step.hpp found it
};

inline constexpr double default_tolerance = 1e-12;  ///< of an adaptive scheme
inline constexpr double least_tolerance = 1e-15;  ///< below, rounding is all the error control sees

/// An InputError at that place if the plan cannot be carried out: unknown scheme, a tolerance for a
/// fixed-step one.
void check_plan(const IntegratorPlan& plan, const Place& place = {});

/// An InputError if a fixed-step scheme has no step.
void check_step(const IntegratorPlan& plan, const Place& place = {});

/// A fixed step turns velocities by |omega| h at most. Schemes are stable for any, but accurate
/// only far below a full turn. Returns a warning above 2 ("" below); an InputError above 1 where
/// there are walls, as the path within a step is searched for hits.
std::string check_turn(const IntegratorPlan& plan, double largest_omega, bool walls,
                       const Place& place = {});

}  // namespace carom
