// [integrator].
#include "carom/integrators/scheme.hpp"
#include "io/read.hpp"

namespace carom::io {

IntegratorPlan read_integrator(Value& root) {
  IntegratorPlan plan;
  Value* value = root.find("integrator");
  if (value == nullptr) return plan;
  Section section(*value, "integrator");
  section.check_keys();
  if (const Value* scheme = section.find("scheme")) {
    plan.scheme = as_text(*scheme);
    if (!is_adaptive(plan.scheme)) find_scheme(plan.scheme, scheme->place);
  }
  if (const Value* step = section.find("step")) plan.step = as_positive(*step);
  if (const Value* tolerance = section.find("tolerance")) {
    plan.tolerance = as_positive(*tolerance);
    if (!is_adaptive(plan.scheme))
      throw InputError(tolerance->place, "a scheme of fixed steps has no tolerance", "step, or scheme = \"arkode\"");
  }
  const Value& walls = section.get("walls");
  if (as_text(walls) != "reflect")
    throw InputError(walls.place, "unknown treatment of walls '" + walls.text + "'", "\"reflect\"");
  return plan;
}

}  // namespace carom::io
