#include "cli/reports/ensemble_context.hpp"

#include <fmt/format.h>

#include <cmath>

#include "carom/engines/engine.hpp"
#include "carom/results/interval.hpp"
#include "carom/starts/start_measure.hpp"
#include "cli/common.hpp"
#include "cli/loading.hpp"
#include "cli/reports/aligned.hpp"
#include "cli/reports/doubts.hpp"

namespace carom::cli {

using files::Json;

namespace {

std::string work_text(const System& system, const EndCounts& ends, const EnsembleResult& result) {
  std::string text = counted(ends.collisions, "collision");
  if (system.of_discs()) text += " and " + counted(ends.contacts, "contact");
  if (const std::string steps = steps_text(system, result.steps); !steps.empty())
    text += "\n" + steps + "\n";
  else
    text += " ";
  const EventCounts events{ends.collisions, ends.contacts};
  text += fmt::format("in {:.3g} s on {}{}: {}", result.seconds,
                      result.ranks > 1 ? fmt::format("{} processes of ", result.ranks) : "",
                      counted(static_cast<std::uint64_t>(result.threads), "thread"),
                      pace_text(system, events, result.steps, result.seconds));
  if (events.all() > 0)
    text += fmt::format(", {} of CPU each",
                        short_duration(result.cpu_seconds / static_cast<double>(events.all())));
  const std::size_t last = text.rfind('\n') + 1;
  return text.substr(0, last) + folded(text.substr(last)) + '\n';
}

}  // namespace

std::string head_text(const System& system, const EnsembleResult& result, double last_time,
                      const EnsembleContext& context) {
  const std::size_t each = system.particles.size();
  return heading(system) +
         folded(fmt::format(
             "{}{} {}, seed {}{}{}", counted(result.done.size(), "trajectory"),
             each > 1 ? fmt::format(" of {} particles", each) : "", until(last_time),
             system.run.seed, context.shard.of > 1 ? ", part " + text_of(context.shard) : "",
             result.complete ? "" : "  (" + context.status + ": those that were finished)")) +
         '\n';
}

std::string rows_text(std::size_t all, const EnsembleContext& context) {
  if (all <= context.rows) return {};
  return fmt::format("  of {} rows; --verbose prints all\n", grouped(all));
}

std::string closing_text(const System& system, const EnsembleResult& result, const EndCounts& ends,
                         const EnsembleContext& context, const EngineOptions& how,
                         const LaneEffort& effort) {
  std::string text;
  if (engine_of(system) != "events") text += "\n" + energy_text(system, result.energy_error);
  text += "\n" + work_text(system, ends, result);
  if (context.verbose)
    text +=
        fmt::format("{}\n{}digest {:016x}\n", decisions_text(result.decisions),
                    lanes_text(why_one_by_one(system, how), result.lanes, effort), result.digest);
  text += grounds_text(system, result.steps, true);
  if (!context.output.empty()) text += fmt::format("archive: {}\n", context.output);
  return text;
}

std::string no_errors(std::ptrdiff_t empty, const char* lack) {
  if (empty == 0) return {};
  return fmt::format(
      "there are no errors: they come from {} replicates of the quasi-random starts, and {} of "
      "them {}; take more trajectories, {} at least",
      replicates, empty, lack, replicates);
}

Json ensemble_json(const System& system, const EnsembleResult& result,
                   const EnsembleContext& context) {
  Json json = Json::object();
  add_common_keys(json, system, result.threads, result.seconds, result.cpu_seconds,
                  result.lanes ? name_of(*result.lanes) : "baseline");
  json.set("ranks", result.ranks).set("status", context.status);
  if (context.shard.of > 1) json.set("shard", text_of(context.shard));
  return json;
}

Json estimate_json(const Estimate& e) {
  // An infinite error, where there are too few groups to tell, is none.
  return Json::object()
      .set("value", e.value)
      .set("stderr", std::isfinite(e.error) ? Json(e.error) : Json());
}

std::string with_error(const Estimate& e) { return with_error(e.value, e.error); }

Json starts_json(const System& system) {
  const std::string why = why_not_stationary(system);
  Json json = Json::object().set("stationary", why.empty());
  if (!why.empty()) json.set("reason", why);
  return json;
}

std::string drawn_in_place(const System& system) {
  std::string text =
      "uniform, the measure of the flow, in place of starts from all walls, which have that of the "
      "map from hit to hit";
  for (const Particle& p : system.particles)
    if (p.omega != 0.0) return text + "; circles that meet no wall do not count";
  return text;
}

std::string correlation_note(const System& system) {
  const std::string why = why_not_stationary(system);
  if (why.empty()) return {};
  return fmt::format(
      "the starts are not stationary ({}): C(t) and its integral are those from these starts, and "
      "D(t) need not tend to D{}",
      why,
      system.run.free_paths
          ? "; free paths are biased, by a part that falls as 1/t where none leave"
          : "");
}

}  // namespace carom::cli
