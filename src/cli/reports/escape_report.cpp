#include "cli/reports/escape_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "carom/ensemble/engine.hpp"
#include "carom/table/hole_names.hpp"
#include "cli/common.hpp"
#include "cli/reports/doubts.hpp"
#include "io/progress.hpp"

namespace carom::cli {

namespace {

std::string survival_table(const SurvivalCounts& counts) {
  const auto points = survival(counts);
  const auto rates = escape_rate(counts);
  auto rate = rates.begin();  // both lists in the order of time
  std::string text =
      "\n           t        p(t)   95 % interval            rate -dP/dt   95 % interval\n";
  for (const SurvivalPoint& point : points) {
    text += fmt::format("{:>12.6g}  {:>10.6f}   {:.6f} .. {:.6f}", point.t, point.p, point.low,
                        point.high);
    while (rate != rates.end() && rate->to < point.t) ++rate;
    if (rate != rates.end() && rate->to == point.t)
      text += fmt::format("   {:>12.4e}   {:.3e} .. {:.3e}", rate->value, rate->low, rate->high);
    text += '\n';
  }
  return text;
}

std::string fates(const System& system, const SurvivalCounts& counts) {
  const double all = static_cast<double>(std::max<std::uint64_t>(1, counts.trajectories));
  std::string text = "\nFates\n";
  const auto line = [&](const std::string& name, std::uint64_t number, const char* note,
                        bool always) {
    if (number == 0 && !always) return;
    text += fmt::format("  {:<22}{:>16}  {:>9.5f} %{}{}\n", name, grouped(number),
                        100.0 * static_cast<double>(number) / all, *note ? "   " : "", note);
  };
  line("escaped", counts.escaped, "", true);
  const std::vector<std::string> holes = hole_names(*system.table);
  for (std::size_t i = 0; holes.size() > 1 && i < holes.size(); ++i)
    line("  by " + holes[i], counts.hole_escapes[i], "", true);
  line("survived", counts.survived, "", true);
  line("  pinned", counts.pinned, "on cyclotron orbits that never hit", false);
  line("  capped", counts.capped, "ended by the cap on hits", false);
  line("singular", counts.singular, "hit a corner without a limit, or moved along a wall", false);
  line("unbounded", counts.unbounded, "no wall follows any more", false);
  line("unresolved", counts.unresolved, why_unresolved, false);
  line("lost", counts.lost, why_lost, false);
  return text;
}

}  // namespace

Json result_json(const System& system, const EscapeResult& result, const EnsembleContext& context) {
  const SurvivalCounts& counts = result.counts;
  Json json = ensemble_json(system, result, context);
  json.set("trajectories", counts.trajectories);
  json.set("survived", counts.survived);
  add_fates(json, counts);
  json.set("collisions", counts.collisions);
  if (system.of_discs()) json.set("contacts", counts.contacts);
  if (engine_of(system) != "events")
    json.set("energy_change", counts.energy_change)
        .set("energy_error", energy_json(result.energy_error));
  add_steps(json, system, result.steps);
  add_reports(json, result.reports);
  json.set("digest", fmt::format("{:016x}", result.digest));
  json.set("decisions", decisions_json(result.decisions));
  if (const std::string none = why_one_by_one(system); !none.empty())
    json.set("lanes", Json()).set("no_lanes", none);
  else if (result.effort.steps > 0)
    json.set("lanes", Json::object()
                          .set("hits", result.effort.hits)
                          .set("left", result.effort.scalar)
                          .set("busy", result.effort.busy()));
  Json holes = Json::array();
  const std::vector<std::string> names = hole_names(*system.table);
  for (std::size_t i = 0; i < names.size(); ++i)
    holes.push(Json::object().set("name", names[i]).set("escaped", counts.hole_escapes[i]));
  json.set("holes", std::move(holes));
  Json by_time = Json::array(), by_hits = Json::array(), rates = Json::array();
  for (const auto& [t, p, low, high] : survival(counts))
    by_time.push(Json::object().set("t", t).set("p", p).set("low", low).set("high", high));
  for (const auto& [n, p, low, high] : survival_by_hits(counts))
    by_hits.push(Json::object().set("n", n).set("p", p).set("low", low).set("high", high));
  for (const auto& [t, from, to, value, low, high] : escape_rate(counts))
    rates.push(Json::object()
                   .set("t", t)
                   .set("from", from)
                   .set("to", to)
                   .set("value", value)
                   .set("low", low)
                   .set("high", high));
  json.set("survival", std::move(by_time));
  json.set("survival_hits", std::move(by_hits));
  json.set("rate", std::move(rates));
  if (const std::string note = repeated_starts(system); !note.empty()) json.set("note", note);
  if (!context.output.empty()) json.set("archive", context.output);
  return json;
}

std::string result_text(const System& system, const EscapeResult& result,
                        const EnsembleContext& context) {
  const SurvivalCounts& counts = result.counts;
  std::string text = doubts_of(system, result).text() +
                     fmt::format("{}\n", system.title.empty() ? system.name : system.title);
  text +=
      fmt::format("{} trajectories until t = {:.6g}, seed {}{}{}\n", grouped(counts.trajectories),
                  system.run.t_max, system.run.seed,
                  context.shard.of > 1 ? ", part " + text_of(context.shard) : "",
                  result.complete ? "" : "  (" + context.status + ": those that were finished)");
  if (const std::string note = repeated_starts(system); !note.empty()) text += note + '\n';
  text += survival_table(counts);
  text += fates(system, counts);
  if (engine_of(system) != "events") text += "\n" + energy_text(system, result.energy_error);
  const double hits = static_cast<double>(counts.collisions);
  const std::string steps = steps_text(system, result.steps);
  text += fmt::format(
      "\n{} collisions{}{} in {:.3g} s on {}{} thread{}: {}", grouped(counts.collisions),
      system.of_discs() ? fmt::format(" and {} contacts", grouped(counts.contacts)) : "",
      steps.empty() ? "" : ", " + steps, result.seconds,
      result.ranks > 1 ? fmt::format("{} processes of ", result.ranks) : "", result.threads,
      result.threads == 1 ? "" : "s",
      pace_text(system, counts.collisions, result.steps, result.seconds));
  if (counts.collisions > 0)
    text += fmt::format(", {:.3g} ns of CPU time each", 1e9 * result.cpu_seconds / hits);
  text += fmt::format("\n{}   digest {:016x}\n", decisions_text(result.decisions), result.digest);
  text += lanes_text(why_one_by_one(system), result.lanes, result.effort);
  if (!context.output.empty()) text += fmt::format("archive: {}\n", context.output);
  return text;
}

}  // namespace carom::cli
