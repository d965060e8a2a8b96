// carom compare: integrators on a user's system.

#include <fmt/format.h>

#include <atomic>
#include <optional>
#include <string>
#include <vector>

#include "analyses/compare/report.hpp"
#include "base/parts.hpp"
#include "carom/analyses/compare.hpp"
#include "carom/base/error.hpp"
#include "carom/base/exact_number.hpp"
#include "carom/integrators/plan.hpp"
#include "carom/integrators/scheme.hpp"
#include "cli/commands/commands.hpp"
#include "cli/common.hpp"
#include "cli/loading.hpp"
#include "cli/signals.hpp"
#include "files/progress.hpp"

namespace carom::cli {

namespace {

void check(const std::vector<double>& numbers, const char* option, double least, double below,
           const char* expected) {
  for (const double x : numbers)
    if (!(x >= least && x > 0.0 && x < below))
      throw InputError(place_of(option), fmt::format("{:.6g} is out of range", x), expected);
}

}  // namespace

ComparePlan compare_plan(const Options& options) {
  ComparePlan plan;
  if (options.schemes == "all")
    for (const SchemeDescription& one : scheme_descriptions()) plan.schemes.emplace_back(one.name);
  else if (!options.schemes.empty())
    plan.schemes = base::parts_of(options.schemes, ',');
  if (!options.steps.empty()) plan.steps = numbers_of(options.steps, "--steps", "steps");
  check(plan.steps, "--steps", 0.0, 1e300, "times > 0");
  if (!options.tolerances.empty())
    plan.tolerances = numbers_of(options.tolerances, "--tolerances", "tolerances");
  check(plan.tolerances, "--tolerances", least_tolerance, 1.0, "numbers from 1e-15 to below 1");
  const auto positive = [](const std::string& text, const char* option, const char* expected) {
    const double x = ExactNumber(text, place_of(option)).to_double();
    check({x}, option, 0.0, 1e300, expected);
    return x;
  };
  if (!options.error.empty()) plan.error = positive(options.error, "--error", "a number > 0");
  if (!options.comparison_time.empty())
    plan.t_max = positive(options.comparison_time, "--t-max", "a time > 0");
  if (!options.trajectory.empty())
    plan.trajectory = whole_number(options.trajectory, "--trajectory", 0);
  return plan;
}

LoadedSystem system_of_compare(const Options& options) {
  LoadedSystem loaded = load_typed(options);
  if (!loaded.system.has_forces()) loaded.system.dynamics.everywhere = true;  // integrated, too
  return loaded;
}

int compare(const Options& options) {
  ComparePlan plan = compare_plan(options);
  std::optional<files::Progress> preparing(std::in_place, !options.quiet);
  const LoadedSystem loaded = system_of_compare(options);
  preparing.reset();
  const ArchiveLock lock = claim_output(options);
  const std::atomic<bool>& interrupted = catch_interrupts();
  plan.interrupted = [&] { return interrupted.load(std::memory_order_relaxed); };
  Comparison result;
  {
    files::Progress progress(!options.quiet);
    if (progress.enabled())
      plan.progress = [&](std::size_t done, std::size_t all) {
        if (progress.due())
          progress.show(static_cast<double>(done) / static_cast<double>(all),
                        fmt::format("{} of {} schemes", done, all));
      };
    result = carom::compare(loaded.system, plan);
  }
  const System& system = loaded.system;
  if (!options.output.empty())
    write_comparison(options.output, loaded, provenance_of(options, system, 1), result,
                     options.force, lock);
  const std::string archive = named_archive(options, options.output);
  print_report(
      options, [&] { return compare_json(system, result, archive); },
      [&] { return compare_text(system, result, archive, options.verbose); });
  return result.complete ? done : stopped;
}

}  // namespace carom::cli
