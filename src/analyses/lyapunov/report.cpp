#include "cli/reports/ensemble_context.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "analyses/lyapunov/describe.hpp"
#include "analyses/lyapunov/report_parts.hpp"
#include "carom/engines/engine.hpp"
#include "cli/common.hpp"
#include "cli/loading.hpp"
#include "cli/reports/aligned.hpp"
#include "cli/reports/doubts.hpp"
#include "files/describe/json_out.hpp"

namespace carom::cli {

using files::Json;

namespace {

EngineOptions asked_of_engines(const System& system) {
  return {.deviations = {1.0}, .frame = system.run.spectrum};
}

// Do several particles make one orbit?
bool together(const System& system) { return system.particles.size() > 1 && interacts(system); }

// Of a particle: the flow's direction and the energy neither grow nor shrink, and areas are kept
// across them. Of several that are one orbit the largest alone is known without their spectrum.
Json spectrum_of(const System& system, const Estimate& largest) {
  Json list = Json::array();
  list.push(estimate_json(largest));
  if (together(system)) return list;
  for (int i = 0; i < 2; ++i) list.push(estimate_json({0.0, 0.0}));
  return list.push(estimate_json({0.0 - largest.value, largest.error}));
}

// Is the exponent that of the repeller? Where it drifts, orbits that stay tell more, if there are
// any.
bool of_repeller(const LyapunovResult& result) {
  return result.repeller && (!result.repeller->drifts() || result.growth.totals().orbits == 0);
}

// Why there is no exponent, as a phrase; "" where there is one.
std::string no_exponent(const System& system, const LyapunovResult& result,
                        const LyapunovEstimate& e) {
  if (const auto error = why_nothing(system, result)) return error->problem();
  if (of_repeller(result)) return {};
  if (e.law == LyapunovEstimate::Law::unknown)
    return "deviations have grown no more than linearly, as on regular orbits, and the run is too "
           "short to decide: take a longer one (--t-max)";
  if (result.growth.totals().orbits > 0 || result.repeller) return {};
  if (result.trajectories == 0) return "no trajectory was followed";
  return fmt::format("all {} ended before t = {:.6g}, the end of the window",
                     counted(result.trajectories, "particle"), result.growth.window().to);
}

// Why quasi-random starts give no error, as a phrase; "" where they do.
std::string why_no_error(const GrowthSums& sums, const LyapunovEstimate& e) {
  if (sums.totals().orbits == 0 || sums.parts().empty() || std::isfinite(e.per_time.error))
    return {};
  const auto without = std::count_if(sums.parts().begin(), sums.parts().end(),
                                     [](const auto& part) { return part.orbits == 0; });
  return no_errors(without, "followed no orbit to the end of the window");
}

// Why there is no share of chaotic orbits, as a phrase; "" where there is one.
std::string why_no_share(const GrowthSums& sums, const LyapunovEstimate& e) {
  using Law = LyapunovEstimate::Law;
  if (sums.totals().orbits == 0 || std::isfinite(e.chaotic_share.value)) return {};
  const double end = sums.window().to;
  if (sums.totals().chaotic > 0)
    return fmt::format(
        "a chaotic orbit shows after t = {:.3g} or so, and only runs three times as long can "
        "separate regular orbits from chaotic ones (--t-max {:.0f})",
        e.waiting_time, std::ceil(3.2 * e.waiting_time));
  if (e.law == Law::linear)
    return fmt::format(
        "no orbit has shown chaos by t = {:.6g}: they are regular, or their exponents are below "
        "{:.2g}",
        end, e.would_show);
  return fmt::format("no orbit has shown chaos by t = {:.6g}: longer runs can decide (--t-max)",
                     end);
}

const char* law_of(const LyapunovEstimate& e) {
  return e.law == LyapunovEstimate::Law::linear ? "linear" : "exponential";
}

void add_notes_of(const RepellerExponent& r, std::vector<std::string>& notes) {
  if (r.drifts())
    notes.push_back(fmt::format(
        "the exponent of the repeller still drifts: {} in the first half of the window "
        "and {} in the second. Take a longer run, unless the orbits that never leave are regular",
        with_error(r.early.limit.value, r.early.limit.error),
        with_error(r.late.limit.value, r.late.limit.error)));
  if (r.kicks_cost())
    notes.push_back(
        fmt::format("kicked copies leave earlier than others: the fraction of survivors is off by "
                    "{}({}) %, and the exponent by an unknown part of that",
                    in_percent(r.kick_cost.value), in_percent(r.kick_cost.error, 1)));
  if (r.trapped > 0.0)
    notes.push_back(fmt::format(
        "a fraction {:.2g} of the starts can never leave; the populations leave them out",
        r.trapped));
}

Json repeller_json(const RepellerExponent& r) {
  const auto json_of = [](const Extrapolated& e) {
    Json kicks = Json::array();
    for (const Mean& mean : e.at_kick)
      kicks.push(Json::object().set("value", mean.value).set("stderr", mean.error));
    return Json::object()
        .set("value", e.limit.value)
        .set("stderr", e.limit.error)
        .set("extrapolation", e.extrapolation)
        .set("low", e.low())
        .set("high", e.high())
        .set("at_kicks", std::move(kicks));
  };
  return Json::object()
      .set("lambda", json_of(r.per_time))
      .set("per_collision", json_of(r.per_hit))
      .set("early", json_of(r.early))
      .set("late", json_of(r.late))
      .set("drifts", r.drifts())
      .set("population", r.population)
      .set("repetitions", r.per_time.repetitions)
      .set("hits", Json::object().set("from", r.hits_from).set("to", r.hits))
      .set("time", Json::object().set("from", r.time_from).set("to", r.time))
      .set("kick", r.kick)
      .set("kick_cost",
           Json::object().set("value", r.kick_cost.value).set("stderr", r.kick_cost.error))
      .set("trapped", r.trapped);
}

std::string repeller_text(const RepellerExponent& r) {
  const Estimate per_time = r.estimate();
  const std::string exponent = fmt::format(
      "lambda = {} per unit time, of the repeller; the spectrum is lambda, 0, 0, -lambda",
      with_error(per_time.value, per_time.error));
  const std::string text =
      fmt::format("\n{}\n         {} per hit\n", folded(exponent, "    "),
                  with_error(r.per_hit.limit.value,
                             std::hypot(r.per_hit.limit.error, r.per_hit.extrapolation)));
  return text +
         folded(fmt::format(
             "95 %: {8:.6g} to {9:.6g}. The repeller is made of the orbits that never leave: {0} "
             "populations of {1} trajectories, in which survivors are copied with a kick of "
             "{2:.3g}, its half or its quarter, followed for {3} hits (t = {4:.6g}). Growth is "
             "taken from hit {5} (t = {7:.6g}) to hit {6}.",
             r.per_time.repetitions, grouped(r.population), r.kick, grouped(r.hits), r.time,
             grouped(r.hits_from), grouped(r.hits), r.time_from, r.per_time.low(),
             r.per_time.high())) +
         '\n';
}

// Doubts about the numbers, as phrases.
std::vector<std::string> notes_of(const System& system, const LyapunovResult& result,
                                  const LyapunovEstimate& e) {
  std::vector<std::string> notes;
  const GrowthSums::Totals& totals = result.growth.totals();
  if (result.repeller)
    add_notes_of(*result.repeller, notes);
  else if (is_open(system) && 2 * totals.orbits < result.trajectories)
    notes.push_back(fmt::format(
        "these orbits stay for the window, but may leave soon after it. The exponent of the orbits "
        "that never leave takes a whole run of at least {} trajectories",
        grouped(least_of_repeller())));
  if (totals.orbits == 0) return notes;
  if (std::string none = why_no_error(result.growth, e); !none.empty())
    notes.push_back(std::move(none));
  // Those that are one orbit are followed only as long as none of them ends.
  const std::uint64_t each = together(system) ? system.particles.size() : 1;
  const std::uint64_t followed = each * totals.orbits, met_none = uncounted(system, result);
  if (const std::uint64_t ended = result.trajectories - met_none - followed; ended > 0) {
    std::string note = fmt::format("{} ended before the end of the window; the numbers are for {}",
                                   counted(ended, "particle"), counted(followed, "other"));
    if (result.capped > 0)
      note +=
          fmt::format("; more --collisions would let {} of them continue", grouped(result.capped));
    notes.push_back(std::move(note));
  }
  if (!e.long_enough)
    notes.push_back(
        "the error may be too small: it grows with the length of the blocks, or the run is short. "
        "Take a longer one, or more trajectories");
  if (!of_repeller(result) && e.regular_bias > 0.5 * e.per_time.error)
    notes.push_back(
        fmt::format("some orbits may be regular or chaotic, the run is too short to decide. If "
                    "they are regular, lambda is too large by {:.2g}",
                    e.regular_bias));
  if (const std::string note = repeated_starts(system); !note.empty()) notes.push_back(note);
  for (std::string& note : drift_notes(system, result, e)) notes.push_back(std::move(note));
  return notes;
}

// Orbits that are regular for certain: until the run tells, none is.
std::uint64_t regular_orbits(const GrowthSums::Totals& t, const LyapunovEstimate& e) {
  return e.tells_regular ? t.linear : 0;
}

Json regularity_json(const GrowthSums& sums, const LyapunovEstimate& e) {
  const GrowthSums::Totals& t = sums.totals();
  const std::uint64_t regular = regular_orbits(t, e);
  Json at = Json::array();
  std::uint64_t found = 0;
  for (std::size_t look = 0; look < GrowthSums::looks; ++look) {
    found += t.chaotic_at[look];
    at.push(Json::object().set("t", sums.look_time(look)).set("chaotic", found));
  }
  return Json::object()
      .set("chaotic", t.chaotic)
      .set("regular", regular)
      .set("undecided", t.orbits - t.chaotic - regular)
      .set("found", std::move(at));
}

// Of growth that is not exponential.
std::string linear_text(const System& system, const GrowthSums& sums, const LyapunovEstimate& e) {
  std::string text = "lambda = 0: ";
  if (e.would_show > 0.0)
    text += fmt::format(
        "the deviations of {} grow linearly. An exponent above {:.2g} would have shown",
        sums.totals().orbits == 1 ? "the orbit"
                                  : fmt::format("all {} orbits", grouped(sums.totals().orbits)),
        e.would_show);
  else
    text += why_all_are_regular(system) + ", so deviations grow linearly";
  return '\n' + folded(text, "    ") +
         fmt::format("\ngrowth of deviations in {:.6g} <= t <= {:.6g}\n", sums.window().from,
                     sums.window().to);
}

std::string exponents_text(const System& system, const GrowthSums& sums,
                           const LyapunovEstimate& e) {
  if (e.law == LyapunovEstimate::Law::linear) return linear_text(system, sums, e);
  const std::string exponent =
      fmt::format("lambda = {} per unit time{}", with_error(e.per_time.value, e.per_time.error),
                  together(system) ? ", the largest" : "; the spectrum is lambda, 0, 0, -lambda");
  std::string text = '\n' + folded(exponent, "    ") + '\n';
  if (std::isfinite(e.per_hit.value))
    text += fmt::format("         {} per hit\n", with_error(e.per_hit.value, e.per_hit.error));
  text += fmt::format("growth of deviations in {:.6g} <= t <= {:.6g}\n", sums.window().from,
                      sums.window().to);
  if (!why_no_error(sums, e).empty()) {
    text += "no errors: see below\n";
  } else if (!sums.parts().empty()) {
    text += fmt::format("errors by {} replicates of the quasi-random starts\n", replicates);
  } else if (e.block_errors.empty()) {
    text += "too few orbits, or blocks of them, for an error\n";
  } else if (const auto& last = e.block_errors.back(); last.count == sums.totals().orbits) {
    text += fmt::format("errors by {}\n", counted(last.count, "orbit"));
  } else {
    std::string blocks = "error by blocks of length";
    for (std::size_t i = 0; i < e.block_errors.size(); i += 2)
      blocks += fmt::format("{} {:.4g}: {:.2g}", i == 0 ? "" : ",", e.block_errors[i].length,
                            e.block_errors[i].error);
    text += folded(blocks + fmt::format("; for the whole run: {:.2g}", e.per_time.error)) + '\n';
  }
  if (sums.blocks() > 1 && std::isfinite(e.per_time.error))
    text +=
        folded(fmt::format(
            "The error covers the stays near islands and between parallel walls that {} met, not "
            "longer and rarer ones",
            sums.totals().orbits == 1 ? "this orbit" : "these orbits")) +
        '\n';
  return text;
}

std::string distribution_text(const GrowthSums& sums) {
  const auto bins = distribution_of(sums);
  const auto n = static_cast<double>(sums.totals().orbits);
  if (n < 2.0) return {};
  std::string text =
      "growth rates of single orbits: the rate that a fraction of them stays below\n";
  std::vector<std::string> fractions, rates;
  for (const double fraction : {0.01, 0.1, 0.5, 0.9, 0.99}) {
    fractions.push_back(fmt::format("{:g}", fraction));
    rates.push_back(fmt::format("{:.4g}", quantile_of(bins, fraction)));
  }
  return text + fitted({{"fraction", fractions}, {"rate", rates}});
}

std::string regularity_text(const GrowthSums& sums, const LyapunovEstimate& e) {
  const GrowthSums::Totals& t = sums.totals();
  const std::uint64_t regular = regular_orbits(t, e);
  std::string text = "\n";
  if (const std::string reason = why_no_share(sums, e); !reason.empty())
    text += folded("no chaotic share: " + reason) + '\n';
  else if (e.share_interval.high > 0.0)
    text += fmt::format("chaotic share {:.4g} (95 %: {:.4g} to {:.4g})\n", e.chaotic_share.value,
                        e.share_interval.low, e.share_interval.high);
  else
    text += "chaotic share 0\n";
  std::string orbits = fmt::format("{} {} chaotic, {} {}, {} undecided",
                                   counted(t.chaotic, "orbit"), t.chaotic == 1 ? "is" : "are",
                                   grouped(regular), e.hidden > 0.0 ? "regular so far" : "regular",
                                   grouped(t.orbits - t.chaotic - regular));
  if (e.hidden > 0.0)
    orbits += fmt::format(
        "; the share includes {:.2g} for orbits that stick and look regular so far", e.hidden);
  text += folded(orbits) + '\n';
  if (std::isfinite(e.chaotic.value) && t.chaotic < t.orbits)
    text += fmt::format("lambda of the chaotic orbits = {}\n",
                        with_error(e.chaotic.value, e.chaotic.error));
  return text;
}

}  // namespace

Doubts doubts_of(const System& system, const LyapunovResult& r) {
  return doubts_of(system, r.trajectories, "particle", r, r.reports, r.energy_error);
}

Json result_json(const System& system, const LyapunovResult& result,
                 const EnsembleContext& context) {
  const GrowthSums& sums = result.growth;
  const LyapunovEstimate e = estimate_of(system, result);
  const std::string reason = no_exponent(system, result, e);
  Json json = ensemble_json(system, result, context);
  files::JsonOut out(json);
  analyses::describe(out, result, system);
  add_reports(json, result.reports);
  json.set("decisions", decisions_json(result.decisions));
  add_steps(json, system, result.steps);
  if (const std::string none = why_one_by_one(system, asked_of_engines(system)); !none.empty())
    json.set("no_lanes", none);
  json.set("window", Json::object().set("from", sums.window().from).set("to", sums.window().to));
  add_starts(json, system, result, e);
  const bool known = reason.empty();
  Estimate per_time = e.per_time, per_hit = e.per_hit;
  if (const auto& r = result.repeller; of_repeller(result)) {
    per_time = r->estimate();
    per_hit = {r->per_hit.limit.value,
               std::hypot(r->per_hit.limit.error, r->per_hit.extrapolation)};
  }
  json.set("lambda", known ? spectrum_of(system, per_time) : Json());
  json.set("per_collision",
           known && std::isfinite(per_hit.value) ? spectrum_of(system, per_hit) : Json());
  json.set("law", known ? Json(of_repeller(result) ? "exponential" : law_of(e)) : Json());
  if (known && !of_repeller(result) && e.would_show > 0.0) json.set("would_show", e.would_show);
  add_spectrum(json, system, result);
  json.set("repeller", result.repeller ? repeller_json(*result.repeller) : Json());
  if (!known) json.set("reason", reason);
  Json errors = Json::array(), bins = Json::array(), notes = Json::array();
  for (const auto& one : e.block_errors)
    errors.push(
        Json::object().set("length", one.length).set("count", one.count).set("stderr", one.error));
  if (!sums.parts().empty()) json.set("replicates", sums.parts().size());
  if (const std::string none = why_no_error(sums, e); !none.empty()) json.set("no_errors", none);
  json.set("block_errors", std::move(errors)).set("long_enough", e.long_enough);
  for (const ExponentBin& bin : distribution_of(sums))
    bins.push(Json::object().set("from", bin.from).set("to", bin.to).set("count", bin.count));
  json.set("distribution", std::move(bins));
  Json convergence = Json::array();
  for (const ExponentAt& point : convergence_of(result)) {
    Json row = Json::object();
    files::add_numbers(row, point);
    convergence.push(std::move(row));
  }
  json.set("convergence", std::move(convergence));
  json.set("chaotic_share", std::isfinite(e.chaotic_share.value)
                                ? estimate_json(e.chaotic_share)
                                      .set("low", e.share_interval.low)
                                      .set("high", e.share_interval.high)
                                      .set("hidden", e.hidden)
                                : Json());
  if (const std::string none = why_no_share(sums, e); !none.empty()) json.set("no_share", none);
  json.set("regularity", regularity_json(sums, e));
  json.set("chaotic_lambda", std::isfinite(e.chaotic.value) ? estimate_json(e.chaotic) : Json());
  for (const std::string& note : notes_of(system, result, e)) notes.push(note);
  json.set("notes", std::move(notes));
  if (!context.output.empty()) json.set("archive", context.output);
  return json;
}

std::string result_text(const System& system, const LyapunovResult& result,
                        const EnsembleContext& context) {
  const GrowthSums& sums = result.growth;
  const LyapunovEstimate e = estimate_of(system, result);
  std::string text = doubts_of(system, result).folded_text() +
                     head_text(system, result, sums.window().to, context) +
                     drawn_text(system, result);
  if (const std::string reason = no_exponent(system, result, e); !reason.empty()) {
    text += folded("\nThere is no exponent: " + reason + ".") + '\n';
  } else if (of_repeller(result)) {
    text += repeller_text(*result.repeller);
  } else {
    text += exponents_text(system, sums, e);
    text += spectrum_text(system, result, context);
  }
  if (sums.totals().orbits > 0) {
    text += distribution_text(sums);
    text += regularity_text(sums, e);
  }
  for (const std::string& note : notes_of(system, result, e)) text += folded(note) + '\n';
  if (const std::string ends = fates_text(result); !ends.empty())
    text += "\nof the particles: " + ends + "\n";
  return text + closing_text(system, result, result, context, asked_of_engines(system));
}

}  // namespace carom::cli
