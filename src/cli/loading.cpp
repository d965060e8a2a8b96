#include "cli/loading.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/counted.hpp"
#include "carom/base/error.hpp"
#include "carom/integrators/scheme.hpp"
#include "carom/starts/sampler.hpp"
#include "cli/common.hpp"
#include "cli/signals.hpp"

namespace carom::cli {

void choose_engine(const std::string& engine, System& system) {
  const Dynamics& dynamics = system.dynamics;
  const bool forces = system.has_forces();
  if (engine == "events" && forces)
    throw InputError(place_of("--engine"), "'events' cannot move particles under forces",
                     "auto or steps");
  system.dynamics.everywhere = engine == "steps";
  if (!forces && engine != "steps") return;
  if (!(dynamics.integrator.step > 0.0) && !is_adaptive(dynamics.integrator.scheme))
    throw InputError(place_of("--engine"), "'steps' needs the length of a step",
                     "[integrator] step, or --set integrator.step=0.01");
  double omega = 0.0;
  for (const Particle& p : system.particles) omega = std::max(omega, std::fabs(p.omega));
  const std::string warning = check_turn(dynamics.integrator, omega, !system.table->walls.empty(),
                                         {system.name, 0, 0, "integrator"});
  if (!warning.empty()) write_message("warning: " + warning);
}

std::string engine_of(const System& system) {
  const Dynamics& dynamics = system.dynamics;
  if (dynamics.everywhere) return "steps";
  if (!system.has_forces()) return "events";
  return dynamics.forces->everywhere() || dynamics.forces->interacts() ? "steps" : "auto";
}

std::string repeated_starts(const System& system) {
  const std::uint64_t listed = listed_trajectories(system), all = system.run.trajectories;
  if (listed == 0 || listed >= all || !system.injections.empty()) return {};
  return fmt::format("{} repeat {}: they are not independent, and errors and intervals too small",
                     counted(all, "trajectory"), counted(listed, "listed one"));
}

LoadedSystem load(const Options& options, const SystemOverrides& overrides) {
  const Reading until_read;
  // Equilibria are found without any step, and trial runs for one may take minutes.
  SystemOverrides with = options.of_sweep ? SystemOverrides() : overrides;
  with.choose_step = options.command != "relax" && options.command != "table";
  if (options.of_sweep)
    return read_system(options.of_sweep->system_toml, options.of_sweep->system_name, with);
  if (options.system_text) return read_system(*options.system_text, options.system, with);
  return load_system(options.system, with);
}

LoadedSystem load_typed(const Options& options) { return load(options, options.overrides); }

SystemOverrides overrides_of_ensemble(const Options& options) {
  SystemOverrides overrides = options.overrides;
  overrides.window = options.window;
  if (!options.on.empty()) overrides.set.emplace_back("section.on", options.on);
  return overrides;
}

LoadedSystem load_ensemble(const Options& options) {
  SystemOverrides overrides = overrides_of_ensemble(options);
  LoadedSystem loaded = load(options, overrides);
  // Listed starts that trajectories repeat give the same orbits again, as if their spread were 0:
  // for a mean as many trajectories as starts are listed.
  if (options.command != "escape" && !options.of_sweep && !repeated_starts(loaded.system).empty()) {
    std::erase_if(overrides.set, [](const auto& one) { return one.first == "run.trajectories"; });
    overrides.trajectories = std::to_string(listed_trajectories(loaded.system));
    loaded = load(options, overrides);
  }
  choose_engine(options.engine, loaded.system);
  return loaded;
}

}  // namespace carom::cli
