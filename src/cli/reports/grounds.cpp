#include "cli/reports/grounds.hpp"

#include "cli/common.hpp"
#include "cli/reports/aligned.hpp"

namespace carom::cli {

std::string grounds_text(const std::string& checked, const std::string& unchecked) {
  return folded("checked: " + checked + "; not: " + unchecked) + "\n";
}

std::string grounds_text(const System& system, const StepCounts& steps, bool errors) {
  const bool integrated = engine_of(system) != "events";
  std::string checked = integrated ? "energy" : "walls (exact signs)";
  if (integrated && steps.unresolved == 0) checked += ", steps";
  if (errors) checked += ", errors (docs/physics/errors.md)";
  return grounds_text(checked, integrated ? "half the step" : "rounding");
}

}  // namespace carom::cli
