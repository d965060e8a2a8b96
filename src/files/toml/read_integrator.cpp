// [integrator].
#include <algorithm>
#include <cmath>

#include "carom/integrators/scheme.hpp"
#include "files/toml/read.hpp"

namespace carom::files {

IntegratorPlan read_integrator(Value& root, bool forces, const std::vector<Particle>& particles,
                               bool walls) {
  IntegratorPlan plan;
  Value* value = root.find("integrator");
  if (value == nullptr) {
    if (!forces) return plan;
    files::Value empty;
    empty.place = {root.place.file, 0, 0, "integrator"};
    value = &root.set("integrator", empty);
  }
  TomlSection section(*value, "integrator");
  section.check_keys();
  const Value& scheme = section.get("scheme");
  plan.scheme = as_text(scheme);
  if (!is_adaptive(plan.scheme)) find_scheme(plan.scheme, scheme.place);
  Place place = value->place;
  if (const Value* step = section.find("step")) {
    plan.step = as_positive(*step);
    place = step->place;
    const Value* const chosen = section.find("step_chosen");
    plan.step_chosen = chosen != nullptr && as_flag(*chosen);
  }
  if (const Value* tolerance = section.find("tolerance")) {
    plan.tolerance = as_positive(*tolerance);
    place = tolerance->place;
  } else if (is_adaptive(plan.scheme)) {
    plan.tolerance = default_tolerance;
    section.fill("tolerance", number_value("1e-12", section.place_of("tolerance")));
  }
  plan.energy_tolerance = as_positive(section.get("energy_tolerance"));
  // A step of the user's is taken as it is; the program's own is a first guess.
  const bool fixed = forces && !is_adaptive(plan.scheme);
  const char* const fallback = fixed && !(plan.step > 0.0) ? "halve" : "stop";
  if (!section.has("unresolved"))
    section.fill("unresolved", text_value(fallback, section.place_of("unresolved")));
  const Value& unresolved = *section.find("unresolved");
  const std::string treatment = as_text(unresolved);
  plan.count_unresolved = treatment == "count";
  plan.halve_unresolved = fixed && treatment == "halve";
  if (treatment != "count" && treatment != "halve" && treatment != "stop")
    throw InputError(unresolved.place, "unknown treatment of unresolved steps '" + treatment + "'",
                     "\"stop\", \"count\" or \"halve\"",
                     nearest_name(treatment, {"stop", "count", "halve"}));
  place.key = "integrator";  // the checks add the key at fault
  if (forces || plan.tolerance > 0.0) check_plan(plan, place);
  if (forces) {
    double largest = 0.0;
    for (const Particle& p : particles) largest = std::max(largest, std::fabs(p.omega));
    check_turn(plan, largest, walls, place);
  }
  return plan;
}

}  // namespace carom::files
