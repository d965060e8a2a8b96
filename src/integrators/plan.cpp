#include "carom/integrators/plan.hpp"

#include <fmt/format.h>

#include <cmath>

#include "carom/integrators/scheme.hpp"

namespace carom {
namespace {

Place key(const Place& section, const char* name) {
  Place place = section;
  place.key = section.key.empty() ? name : section.key + "." + name;
  return place;
}

}  // namespace

void check_plan(const IntegratorPlan& plan, const Place& place) {
  if (plan.step != 0.0 && !(plan.step > 0.0 && std::isfinite(plan.step))) {
    throw InputError(key(place, "step"), fmt::format("a step of {:.6g} leads nowhere", plan.step),
                     "a time > 0");
  }
  if (is_adaptive(plan.scheme)) {
    if (plan.tolerance != 0.0 && !(plan.tolerance >= least_tolerance && plan.tolerance < 1.0)) {
      throw InputError(key(place, "tolerance"),
                       fmt::format("a tolerance of {:.6g} cannot be met", plan.tolerance),
                       fmt::format("a number from {:.6g} to below 1", least_tolerance));
    }
    return;
  }
  const Place at = key(place, "scheme");
  const Scheme& scheme = find_scheme(plan.scheme, at);
  if (plan.tolerance != 0.0) {
    throw InputError(
        key(place, "tolerance"),
        "the scheme '" + std::string(scheme.name) + "' has fixed steps and takes no tolerance",
        "step; or one of the adaptive schemes, arkode or cvode");
  }
}

void check_step(const IntegratorPlan& plan, const Place& place) {
  if (is_adaptive(plan.scheme) || plan.step > 0.0) return;
  throw InputError(
      key(place, "step"),
      "the scheme '" + std::string(find_scheme(plan.scheme).name) + "' needs a step",
      "a time > 0, about 1/50 of the shortest period; or scheme = \"arkode\" with a tolerance");
}

std::string check_turn(const IntegratorPlan& plan, double largest_omega, bool walls,
                       const Place& place) {
  if (is_adaptive(plan.scheme))
    return "";  // the step is only the longest: the error control sees the turn
  const double angle = std::fabs(largest_omega) * plan.step;
  if (walls && angle > 1.0) {
    throw InputError(
        key(place, "step"),
        fmt::format("the magnetic field turns the velocity by {:.6g} within a step", angle),
        fmt::format("a step of at most {:.6g} where there are walls",
                    1.0 / std::fabs(largest_omega)));
  }
  if (!(angle > 2.0)) return "";
  return fmt::format(
      "the magnetic field turns the velocity by {:.6g} within a step: stable, but hardly accurate; "
      "2 is the most to advise",
      angle);
}

}  // namespace carom
