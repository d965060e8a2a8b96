// Ensembles: what the program's commands compute and print with --json.
#include <fmt/format.h>

#include "analyses/diffusion/describe.hpp"
#include "analyses/escape/describe.hpp"
#include "analyses/lyapunov/describe.hpp"
#include "analyses/returns/describe.hpp"
#include "analyses/section/report.hpp"
#include "carom/analyses/kinds.hpp"
#include "carom/analyses/section.hpp"
#include "carom/base/error.hpp"
#include "cli/commands/commands.hpp"
#include "cli/commands/own_step.hpp"
#include "cli/loading.hpp"
#include "cli/reports/ensemble_context.hpp"
#include "parts.hpp"
#include "systems.hpp"

namespace carom::page {

namespace {

using cli::Options;

/// Options of the command line by their names in a request.
struct Named {
  const char *key, *option;
  std::string Options::*of_command;
  std::string SystemOverrides::*of_system;
};
constexpr Named named[] = {
    {"trajectories", "--trajectories", nullptr, &SystemOverrides::trajectories},
    {"t_max", "--t-max", nullptr, &SystemOverrides::t_max},
    {"collisions", "--collisions", nullptr, &SystemOverrides::collisions},
    {"seed", "--seed", nullptr, &SystemOverrides::seed},
    {"times", "--times", nullptr, &SystemOverrides::times},
    {"window", "--window", &Options::window, nullptr},
    {"on", "--on", &Options::on, nullptr},
    {"direction", "--direction", &Options::direction, nullptr},
    {"points", "--points", &Options::points, nullptr},
    {"orbits", "--orbits", &Options::orbits, nullptr}};

/// Options without a value that set a key of the system, after --set.
struct Flag {
  const char *key, *option, *path, *value;
};
constexpr Flag flags[] = {{"closed", "--closed", "table.hole", "[]"},
                          {"free_paths", "--free-paths", "run.free_paths", "true"}};

std::string in_shell(const std::string& text) {
  const bool plain = text.find_first_not_of(
                         "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                         "0123456789_-+.,:/=") == text.npos;
  return plain && !text.empty() ? text : "'" + text + "'";
}

/// The options of a request as if they were typed; `line` gets the command.
Options typed(const Request& request, const OpenSystem& open) {
  Options options;
  options.command = text_of(request, "analysis");
  options.system = open.name;
  options.system_text = open.toml;
  options.quiet = options.json = true;
  options.line = fmt::format("carom {} {}", options.command, open.name);
  const auto set = [&](const std::string& path, const std::string& value) {
    options.overrides.set.emplace_back(path, value);
    options.line += " --set " + in_shell(path + "=" + value);
  };
  const auto flag = [](const std::string& key) {
    return std::any_of(std::begin(flags), std::end(flags),
                       [&](const Flag& one) { return key == one.key; });
  };
  static const Request none;
  for (const auto& [key, value] : request.get_child("options", none)) {
    const std::string& text = value.data();
    if (key == "set") {
      for (const auto& [path, one] : value) set(path, one.data());
    } else if (!flag(key)) {
      const Named* const found = std::find_if(std::begin(named), std::end(named),
                                              [&k = key](const Named& n) { return k == n.key; });
      if (found == std::end(named)) throw InputError("the page has no option '" + key + "'");
      (found->of_command ? options.*found->of_command : options.overrides.*found->of_system) = text;
      options.line += fmt::format(" {} {}", found->option, in_shell(text));
    }
  }
  for (const Flag& one : flags) {
    if (request.get<std::string>(std::string("options.") + one.key, "") != "true") continue;
    options.overrides.set.emplace_back(one.path, one.value);
    options.line += fmt::format(" {}", one.option);
  }
  return options;
}

/// Flies until the step that the program chose keeps the energy, as the commands do.
template <class Result, class Fly>
Result flown_well(LoadedSystem& loaded, cli::OwnStep& own_step, Fly fly) {
  for (;;) {
    Result result = fly(loaded.system);
    if (!own_step.halve(loaded, result.energy_error)) return result;
  }
}

template <class Result>
Json printed(const System& system, const Result& result) {
  if (const auto error = why_nothing(system, result)) throw *error;
  return cli::result_json(system, result, {.status = "completed", .output = "", .shard = {}});
}

template <class Result>
Json whole(const Options& options) {
  LoadedSystem loaded = cli::load_ensemble(options);
  cli::OwnStep own_step(options);
  EnsembleOptions<Result> how;
  how.lanes.reset();
  const auto result = flown_well<Result>(loaded, own_step,
                                         [&](const System& system) { return flown(system, how); });
  return own_step.with_halvings(printed(loaded.system, result));
}

/// Trajectories first … last - 1, for `sum`. As with --shard, a step is never halved.
template <class Result>
Json part(const Options& options, TrajectoryRange range) {
  const LoadedSystem loaded = cli::load_ensemble(options);
  EnsembleOptions<Result> how;
  how.lanes.reset();
  how.part = range;
  const Result result = flown(loaded.system, how);
  Part part;
  put_common(part, result);
  PartOut out(part);
  analyses::describe(out, result, loaded.system);
  return Json::object().set("part", part.text());
}

template <class Result>
Json sum(const Options& options, const Request& parts) {
  const LoadedSystem loaded = cli::load_ensemble(options);
  Result sum;
  bool first = true;
  for (const auto& [key, text] : parts) {
    const Part part(text.data());
    Result one;
    PartIn in(part);
    analyses::describe(in, one, System());
    get_common(part, one);
    if (first)
      sum = std::move(one);
    else if (!sum.add(one))
      throw InputError("two parts have trajectories in common");
    first = false;
  }
  sum.complete = sum.done.size() == loaded.system.run.trajectories;
  if (!sum.complete) throw InputError("the parts are not the whole ensemble");
  SplittingOptions how;
  how.lanes.reset();
  complete_sum(loaded.system, sum, how);
  return printed(loaded.system, sum);
}

template <class Result>
Json of_kind(const Options& options, const Request& request) {
  if (const auto parts = request.get_child_optional("parts")) return sum<Result>(options, *parts);
  const auto range = request.get_child_optional("part");
  if (!range) return whole<Result>(options);
  return part<Result>(options, {range->front().second.get_value<std::uint64_t>(),
                                range->back().second.get_value<std::uint64_t>()});
}

Json sections(const Options& options) {
  LoadedSystem loaded = cli::system_of_section(options);
  cli::OwnStep own_step(options);
  SectionOptions how;
  how.lanes.reset();
  const auto result = flown_well<SectionResult>(
      loaded, own_step, [&](const System& system) { return run_section(system, how); });
  return own_step.with_halvings(cli::section_json(loaded.system, result, "completed", ""));
}

}  // namespace

Json ensemble(const Request& request) {
  const Options options = typed(request, *system_of(request));
  Json json;
  if (options.command == "section")
    json = sections(options);
  else if (!for_kind(options.command, [&]<class Result>(std::type_identity<Result>) {
             json = of_kind<Result>(options, request);
           }))
    throw InputError("the page does not compute '" + options.command +
                     "'; the program may: carom --help lists what it does");
  return json.set("command", options.line);
}

}  // namespace carom::page
