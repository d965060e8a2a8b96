#include "cli/commands/own_step.hpp"

#include <fmt/format.h>

#include "carom/files/system_file.hpp"
#include "cli/reports/doubts.hpp"
#include "files/toml/overrides.hpp"

namespace carom::cli {

namespace {

/// All of them together cost 2^(most + 1) times what the first run did.
constexpr int most_halvings = 6;

}  // namespace

OwnStep::OwnStep(const Options& options, Say say)
    : may_(options.resume.empty() && options.shard.empty()), say_(say) {}

bool OwnStep::halve(LoadedSystem& loaded, const EnergyError& error) {
  const IntegratorPlan& plan = loaded.system.dynamics.integrator;
  if (!may_ || !plan.step_chosen || energy_doubt(loaded.system, error).empty()) return false;
  const bool helped = halvings_ == 0 || error.largest <= 0.5 * error_;
  if (!helped || halvings_ == most_halvings) return false;
  ++halvings_;
  error_ = error.largest;
  files::halve_step(loaded);
  say_(
      fmt::format("the energy changed by {:.2g} of the largest kinetic energy with the chosen "
                  "step: starting again with {}",
                  error.largest, plan.step));
  return true;
}

files::Json OwnStep::with_halvings(files::Json report) const {
  if (halvings_ > 0) report.set("step_halvings", halvings_);
  return report;
}

std::string OwnStep::text() const {
  if (halvings_ == 0) return {};
  return fmt::format(
      "the chosen step was halved {}: with longer steps the energy changed by more\n",
      halvings_ == 1 ? "once" : fmt::format("{} times", halvings_));
}

}  // namespace carom::cli
