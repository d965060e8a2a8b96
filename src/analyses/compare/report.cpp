#include "analyses/compare/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "cli/common.hpp"
#include "cli/reports/aligned.hpp"
#include "cli/reports/doubts.hpp"

namespace carom::cli {

using files::Json;

namespace {

// "5.98(3)": the error of the last digit in brackets.
std::string in_brackets(const MeasuredNumber& number) {
  int decimals = number.error > 0.0 ? static_cast<int>(std::ceil(-std::log10(number.error))) : 3;
  decimals = std::clamp(decimals, 0, 3);
  constexpr double units[] = {1.0, 0.1, 0.01, 0.001};
  const double unit = units[decimals];
  return fmt::format("{:.{}f}({:.0f})", number.value, decimals,
                     std::max(1.0, std::ceil(number.error / unit)));
}

// The differences cannot tell the form's change from their own error.
constexpr double errors_of_areas = 4.0;
// Steps that change along the displacements make no smooth map: where the differences err by more,
// they show nothing.
constexpr double largest_error_of_areas = 1e-6;
bool shows_areas(const ComparedScheme& scheme) {
  return scheme.areas && scheme.areas->error <= largest_error_of_areas;
}
std::optional<bool> symplectic(const ComparedScheme& scheme) {
  if (!shows_areas(scheme)) return {};
  return scheme.areas->value <= errors_of_areas * scheme.areas->error;
}

const char* yes_or_no(const std::optional<bool>& known) {
  return !known ? "-" : *known ? "yes" : "no";
}
double control(const WorkForError& work) { return work.step > 0.0 ? work.step : work.tolerance; }
double control(const ComparedRun& run) { return run.step > 0.0 ? run.step : run.tolerance; }

std::string head_text(const System& system, const Comparison& result) {
  std::string text = heading(system);
  text += fmt::format("until t = {:.6g}, where small errors have grown by a factor of {:.3g}\n",
                      result.t, result.growth);
  if (result.exact)
    text += fmt::format("reference: exact flights, {}, rounding {:.1e}\n",
                        counted(result.hits, "hit"), result.reference_error);
  else
    text += fmt::format("reference: {} with steps of {:.4g}, error {:.1e}\n", result.reference,
                        result.reference_step, result.reference_error);
  text += folded(fmt::format("error: the larger of |dx|/{:.4g} and |dv|/{:.4g}, the largest at "
                             "eight times in the second half",
                             result.size, result.speed),
                 "  ") +
          "\n";
  if (result.longest_resolved > 0.0)
    text += fmt::format("longest step that resolves the forces, of those tried: {:.4g}\n",
                        result.longest_resolved);
  return text;
}

std::string schemes_table(const Comparison& result) {
  std::vector<Column> columns{{"\nscheme", {}, true},     {"\norder", {}},      {"\nmeasured", {}},
                              {"step or\ntolerance", {}}, {"force\nevals", {}}, {"CPU\ntime", {}},
                              {"way\nback", {}},          {"area\nkept", {}}};
  for (const ComparedScheme& scheme : result.schemes) {
    columns[0].cells.push_back(scheme.name);
    columns[1].cells.push_back(scheme.order > 0 ? fmt::format("{}", scheme.order) : "-");
    columns[2].cells.push_back(scheme.measured.slope ? in_brackets(*scheme.measured.slope) : "-");
    const auto of_work = [&](const std::string& text) {
      return scheme.work ? text : std::string("-");
    };
    const WorkForError work = scheme.work.value_or(WorkForError{});
    columns[3].cells.push_back(of_work(fmt::format("{:.2g}", control(work))));
    columns[4].cells.push_back(of_work(fmt::format("{:.3g}", std::round(work.force_evaluations))));
    columns[5].cells.push_back(of_work(short_duration(work.cpu_seconds)));
    columns[6].cells.emplace_back(yes_or_no(scheme.reversible));
    columns[7].cells.emplace_back(yes_or_no(symplectic(scheme)));
  }
  return fitted(columns);
}

std::string runs_table(const ComparedScheme& scheme) {
  std::vector<Column> columns{{scheme.adaptive ? "tolerance" : "step", {}},
                              {"error of\nstate", {}},
                              {"of\nenergy", {}},
                              {"trend a\ntime", {}},
                              {"of hit\ntimes", {}},
                              {"there\nand back", {}},
                              {"force\nevals", {}},
                              {"CPU\ntime", {}}};
  for (const ComparedRun& run : scheme.runs) {
    const auto number = [&](double x) {
      return run.failed() || std::isnan(x) ? std::string("-") : fmt::format("{:.1e}", x);
    };
    columns[0].cells.push_back(fmt::format("{:.4g}", control(run)));
    columns[1].cells.push_back(number(run.error_state));
    columns[2].cells.push_back(number(run.error_energy));
    columns[3].cells.push_back(run.failed() || std::fabs(run.energy_trend) > 2.0 * run.trend_error
                                   ? number(run.energy_trend)
                                   : std::string("none"));
    columns[4].cells.push_back(run.hits > 0 ? number(run.error_hit_time) : "-");
    columns[5].cells.push_back(number(run.error_reversal));
    columns[6].cells.push_back(fmt::format("{}", run.force_evaluations));
    columns[7].cells.push_back(run.failed() ? "-" : short_duration(run.cpu_seconds));
  }
  return fmt::format("\n{}\n{}", scheme.name, fitted(columns));
}

// Why it is not known whether areas are kept, as a phrase; "" where it is.
std::string why_no_areas(const ComparedScheme& scheme) {
  if (shows_areas(scheme)) return {};
  if (scheme.areas)
    return fmt::format("the differences err by {:.1g}: the steps change along them",
                       scheme.areas->error);
  return scheme.areas_step > 0.0
             ? fmt::format("none of the steps of {:.3g} that were tried lies between hits",
                           scheme.areas_step)
             : "none of its steps could be followed";
}

std::string notes_text(const Comparison& result) {
  std::string text;
  std::map<std::string, std::string> reasons;
  std::string failed;
  const auto add = [&](const std::string& what, const std::string& name) {
    std::string& names = reasons[what];
    names += (names.empty() ? "" : ", ") + name;
  };
  for (const ComparedScheme& scheme : result.schemes) {
    if (!scheme.measured.slope && !scheme.adaptive)
      add(fmt::format("no order ({})", scheme.measured.reason), scheme.name);
    if (const std::string why = why_no_areas(scheme); !why.empty())
      add(fmt::format("areas not measured ({})", why), scheme.name);
    for (const ComparedRun& run : scheme.runs)
      if (run.failed()) {
        failed +=
            folded(fmt::format("{} at {:.4g}: {}", scheme.name, control(run), run.failure), "  ") +
            "\n";
        break;
      }
  }
  for (const auto& [reason, names] : reasons)
    text += folded(fmt::format("{}: {}", reason, names), "  ") + "\n";
  return text + failed;
}

std::string best_text(const Comparison& result) {
  if (!result.cheapest)
    return fmt::format("no scheme reaches an error of {:.1e} with these steps\n", result.error);
  const ComparedScheme& cheapest = result.schemes[*result.cheapest];
  std::string text =
      folded(fmt::format("cheapest for an error of {:.1e}: {}, {} {:.2g}, {:.4g} force evaluations",
                         result.error, cheapest.name, cheapest.adaptive ? "tolerance" : "step",
                         control(*cheapest.work), std::round(cheapest.work->force_evaluations))) +
      "\n";
  const ComparedScheme& fastest = result.schemes[*result.fastest];
  text += fmt::format("least CPU time: {}, {}\n", fastest.name,
                      short_duration(fastest.work->cpu_seconds));
  return text;
}

Json number_if(bool known, double value) { return known ? Json(value) : Json(); }
Json flag_if(const std::optional<bool>& known) { return known ? Json(*known) : Json(); }

// A row of `schemes`.
Json run_json(const ComparedScheme& scheme, const ComparedRun& run) {
  const bool good = !run.failed();
  Json json = Json::object();
  json.set("scheme", scheme.name);
  json.set(scheme.adaptive ? "tolerance" : "step", control(run));
  json.set("order", scheme.measured.slope ? Json(scheme.measured.slope->value) : Json());
  json.set("error_state", number_if(good, run.error_state));
  json.set("error_position", number_if(good, run.error_position));
  json.set("error_velocity", number_if(good, run.error_velocity));
  json.set("error_energy", number_if(good, run.error_energy));
  json.set("energy_trend", Json::object()
                               .set("value", number_if(good, run.energy_trend))
                               .set("stderr", number_if(good, run.trend_error)));
  json.set("hits", Json::object()
                       .set("same", run.hits)
                       .set("all_same", good && run.same_hits)
                       .set("error_time", number_if(good, run.error_hit_time))
                       .set("error_place", number_if(good, run.error_hit_place)));
  json.set("error_reversal", number_if(good, run.error_reversal));
  json.set("rounding", number_if(good, run.rounding));
  json.set("steps", run.steps);
  json.set("force_evaluations", run.force_evaluations);
  json.set("unresolved_steps", run.unresolved);
  json.set("cpu_seconds", number_if(good, run.cpu_seconds));
  json.set("failure", good ? Json() : Json(run.failure));
  return json;
}

Json work_json(const ComparedScheme& scheme) {
  if (!scheme.work) return {};
  return Json::object()
      .set("scheme", scheme.name)
      .set(scheme.adaptive ? "tolerance" : "step", control(*scheme.work))
      .set("force_evaluations", scheme.work->force_evaluations)
      .set("cpu_seconds", scheme.work->cpu_seconds);
}

// A row of `measured`.
Json scheme_json(const ComparedScheme& scheme) {
  const MeasuredOrder& order = scheme.measured;
  return Json::object()
      .set("scheme", scheme.name)
      .set("stated", scheme.order > 0 ? Json(scheme.order) : Json())
      .set("order", number_if(order.slope.has_value(), order.slope ? order.slope->value : 0.0))
      .set("order_error",
           number_if(order.slope.has_value(), order.slope ? order.slope->error : 0.0))
      .set("from", number_if(order.steps > 0, order.longest))
      .set("to", number_if(order.steps > 0, order.shortest))
      .set("steps", order.steps)
      .set("reason", order.slope ? Json() : Json(order.reason))
      .set("reversible", flag_if(scheme.reversible))
      .set("symplectic", flag_if(symplectic(scheme)))
      .set("areas", number_if(scheme.areas.has_value(), scheme.areas ? scheme.areas->value : 0.0))
      .set("areas_error",
           number_if(scheme.areas.has_value(), scheme.areas ? scheme.areas->error : 0.0))
      .set("areas_step", number_if(scheme.areas.has_value(), scheme.areas_step))
      .set("areas_reason", shows_areas(scheme) ? Json() : Json(why_no_areas(scheme)))
      .set("work", work_json(scheme));
}

}  // namespace

std::string compare_text(const System& system, const Comparison& result, const std::string& archive,
                         bool verbose) {
  std::string text = head_text(system, result);
  text += fmt::format("\nsteps, force evaluations and CPU time for an error of {:.1e}:\n\n",
                      result.error);
  text += schemes_table(result) + "\n" + best_text(result) + notes_text(result);
  if (verbose)
    for (const ComparedScheme& scheme : result.schemes) text += runs_table(scheme);
  if (!result.complete) text += "interrupted: only the finished schemes\n";
  text += grounds_text("state (reference), orders, way back, areas", "other starts, later times");
  if (!verbose) text += "--verbose prints every step";
  text += archive.empty() ? (verbose ? "-o FILE.h5 stores all\n" : ", -o FILE.h5 stores them\n")
                          : fmt::format("{}archive: {}\n", verbose ? "" : "\n", archive);
  return text;
}

namespace {

Json end_json(const std::vector<ComparedEnd>& end) {
  Json list = Json::array();
  for (const ComparedEnd& at : end)
    list.push(Json::object().set("x", at.x).set("y", at.y).set("vx", at.vx).set("vy", at.vy));
  return list;
}

}  // namespace

Json compare_json(const System& system, const Comparison& result, const std::string& archive) {
  Json json = Json::object();
  add_common_keys(json, system, 1, result.seconds, result.cpu_seconds);
  json.set("status", result.complete ? "completed" : "interrupted");
  json.set("t", result.t);
  json.set("growth", result.growth);
  json.set("size", result.size);
  json.set("speed", result.speed);
  json.set("reference",
           Json::object()
               .set("scheme", result.exact ? Json("exact flights") : Json(result.reference))
               .set("step", number_if(!result.exact, result.reference_step))
               .set("error", result.reference_error)
               .set("hits", result.hits)
               .set("end", end_json(result.end)));
  json.set("longest_resolved", number_if(!result.exact, result.longest_resolved));
  json.set("error", result.error);
  json.set("cheapest", result.cheapest ? work_json(result.schemes[*result.cheapest]) : Json());
  json.set("fastest", result.fastest ? work_json(result.schemes[*result.fastest]) : Json());
  Json rows = Json::array(), schemes = Json::array();
  for (const ComparedScheme& scheme : result.schemes) {
    schemes.push(scheme_json(scheme));
    for (const ComparedRun& run : scheme.runs) rows.push(run_json(scheme, run));
  }
  json.set("measured", std::move(schemes));
  json.set("schemes", std::move(rows));
  if (!archive.empty()) json.set("archive", archive);
  return json;
}

void ComparisonOutcome::save(const std::string& file, bool force, const std::atomic<bool>&) const {
  write_comparison(followed(file), loaded->loaded, provenance_of(loaded->options, system(), 1),
                   result, force);
}

OutcomePointer open_comparison(const std::string& file) {
  StoredComparison stored = read_comparison(file);
  auto outcome = std::make_shared<ComparisonOutcome>(
      loaded_again("compare", stored.system_toml, stored.system_name, file));
  outcome->result = std::move(stored.result);
  return outcome;
}

}  // namespace carom::cli
