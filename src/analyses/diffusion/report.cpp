#include "analyses/diffusion/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analyses/diffusion/describe.hpp"
#include "base/name_among.hpp"
#include "carom/engines/engine.hpp"
#include "cli/common.hpp"
#include "cli/loading.hpp"
#include "cli/reports/aligned.hpp"
#include "cli/reports/ensemble_context.hpp"
#include "files/describe/json_out.hpp"

namespace carom::cli {

using files::Json;

namespace {

using Kind = Horizon::Kind;

constexpr std::size_t corridors_in_text = 6, corridors_in_json = 1000;

const char* name_of(Kind kind) {
  return base::name_among<Kind::unknown>({"finite", "infinite", "bounded", "open plane", "unknown"},
                                         kind);
}

std::string moments_table(const std::vector<MomentPoint>& points, const EnsembleContext& context) {
  std::vector<double> times;
  std::vector<std::string> square, slope, exponent;
  for (const std::size_t row : every_kth(points.size(), context.rows)) {
    const MomentPoint& p = points[row];
    times.push_back(p.t);
    square.push_back(with_error(p.square));
    slope.push_back(p.t > 0 ? rounding_of(p.square.value / (4 * p.t),
                                          p.square.error / (4 * p.t))(p.square.value / (4 * p.t))
                            : "");
    exponent.push_back(std::isfinite(p.exponent.value) ? with_error(p.exponent) : "");
  }
  return "\n" +
         fitted({{"t", times_text(times)},
                 {"MSD", square},
                 {"MSD/4t", slope},
                 {"local exponent", exponent}}) +
         rows_text(points.size(), context);
}

// Correlations of the velocity at the same times, and their integral. Where not all times are
// shown, a third as many: both tables fit a screen.
std::string velocity_table(const std::vector<MomentPoint>& points, EnsembleContext context) {
  if (context.rows < points.size()) context.rows /= 3;
  std::vector<double> times;
  std::vector<std::string> correlation, green_kubo;
  for (const std::size_t row : every_kth(points.size(), context.rows)) {
    const MomentPoint& p = points[row];
    times.push_back(p.t);
    correlation.push_back(with_error(p.correlation));
    green_kubo.push_back(with_error(p.green_kubo));
  }
  return "\nC(t) = <v(t).v(0)>, and Green and Kubo's D(t), half its integral from 0 to t\n" +
         fitted({{"t", times_text(times)}, {"C(t)", correlation}, {"D(t)", green_kubo}});
}

std::string horizon_text(const Horizon& horizon) {
  if (horizon.corridors.list.empty()) return {};
  const auto& list = horizon.corridors.list;
  std::string text =
      fmt::format("\nFree corridors: {}{}\n   along                          width\n", list.size(),
                  horizon.corridors.complete ? "" : " found, not all directions searched");
  for (std::size_t i = 0; i < std::min(list.size(), corridors_in_text); ++i)
    text += fmt::format("   [{}, {}] = ({:.6g}, {:.6g}){:>{}}\n", list[i].direction.first,
                        list[i].direction.second, list[i].along.x, list[i].along.y,
                        fmt::format("{:.6g}", list[i].width), 12);
  if (list.size() > corridors_in_text) text += "   ...\n";
  if (horizon.kind == Kind::infinite)
    text += fmt::format("t P(no hit until t) -> {:.6g} at speed 1\n", horizon.flight_tail);
  else
    text += "The field bends all flights: the corridors end.\n";
  return text;
}

std::string fit_text(const DiffusionSummary& summary) {
  std::string text = "\n";
  const auto& fit = summary.fit;
  if (!summary.no_D.empty())
    text += folded(fmt::format("D {}: {}.",
                               summary.estimable ? "does not exist" : "cannot be estimated",
                               summary.no_D)) +
            '\n';
  if (fit && summary.no_D.empty())
    text += folded(fmt::format("D = {}   from MSD = 4 D t + c, c = {}", with_error(fit->D),
                               with_error(fit->offset)),
                   "    ") +
            '\n';
  if (!summary.note.empty()) text += folded("    " + summary.note, "    ") + '\n';
  if (summary.horizon.machta_zwanzig)
    text += fmt::format("    {:.6g} by Machta and Zwanzig, for narrow gaps\n",
                        *summary.horizon.machta_zwanzig);
  if (!fit) return text;
  if (std::isfinite(fit->exponent.value))
    text += fmt::format("exponent a = {}   from MSD = A t^a + c", with_error(fit->exponent));
  else if (fit->points < 4)
    text += "exponent a of MSD = A t^a + c needs four times in the window";
  else
    text += "MSD = A t^a + c has no best exponent a between 0.05 and 4";
  text += fmt::format(
      "\nslope of ln MSD against ln t: {}\n"
      "window {:.6g} <= t <= {:.6g}, {} times\n",
      with_error(fit->local_exponent), fit->window.from, fit->window.to, fit->points);
  if (fit->local_exponent.error > 0.0)
    text += "errors by the jackknife over groups of trajectories\n";
  return text;
}

// Does the MSD grow as t in the window? What is compared with its error is far beyond chance.
std::vector<std::string> doubts_of_growth(const DiffusionFit& fit,
                                          const std::vector<MomentPoint>& points) {
  std::vector<std::string> doubts;
  // With few times the offset c cannot be fitted: then the slope of ln MSD is taken.
  const bool enough = std::isfinite(fit.exponent.value);
  const Estimate& a = enough ? fit.exponent : fit.local_exponent;
  const double off = std::abs(a.value - 1);
  if (fit.local_exponent.value < 0.5)  // it has hardly begun to grow, or never will
    doubts.emplace_back(
        "the MSD hardly grows in the window: particles may stay near their starts, where D is 0");
  else if (!(off <= 5 * a.error) && (off > 0.05 || (enough && a.error > 0)))
    doubts.emplace_back("the MSD does not grow as t in the window: D depends on it");
  const auto at = [&](double t) {
    return std::find_if(points.begin(), points.end(),
                        [&](const MomentPoint& p) { return p.t >= t; });
  };
  const auto first = at(fit.window.from), last = at(fit.window.to);
  if (last == points.end()) return doubts;
  // <r^4> / <r^2>^2 is 2 of a diffusion, and (20 / n)^(1/2) its error for n particles.
  const auto kurtosis = [](const MomentPoint& p) {
    return p.fourth.value / (p.square.value * p.square.value);
  };
  const double count = static_cast<double>(last->count), k = kurtosis(*last);
  if (k > 2.0 + std::max(0.3, 5.0 * std::sqrt(20.0 / count)) && k > 1.1 * kurtosis(*first))
    doubts.push_back(fmt::format(
        "few particles move much farther than the others, ever more so (<r^4> = {:.3g} <r^2>^2; 2 "
        "where they diffuse): if their orbits never turn, D does not exist",
        k));
  return doubts;
}

}  // namespace

Doubts doubts_of(const System& system, const DiffusionResult& r) {
  return doubts_of(system, r.trajectories, "particle", r, r.reports, r.energy_error);
}

DiffusionSummary summary_of(const System& system, const DiffusionResult& result) {
  const auto add = [](std::string& note, const std::string& more) {
    if (!more.empty()) note += (note.empty() ? "" : "; ") + more;
  };
  DiffusionSummary summary;
  summary.horizon = horizon_of(system);
  summary.no_D = no_diffusion(summary.horizon);
  const DisplacementMoments moments(result.sums, system.particles.size());
  summary.points = moments.points();
  const auto& window = system.run.window;
  const TimeWindow asked =
      window ? TimeWindow{window->first, window->second} : moments.default_window();
  summary.fit = moments.fit(asked);
  if (summary.fit && summary.no_D.empty())
    for (const std::string& doubt : doubts_of_growth(*summary.fit, summary.points))
      add(summary.note, doubt);
  // A cap first ends the particles that hit most often.
  if (result.capped > 0 && summary.fit && summary.no_D.empty()) {
    const auto last =
        std::find_if(summary.points.rbegin(), summary.points.rend(),
                     [&](const MomentPoint& p) { return p.t <= summary.fit->window.to; });
    if (last != summary.points.rend() && last->count < result.trajectories)
      add(summary.note,
          "the cap on hits ended particles before the window's end: only those with few hits "
          "remain");
  }
  if (result.escaped + result.unbounded > 0)
    add(summary.note, "particles left: the MSD is that of those that are still there");
  add(summary.note, repeated_starts(system));
  add(summary.note, correlation_note(system));
  if (!summary.fit && summary.no_D.empty()) {
    summary.estimable = false;
    const auto times = std::count_if(summary.points.begin(), summary.points.end(),
                                     [&](const MomentPoint& p) { return asked.holds(p.t); });
    summary.no_D =
        result.trajectories == 0 ? "no trajectory was followed"
        : times < 2
            ? "fewer than two report times > 0 in the window"
            : "no particle was there or had moved, or squares of displacements are too small for "
              "doubles, at the times of the window";
  }
  return summary;
}

Json result_json(const System& system, const DiffusionResult& result,
                 const EnsembleContext& context) {
  const DiffusionSummary summary = summary_of(system, result);
  Json json = ensemble_json(system, result, context);
  files::JsonOut out(json);
  analyses::describe(out, result, system);
  if (system.has_forces()) json.set("energy_change", result.energy_change);
  add_steps(json, system, result.steps);
  add_reports(json, result.reports);
  json.set("starts", starts_json(system));
  json.set("decisions", decisions_json(result.decisions));
  if (const std::string none = why_one_by_one(system); !none.empty()) json.set("no_lanes", none);
  Json msd = Json::array(), fourth = Json::array(), local = Json::array(),
       correlation = Json::array(), green_kubo = Json::array(), corridors = Json::array();
  const auto at = [](double t, const Estimate& e) {
    return Json::object().set("t", t).set("value", e.value).set("stderr", e.error);
  };
  for (const MomentPoint& p : summary.points) {
    msd.push(at(p.t, p.square));
    fourth.push(at(p.t, p.fourth));
    correlation.push(at(p.t, p.correlation));
    green_kubo.push(at(p.t, p.green_kubo));
    if (std::isfinite(p.exponent.value)) local.push(at(p.middle, p.exponent));
  }
  json.set("msd", std::move(msd));
  json.set("fourth_moment", std::move(fourth));
  json.set("correlation", std::move(correlation));
  json.set("green_kubo", std::move(green_kubo));
  json.set("D", summary.no_D.empty() ? estimate_json(summary.fit->D) : Json());
  if (!summary.no_D.empty()) json.set("reason", summary.no_D);
  if (!summary.note.empty()) json.set("note", summary.note);
  json.set("exponent", summary.fit ? estimate_json(summary.fit->exponent) : Json());
  json.set("local_exponent", summary.fit ? estimate_json(summary.fit->local_exponent) : Json());
  json.set("local_exponents", std::move(local));
  if (summary.fit) {
    json.set("offset", estimate_json(summary.fit->offset));
    json.set("window", Json::object()
                           .set("from", summary.fit->window.from)
                           .set("to", summary.fit->window.to)
                           .set("times", summary.fit->points));
  }
  const Horizon& horizon = summary.horizon;
  json.set("horizon", name_of(horizon.kind));
  for (std::size_t i = 0; i < std::min(horizon.corridors.list.size(), corridors_in_json); ++i) {
    const geometry::Corridor& c = horizon.corridors.list[i];
    Json cell = Json::array(), along = Json::array();
    cell.push(c.direction.first).push(c.direction.second);
    along.push(c.along.x).push(c.along.y);
    corridors.push(Json::object()
                       .set("direction", std::move(cell))
                       .set("along", std::move(along))
                       .set("width", c.width));
  }
  json.set("corridors", std::move(corridors));
  if (horizon.kind == Kind::infinite) json.set("flight_tail", horizon.flight_tail);
  if (result.free_paths.counted()) json.set("free_paths", free_paths_json(system, result));
  if (horizon.machta_zwanzig) json.set("machta_zwanzig", *horizon.machta_zwanzig);
  if (!context.output.empty()) json.set("archive", context.output);
  return json;
}

std::string result_text(const System& system, const DiffusionResult& result,
                        const EnsembleContext& context) {
  const DiffusionSummary summary = summary_of(system, result);
  std::string text = doubts_of(system, result).folded_text() +
                     head_text(system, result, system.run.times.back(), context);
  text += moments_table(summary.points, context);
  text += velocity_table(summary.points, context);
  text += fit_text(summary);
  text += horizon_text(summary.horizon);
  text += free_paths_text(system, result, summary.horizon, context);
  if (const std::string ends = fates_text(result); !ends.empty())
    text += "\nof the particles: " + ends + "\n";
  return text + closing_text(system, result, result, context);
}

}  // namespace carom::cli
