#include "analyses/splitting/command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "carom/base/error.hpp"
#include "carom/base/exact_number.hpp"
#include "carom/events/report.hpp"
#include "cli/commands/commands.hpp"
#include "cli/commands/ensemble_job.hpp"
#include "cli/common.hpp"
#include "cli/loading.hpp"
#include "cli/reports/aligned.hpp"
#include "cli/signals.hpp"
#include "files/progress.hpp"

namespace carom::cli {

using files::Json;

namespace {

// No particle was left in any population. How rare survival is, the populations do not say.
bool died_out(const Extrapolated& p) {
  return std::all_of(p.at_kick.begin(), p.at_kick.end(),
                     [](const Mean& mean) { return mean.value == 0.0; });
}
constexpr const char* all_died_out = "all populations died out";

Json json_of(const Extrapolated& value, Json json, bool known = true) {
  if (!known) {
    for (const char* key :
         {"value", "stderr", "extrapolation", "kick_error", "low", "high", "at_kicks"})
      json.set(key, Json());
    return json;
  }
  Json kicks = Json::array();
  for (const Mean& mean : value.at_kick)
    kicks.push(Json::object().set("value", mean.value).set("stderr", mean.error));
  return json.set("value", value.limit.value)
      .set("stderr", value.limit.error)
      .set("extrapolation", value.extrapolation)
      .set("kick_error", value.kick_error)
      .set("low", value.low())
      .set("high", value.high())
      .set("at_kicks", std::move(kicks));
}

// Columns of a printed table.
struct EstimateTable {
  std::vector<double> at;
  std::vector<std::string> value, error, extrapolation;
  void add(double where, const Extrapolated& one) {
    at.push_back(where);
    value.push_back(rounding_of(one.limit.value, one.limit.error)(one.limit.value));
    error.push_back(fmt::format("{:.1e}", one.limit.error));
    extrapolation.push_back(fmt::format("{:.1e}", one.extrapolation));
  }
};

double share_rejected(const SplittingResult& result) {
  double tried = 0.0, accepted = 0.0;
  for (const PopulationRun& run : result.runs.front()) {
    tried += static_cast<double>(run.tried);
    accepted += static_cast<double>(run.accepted);
  }
  return tried > 0.0 ? 1.0 - accepted / tried : 0.0;
}

// When all populations had died out; infinite: never.
double extinction_of(const std::vector<SplitPoint>& points) {
  const auto last =
      std::find_if(points.begin(), points.end(), [](const SplitPoint& p) { return died_out(p.p); });
  return last == points.end() ? std::numeric_limits<double>::infinity() : last->at;
}

const char* variable_of(const SplittingResult& result) {
  return result.plan.by == SplittingPlan::Level::time ? "t" : "n";
}

}  // namespace

SplittingPlan plan_of(const Options& options) {
  SplittingPlan plan;
  std::string levels = options.splitting;
  if (levels.starts_with("hits:")) {
    plan.by = SplittingPlan::Level::hits;
    levels = levels.substr(5);
  }
  plan.levels = numbers_of(
      levels, "--splitting", "levels",
      "a,b,c or log:from:to:count or lin:from:to:count, with hits: before them for hits");
  // A grid is spaced as evenly as whole hits allow; levels that were written are whole or
  // refused.
  const bool grid = levels.find(':') != std::string::npos;
  if (grid && plan.by == SplittingPlan::Level::hits)
    for (double& level : plan.levels) level = std::nearbyint(level);
  if (!options.population.empty())
    plan.population = whole_number(options.population, "--population", 2);
  if (!options.repetitions.empty())
    plan.repetitions = whole_number(options.repetitions, "--repetitions", 2);
  if (!options.lookback.empty()) plan.lookback = whole_number(options.lookback, "--lookback", 0);
  if (!options.kick.empty()) plan.kick = ExactNumber(options.kick, place_of("--kick")).to_double();
  return plan;
}

Doubts doubts_of(const SplittingResult& result) {
  Doubts doubts = doubts_of_failures(result.unresolved, result.lost);
  for (const std::string& report : result.reports) doubts.lines.emplace_back(shown(report));
  return doubts;
}

std::vector<std::string> notes_of(const SplittingResult& result) {
  std::vector<std::string> lines;
  const char* const variable = variable_of(result);
  if (result.plan.population < Extrapolated::least_population)
    lines.push_back(
        fmt::format("populations of {} trajectories: errors and intervals need at least {}",
                    result.plan.population, Extrapolated::least_population));
  const std::size_t repetitions = result.runs.back().size();
  const Mean cost = cost_of_kicks(result, result.at.size() - 1);
  if (is_certain(cost, repetitions))
    lines.push_back(
        fmt::format("kicked copies leave earlier than others: at {} = {:.6g} this changes p by "
                    "{}({}) %, and by as much again for later losses. The intervals include both; "
                    "smaller kicks (--kick {:.3g}) or independent trajectories have smaller errors",
                    variable, result.at.back(), in_percent(cost.value), in_percent(cost.error, 1),
                    result.plan.kick / 16));
  return lines;
}

Json splitting_json(const System& system, const SplittingResult& result) {
  const bool by_time = result.plan.by == SplittingPlan::Level::time;
  const char* const variable = variable_of(result);
  const std::vector<SplitPoint> points_of_p = survival(result);
  const double extinction = extinction_of(points_of_p);
  const double rejected = share_rejected(result);
  const Mean cost = cost_of_kicks(result, result.at.size() - 1);
  Json json = Json::object();
  add_common_keys(json, system, result.threads, result.seconds, result.cpu_seconds);
  json.set("status", result.complete ? "completed" : "interrupted");
  json.set("levels", by_time ? "time" : "hits");
  json.set("population", result.plan.population).set("repetitions", result.runs.front().size());
  json.set("kick", result.plan.kick)
      .set("lookback", result.plan.lookback)
      .set("rejected", rejected);
  json.set("kick_cost", Json::object().set("value", cost.value).set("stderr", cost.error));
  json.set("unresolved", result.unresolved)
      .set("lost", result.lost)
      .set("collisions", result.collisions);
  json.set("digest", fmt::format("{:016x}", result.digest));
  Json points = Json::array(), rates = Json::array();
  for (const SplitPoint& point : points_of_p)
    points.push(json_of(point.p,
                        Json::object().set(variable, point.at).set("equivalent", point.equivalent),
                        !died_out(point.p)));
  for (const SplitRate& rate : escape_rate(result))
    rates.push(json_of(rate.value,
                       Json::object().set("t", rate.t).set("from", rate.from).set("to", rate.to),
                       !(rate.from >= extinction)));
  std::vector<std::string> notes = notes_of(result);
  if (std::isfinite(extinction))
    notes.push_back(fmt::format("{} by {} = {:.6g}", all_died_out, variable, extinction));
  if (!notes.empty()) json.set("note", fmt::format("{}", fmt::join(notes, "; ")));
  json.set(by_time ? "survival" : "survival_hits", std::move(points));
  if (by_time) json.set("rate", std::move(rates));
  json.set("fit", split_fit_json(fit_decay(result, system.run.window)));
  return json;
}

std::string splitting_text(const System& system, const SplittingResult& result, bool verbose,
                           std::size_t most) {
  const bool by_time = result.plan.by == SplittingPlan::Level::time;
  const char* const variable = variable_of(result);
  const std::vector<SplitPoint> points_of_p = survival(result);
  const double extinction = extinction_of(points_of_p);
  const double rejected = share_rejected(result);
  std::string text =
      doubts_of(result).folded_text() + heading(system) +
      fmt::format(
          "{} of {} for each of three kicks, of\n{:.2g}, half and a quarter of it, seed {}\n\n",
          counted(result.runs.front().size(), "population"),
          counted(result.plan.population, "trajectory"), result.plan.kick, system.run.seed);
  EstimateTable p_table, rate_table;
  std::vector<std::string> equivalent;
  for (const std::size_t row : every_kth(points_of_p.size(), most)) {
    const SplitPoint& point = points_of_p[row];
    if (point.at >= extinction) break;
    p_table.add(point.at, point.p);
    equivalent.push_back(fmt::format("{:.1e}", point.equivalent));
  }
  text += fitted({{variable, times_text(p_table.at)},
                  {"p", p_table.value},
                  {"std error", p_table.error},
                  {"extrapolation", p_table.extrapolation},
                  {"equivalent", equivalent}});
  if (std::isfinite(extinction))
    text +=
        folded(fmt::format("{:>12.6g}  {} by then: they cannot say how rare survival is. More "
                           "trajectories (--population), or levels closer together, go further.",
                           extinction, all_died_out),
               std::string(14, ' ')) +
        '\n';
  const std::vector<SplitRate> rates = escape_rate(result);
  for (const std::size_t row : every_kth(rates.size(), most))
    if (rates[row].from < extinction) rate_table.add(rates[row].t, rates[row].value);
  if (by_time)
    text += "\n" +
            fitted({{"t", times_text(rate_table.at)},
                    {"-dP/dt", rate_table.value},
                    {"std error", rate_table.error},
                    {"extrapolation", rate_table.extrapolation}}) +
            "  -dP/dt between the times before and after t\n";
  text += split_fit_text(fit_decay(result, system.run.window), variable);
  text += fmt::format(
      "\n{} in {:.3g} s on {}\n"
      "{:.0f} % of the kicked copies kept their way\n",
      counted(result.collisions, "collision"), result.seconds,
      counted(static_cast<std::uint64_t>(result.threads), "thread"), 100.0 * rejected);
  text += grounds_text("three kicks, scatter (docs/physics/rare-events.md)", "rounding");
  if (verbose) text += fmt::format("digest {:016x}\n", result.digest);
  return text;
}

int splitting(const Options& options) {
  check_engine(options);
  if (!options.output.empty())
    throw InputError(place_of("--output"), "splitting writes no archive", "--json, or no -o");
  const LoadedSystem loaded = load_ensemble(options);
  const System& system = loaded.system;
  SplittingOptions how;
  how.threads = threads_of(options);
  how.interrupted = &catch_interrupts();
  SplittingResult result;
  {
    files::Progress progress(!options.quiet);
    if (progress.enabled())
      how.progress = [&](std::uint64_t populations, std::uint64_t all, std::uint64_t hits) {
        progress.show(
            static_cast<double>(populations) / static_cast<double>(all),
            files::with_prefix(static_cast<double>(hits) / progress.seconds()) + "hits/s");
      };
    result = run_splitting(system, plan_of(options), how);
  }
  const Doubts doubts = doubts_of(result);
  for (const std::string& line : doubts.lines) warn(line);
  for (const std::string& line : notes_of(result)) warn(line);
  print_report(
      options, [&] { return splitting_json(system, result); },
      [&] { return splitting_text(system, result, options.verbose, rows_of(options)); },
      doubts.text());
  return doubts.status(result.complete);
}

std::vector<std::string> SplittingOutcome::doubts() const {
  std::vector<std::string> lines = doubts_of(result).lines;
  for (const std::string& note : notes_of(result)) lines.push_back(note);
  return lines;
}

}  // namespace carom::cli
