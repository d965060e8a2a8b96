// What `carom returns` prints.
#include <fmt/format.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "analyses/returns/describe.hpp"
#include "carom/starts/sampler.hpp"
#include "carom/starts/start_measure.hpp"
#include "cli/common.hpp"
#include "cli/loading.hpp"
#include "cli/reports/aligned.hpp"
#include "cli/reports/ensemble_context.hpp"
#include "files/describe/json_out.hpp"

namespace carom::cli {

using files::Json;

namespace {

Json tail_json(const Distribution& d) {
  if (!d.tail) return {};
  return Json::object()
      .set("from", d.tail->from)
      .set("to", d.tail->to)
      .set("exponent", estimate_json(d.tail->exponent));
}

std::string table_of(const Distribution& d, const char* number, const EnsembleContext& context) {
  std::vector<double> from;
  std::vector<std::string> counts, longer;
  for (const std::size_t row : every_kth(d.bins.size(), context.rows)) {
    from.push_back(d.bins[row].from);
    counts.push_back(grouped(d.bins[row].count));
    longer.push_back(with_error(d.bins[row].longer));
  }
  std::string text = "\n" +
                     fitted({{number, times_text(from)},
                             {"returns in the bin", counts},
                             {fmt::format("fraction of {} or more", number), longer}}) +
                     rows_text(d.bins.size(), context);
  if (d.tail)
    text += fmt::format("local slope: fraction ~ {}^-a, {:.6g} <= {} <= {:.6g}: a = {}\n", number,
                        d.tail->from, number, d.tail->to, with_error(d.tail->exponent));
  return text;
}

std::string mean_text(const char* what, const Estimate& mean,
                      const std::optional<double>& expected) {
  std::string text = fmt::format("mean {}: {}", what, with_error(mean));
  if (expected) text += fmt::format("   (Kac's lemma: {:.6g})", *expected);
  return text + '\n';
}

}  // namespace

Doubts doubts_of(const System& system, const ReturnsResult& r) {
  return doubts_of(system, r.trajectories, "particle", r, r.reports, r.energy_error);
}

Json result_json(const System& system, const ReturnsResult& result,
                 const EnsembleContext& context) {
  Json json = ensemble_json(system, result, context);
  json.set("wall", system.table->wall(system.section.wall).name);
  Json starts = starts_json(with_starts_of_the_flow(system));
  if (starts_of_the_map(system)) starts.set("drawn", drawn_in_place(system));
  json.set("starts", std::move(starts));
  files::JsonOut out(json);
  analyses::describe(out, result, system);
  add_steps(json, system, result.steps);
  add_reports(json, result.reports);
  json.set("decisions", decisions_json(result.decisions));
  const Returns returns = returns_of(result.sums, system.run.t_max / 2);
  json.set("half", returns.half).set("excursions", returns.excursions);
  json.set("mean_time", estimate_json(returns.mean_time));
  json.set("mean_hits", estimate_json(returns.mean_hits));
  const std::optional<ExpectedReturns> expected = expected_returns(system);
  json.set("expected_time", expected ? Json(expected->time) : Json());
  json.set("expected_hits", expected ? Json(expected->hits) : Json());
  json.set("tail", tail_json(returns.times)).set("tail_hits", tail_json(returns.hits));
  if (const std::string note = repeated_starts(system); !note.empty()) json.set("note", note);
  if (!context.output.empty()) json.set("archive", context.output);
  return json;
}

std::string result_text(const System& system, const ReturnsResult& result,
                        const EnsembleContext& context) {
  const Returns returns = returns_of(result.sums, system.run.t_max / 2);
  const std::optional<ExpectedReturns> expected = expected_returns(system);
  std::string text = doubts_of(system, result).folded_text() +
                     head_text(system, result, system.run.t_max, context);
  if (const std::string note = repeated_starts(system); !note.empty()) text += folded(note) + '\n';
  if (starts_of_the_map(system))
    text += folded(fmt::format("starts: {}", drawn_in_place(system))) + '\n';
  if (const std::string why = why_not_stationary(with_starts_of_the_flow(system)); !why.empty())
    text += folded(fmt::format(
                "the starts are not stationary ({}): early excursions depend on them", why)) +
            '\n';
  text += fmt::format("\nReturns to {}: {} that begin until t = {:.6g}\n",
                      system.table->wall(system.section.wall).name,
                      counted(returns.excursions, "excursion"), returns.half);
  if (returns.excursions > 0) {
    text += table_of(returns.times, "t", context) + table_of(returns.hits, "n", context) + "\n";
    text += mean_text("return time", returns.mean_time,
                      expected ? std::optional(expected->time) : std::nullopt);
    text += mean_text("hits from return to return", returns.mean_hits,
                      expected ? std::optional(expected->hits) : std::nullopt);
  }
  if (const std::string others = fates_text(result); !others.empty()) text += others + '\n';
  return text + closing_text(system, result, result, context);
}

}  // namespace carom::cli
