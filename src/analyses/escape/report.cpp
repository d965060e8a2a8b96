#include "cli/reports/ensemble_context.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "analyses/escape/describe.hpp"
#include "analyses/escape/report_decay.hpp"
#include "carom/engines/engine.hpp"
#include "carom/table/hole_names.hpp"
#include "cli/common.hpp"
#include "cli/loading.hpp"
#include "cli/reports/aligned.hpp"
#include "cli/reports/doubts.hpp"
#include "files/describe/json_out.hpp"
#include "files/progress.hpp"

namespace carom::cli {

using files::Json;

namespace {

std::string numbers_of(const Decay& decay) {
  std::string text = fmt::format("{} = {}", rate_name(decay.law, decay.local),
                                 with_error(decay.rate, decay.rate_error));
  text += fmt::format(", A = {}", with_error(decay.amplitude, decay.amplitude_error));
  if (decay.with_plateau)
    text += fmt::format(", P_infinity = {}", with_error(decay.plateau, decay.plateau_error));
  return folded(text, "    ");
}

Json json_of(const Decay& decay) {
  Json json = Json::object().set("model", name_of(decay));
  json.set(decay.law == DecayLaw::exponential ? "rate" : "exponent", decay.rate)
      .set("stderr", decay.rate_error)
      .set("local_slope", decay.local)
      .set("amplitude", decay.amplitude)
      .set("amplitude_stderr", decay.amplitude_error);
  if (decay.with_plateau)
    json.set("plateau", decay.plateau).set("plateau_stderr", decay.plateau_error);
  return json.set("p_value", decay.p_value);
}

}  // namespace

std::string formula_of(DecayLaw law, bool with_plateau, const char* variable) {
  return fmt::format("P({}) = A ", variable) +
         (law == DecayLaw::exponential ? fmt::format("exp(-kappa {})", variable)
                                       : fmt::format("{}^-a", variable)) +
         (with_plateau ? " + P_infinity" : "");
}

std::string rate_name(DecayLaw law, bool local) {
  return fmt::format("    {}{}", local ? "local slope: " : "",
                     law == DecayLaw::exponential ? "kappa" : "a");
}

Json decay_json(const DecayFit& fit) {
  if (fit.decays.empty()) return Json::object().set("model", Json()).set("reason", fit.why_none);
  Json json = json_of(fit.decays.front());
  json.set("decided", fit.decided)
      .set("window", Json::array().push(fit.from).push(fit.to))
      .set("escapes", fit.escapes);
  Json others = Json::array();
  for (std::size_t i = 1; i < fit.decays.size(); ++i)
    others.push(json_of(fit.decays[i]).set("odds", odds(fit.decays[i], fit.decays[0])));
  return json.set("alternatives", std::move(others));
}

std::string decay_text(const DecayFit& fit) {
  if (fit.decays.empty())
    return "\n" + folded(fmt::format("No decay was fitted: {}.", fit.why_none)) + "\n";
  std::string text = fmt::format("\nDecay from t = {:.4g} to {:.4g}, {}\n", fit.from, fit.to,
                                 counted(fit.escapes, "escape"));
  const std::size_t shown = fit.decided ? 1 : 2;
  if (!fit.decided) text += not_told_apart;
  for (std::size_t i = 0; i < shown; ++i) {
    const Decay& decay = fit.decays[i];
    text += fmt::format("  {}\n{}\n    p-value {:.2g}{}\n",
                        formula_of(decay.law, decay.with_plateau, "t"), numbers_of(decay),
                        decay.p_value,
                        decay.p_value < hardly ? ": the law does not describe this window" : "");
  }
  if (fit.decays.size() > shown) {
    const double ratio = odds(fit.decays[shown], fit.decays[0]);
    text += fmt::format("  next: {}, {} times as likely\n", name_of(fit.decays[shown]),
                        ratio < 1e-9 ? "less than 1e-9" : fmt::format("{:.2g}", ratio));
  }
  return text;
}

std::string decay_by_hits_text(const DecayFit& fit) {
  if (fit.decays.empty()) return "";
  const Decay& decay = fit.decays.front();
  return fmt::format("By number of hits from n = {:.4g} to {:.4g}{}\n  {}\n{}\n", fit.from, fit.to,
                     fit.decided ? "" : ", not decided",
                     formula_of(decay.law, decay.with_plateau, "n"), numbers_of(decay));
}

namespace {

// The counts at some of the report times: rates are then those between these times.
SurvivalCounts at_rows(const SurvivalCounts& all, const std::vector<std::size_t>& rows) {
  SurvivalCounts some = all;
  some.times.clear();
  for (const std::size_t row : rows) some.times.push_back(all.times[row]);
  const auto join = [&](std::vector<std::uint64_t>& gone_in) {
    std::size_t from = 0;
    for (std::size_t i = 0; i < rows.size(); from = rows[i++] + 1)
      gone_in[i] = std::accumulate(gone_in.begin() + static_cast<std::ptrdiff_t>(from),
                                   gone_in.begin() + static_cast<std::ptrdiff_t>(rows[i]) + 1,
                                   std::uint64_t{0});
    gone_in.resize(rows.size());
  };
  join(some.gone_in);
  for (Replicate& part : some.parts) join(part.gone_in);
  return some;
}

// A share or rate and the ends of its interval, with the digits that a standard error allows.
void add_estimate(double value, double low, double high, std::vector<std::string>& values,
                  std::vector<std::string>& lows, std::vector<std::string>& highs) {
  constexpr double width = 4;  // of a 95 % interval, in standard errors
  const Rounding rounded = rounding_of(value > 0.0 ? value : high, (high - low) / width);
  values.push_back(rounded(value));
  lows.push_back(rounded(low));
  highs.push_back(rounded(high));
}

std::vector<Column> survival_columns(const SurvivalCounts& all, std::size_t rows) {
  const SurvivalCounts counts = at_rows(all, every_kth(all.times.size(), rows));
  const auto rates = escape_rate(counts);
  auto rate = rates.begin();  // both lists in the order of time
  std::vector<std::string> p, low, high, value, least, most;
  for (const SurvivalPoint& point : survival(counts)) {
    add_estimate(point.p, point.low, point.high, p, low, high);
    while (rate != rates.end() && rate->to < point.t) ++rate;
    if (rate != rates.end() && rate->to == point.t)
      add_estimate(rate->value, rate->low, rate->high, value, least, most);
    else
      for (auto* const none : {&value, &least, &most}) none->emplace_back();
  }
  const char* const interval = "95 % interval";
  return {{"t", times_text(counts.times)},
          {"p(t)", p},
          {interval, ranges(low, high), true, true},
          {"-dP/dt since\nthe row above", value},
          {interval, ranges(least, most), true, true}};
}

// Of many trajectories numbers are so long that rates follow in a table of their own. Where not all
// times are shown, both have half as many rows: then they fit a screen.
std::string survival_table(const SurvivalCounts& all, const EnsembleContext& context) {
  std::vector<Column> columns = survival_columns(all, context.rows);
  if (all.times.size() > context.rows && width_of(aligned(columns)) > line_width)
    columns = survival_columns(all, context.rows / 2);
  return "\n" + fitted(columns) + rows_text(all.times.size(), context);
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
  line("  unbounded", counts.unbounded, "no wall follows", false);
  line("survived", counts.survived, "", true);
  line("  pinned", counts.pinned, "circles that never hit", false);
  line("  capped", counts.capped, "by the limit on hits", false);
  line("singular", counts.singular, "corners, or along a wall", false);
  line("unresolved", counts.unresolved, "could not be followed", false);
  line("lost", counts.lost, "internal error: report it", false);
  return text;
}

// Why quasi-random starts give no intervals but that of 0 to 1, as a phrase; "" where they do.
std::string why_no_error(const SurvivalCounts& counts) {
  return no_errors(std::count_if(counts.parts.begin(), counts.parts.end(),
                                 [](const Replicate& part) { return part.followed == 0; }),
                   "followed no trajectory");
}

}  // namespace

Doubts doubts_of(const System& system, const EscapeResult& r) {
  return doubts_of(system, r.counts.trajectories, "trajectory", r.counts, r.reports,
                   r.energy_error);
}

Json result_json(const System& system, const EscapeResult& result, const EnsembleContext& context) {
  const SurvivalCounts& counts = result.counts;
  Json json = ensemble_json(system, result, context);
  files::JsonOut out(json);
  analyses::describe(out, result, system);
  add_steps(json, system, result.steps);
  add_reports(json, result.reports);
  json.set("decisions", decisions_json(result.decisions));
  if (const std::string none = why_one_by_one(system); !none.empty())
    json.set("lanes", Json()).set("no_lanes", none);
  else
    json.set("lanes", result.effort.steps == 0 ? Json()
                                               : Json::object()
                                                     .set("hits", result.effort.hits)
                                                     .set("left", result.effort.scalar)
                                                     .set("busy", result.effort.busy()));
  Json holes = Json::array();
  const std::vector<std::string> names = hole_names(*system.table);
  const std::vector<ExitPoint> by_hole = exits(counts);
  for (std::size_t i = 0; i < names.size(); ++i)
    holes.push(Json::object()
                   .set("name", names[i])
                   .set("escaped", counts.hole_escapes[i])
                   .set("p", by_hole[i].p)
                   .set("low", by_hole[i].low)
                   .set("high", by_hole[i].high));
  json.set("holes", std::move(holes));
  if (!counts.parts.empty()) json.set("replicates", counts.parts.size());
  if (const std::string none = why_no_error(counts); !none.empty()) json.set("no_errors", none);
  json.set("fit", decay_json(decay_of(system, result)));
  json.set("fit_hits", decay_json(fit_decay_by_hits(counts)));
  if (const std::string note = repeated_starts(system); !note.empty()) json.set("note", note);
  if (!context.output.empty()) json.set("archive", context.output);
  return json;
}

std::string result_text(const System& system, const EscapeResult& result,
                        const EnsembleContext& context) {
  const SurvivalCounts& counts = result.counts;
  std::string text = doubts_of(system, result).folded_text() +
                     head_text(system, result, system.run.t_max, context);
  if (const std::string note = repeated_starts(system); !note.empty()) text += folded(note) + '\n';
  text += survival_table(counts, context);
  if (const std::string none = why_no_error(counts); !none.empty())
    text += folded(none) + '\n';
  else if (!counts.parts.empty())
    text += fmt::format("intervals by {} replicates of the quasi-random starts\n", replicates);
  text += decay_text(decay_of(system, result));
  text += decay_by_hits_text(fit_decay_by_hits(counts));
  text += fates(system, counts);
  return text + closing_text(system, result, counts, context, {}, result.effort);
}

}  // namespace carom::cli
