#include "cli/commands/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

#include "carom/base/error.hpp"
#include "carom/files/archive.hpp"
#include "carom/files/ensembles.hpp"
#include "cli/commands/commands.hpp"
#include "cli/common.hpp"
#include "cli/loading.hpp"

namespace carom::cli {

namespace {

Place place_of(const std::string& key) { return {"command line", 0, 0, "--sweep " + key}; }

// Options of a command beside its system: a sweep that goes on needs them again.
constexpr std::pair<const char*, std::string Options::*> kept_options[] = {
    {"engine", &Options::engine},
    {"shard", &Options::shard},
    {"trajectory", &Options::trajectory},
    {"precision", &Options::precision},
    {"digits", &Options::digits},
    {"splitting", &Options::splitting},
    {"population", &Options::population},
    {"repetitions", &Options::repetitions},
    {"kick", &Options::kick},
    {"lookback", &Options::lookback},
    {"starts", &Options::starts},
    {"hits", &Options::hits},
    {"tries", &Options::tries},
    {"schemes", &Options::schemes},
    {"steps", &Options::steps},
    {"tolerances", &Options::tolerances},
    {"error", &Options::error},
    {"t_max", &Options::comparison_time}};
constexpr std::pair<const char*, bool Options::*> kept_flags[] = {
    {"per_trajectory", &Options::per_trajectory},
    {"saddles", &Options::saddles},
    {"zeta", &Options::zeta},
    {"certify", &Options::certify}};

// Keys that only some commands use; the others would give the same row again and again.
void refuse_without_use(const std::string& key, const std::string& command) {
  struct Use {
    const char *key, *commands;
  };
  static constexpr const char* trajectories = "escape, diffusion, lyapunov, returns, run, section";
  static constexpr Use uses[] = {{"section.", "section, returns"},
                                 {"title", ""},
                                 {"run.sample", "run"},
                                 {"run.trust_tolerance", "run"},
                                 {"run.times", "escape, diffusion"},
                                 {"run.t_max", trajectories},
                                 {"run.collisions", trajectories},
                                 {"run.window", "escape, diffusion, lyapunov"},
                                 {"run.trajectories", "escape, diffusion, lyapunov, returns"}};
  for (const Use& use : uses)
    if (key.starts_with(use.key) && std::string(use.commands).find(command) == std::string::npos)
      throw InputError(place_of(key), fmt::format("it means nothing to carom {}", command),
                       *use.commands ? fmt::format("carom {}, or another key", use.commands)
                                     : "a key that is a number");
}

void refuse_given_twice(const files::SweptKey& swept, const Options& options) {
  const SystemOverrides& o = options.overrides;
  const std::pair<const char*, const std::string*> typed[] = {
      {"seed", &o.seed},           {"trajectories", &o.trajectories},
      {"t-max", &o.t_max},         {"collisions", &o.collisions},
      {"times", &o.times},         {"trust-tolerance", &o.trust_tolerance},
      {"points", &options.points}, {"orbits", &options.orbits}};
  const auto refuse = [&](const std::string& other) {
    throw InputError(place_of(swept.key), fmt::format("{} also sets it", other), "one of the two");
  };
  for (const auto& [path, text] : o.set)
    if (path == swept.key) refuse("--set");
  for (const auto& [option, text] : typed) {
    std::string key = option;
    std::replace(key.begin(), key.end(), '-', '_');
    if (!text->empty() && (swept.key == "run." + key || swept.key == "section." + key))
      refuse(std::string("--") + option);
  }
}

// The system of a value.
LoadedSystem system_at(const Options& options, const files::SweepPlan& plan, std::size_t index) {
  Options one = options;
  const std::vector<std::string> values = plan.at(index);
  for (std::size_t k = 0; k < values.size(); ++k)
    one.overrides.set.emplace_back(plan.keys[k].key, values[k]);
  try {
    return system_of_command(one);
  } catch (const InputError& error) {
    throw InputError(error.place(),
                     fmt::format("{} (--sweep: {})", error.problem(), plan.named(index)),
                     error.expected(), error.nearest());
  }
}

void refuse_idle_integrator(const files::SweptKey& swept, const System& system) {
  if (swept.key.starts_with("integrator.") && engine_of(system) == "events")
    throw InputError(place_of(swept.key),
                     "no force acts: flights are exact, and nothing is integrated",
                     "a system with forces, or --engine steps");
}

// The keys that --sweep gives.
std::vector<files::SweptKey> swept_keys(const Options& options) {
  std::vector<files::SweptKey> keys;
  for (const std::string& typed : options.sweep) {
    files::SweptKey swept = files::swept_key(typed);
    refuse_without_use(swept.key, options.command);
    refuse_given_twice(swept, options);
    for (const files::SweptKey& other : keys)
      if (other.key == swept.key)
        throw InputError(place_of(swept.key), "it is swept twice", "two keys that differ");
    keys.push_back(std::move(swept));
  }
  if (keys.size() > 2)
    throw InputError(place_of(keys[2].key), "three keys are too many",
                     "one key, or two of a plane");
  return keys;
}

}  // namespace

files::SweepPlan plan_of_sweep(const Options& options) {
  files::SweepPlan plan;
  plan.command = options.command;
  plan.keys = swept_keys(options);
  if (plan.points() > files::most_swept)
    throw InputError(place_of(plan.keys[0].key),
                     fmt::format("{} points are too many", plan.points()),
                     fmt::format("at most {}", files::most_swept));
  for (std::size_t i = 0; i < plan.points(); ++i) {
    const LoadedSystem loaded = system_at(options, plan, i);
    if (i == 0)
      for (const files::SweptKey& swept : plan.keys) refuse_idle_integrator(swept, loaded.system);
    plan.systems.push_back(loaded.resolved_toml);
    plan.system_name = loaded.system.name;
  }
  try {
    plan.system_toml = system_of_command(options).resolved_toml;
  } catch (const InputError&) {
    plan.system_toml = plan.systems.front();  // the key that is swept is needed
  }
  for (const auto& [name, field] : kept_options)
    if (!(options.*field).empty()) plan.options.emplace_back(name, options.*field);
  for (const auto& [name, flag] : kept_flags)
    if (options.*flag) plan.options.emplace_back(name, "true");
  return plan;
}

void refuse_another(const files::SweepPlan& stored, const files::SweepPlan& asked,
                    const std::string& file) {
  const auto refuse = [&](const std::string& what) {
    throw InputError(Place{file, 0, 0, ""}, "this is another sweep than the stored one: " + what,
                     "the same system and options, or none");
  };
  if (stored.systems.size() != asked.systems.size())
    refuse(
        fmt::format("{}, not {}", counted(asked.systems.size(), "value"), stored.systems.size()));
  for (std::size_t i = 0; i < stored.systems.size(); ++i)
    if (const std::string differs = difference(stored.systems[i], asked.systems[i], {"run.window"});
        !differs.empty())
      refuse(fmt::format("at value {}, {}", i + 1, differs));
}

void restore_options(const files::SweepPlan& plan, Options& options) {
  for (const auto& [name, text] : plan.options) {
    for (const auto& [known, flag] : kept_flags)
      if (name == known) options.*flag = true;
    for (const auto& [known, field] : kept_options)
      if (name == known) options.*field = text;
  }
}

}  // namespace carom::cli
