#include "cli/reports/sweep_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/printable.hpp"
#include "carom/base/exact_number.hpp"
#include "carom_version.hpp"
#include "cli/common.hpp"
#include "cli/reports/aligned.hpp"
#include "cli/reports/doubts.hpp"

namespace carom::cli {

using files::Json;

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// A number of a report and its error, as paths of its JSON.
struct Quantity {
  const char *name, *value;
  const char* error = "";            ///< a standard error, or
  const char *low = "", *high = "";  ///< a 95 % interval
  int digits = 6;                    ///< of a number without an error
};
/// A column of the text: the first quantity that a row has.
struct Shown {
  const char* header;
  std::vector<Quantity> quantities;
};

/// What the table of each command shows, the most important first: what does not fit is left out of
/// the text.
const std::vector<Shown>& shown_of(const std::string& command) {
  static const std::vector<Shown> escape{
      {"decay", {{"model", "fit.model"}}},
      {"kappa or a",
       {{"rate", "fit.rate", "fit.stderr"}, {"exponent", "fit.exponent", "fit.stderr"}}},
      {"P(t_max)",
       {{"survival", "survival.-1.p", "", "survival.-1.low", "survival.-1.high"},
        {"survival", "survival.-1.value", "survival.-1.stderr"}}},
      {"p-value",
       {{"p_value", "fit.p_value", "", "", "", 2}, {"p_value", "p_value", "", "", "", 2}}},
      {"P_infinity", {{"plateau", "fit.plateau", "fit.plateau_stderr"}}}};
  static const std::vector<Shown> diffusion{
      {"D", {{"D", "D.value", "D.stderr"}}},
      {"exponent", {{"exponent", "exponent.value", "exponent.stderr"}}},
      {"MSD(t_max)", {{"msd", "msd.-1.value", "msd.-1.stderr"}}}};
  static const std::vector<Shown> run{{"status", {{"status", "status"}}},
                                      {"collisions", {{"collisions", "collisions"}}},
                                      {"t", {{"t", "t"}}},
                                      {"x", {{"x", "x"}}},
                                      {"y", {{"y", "y"}}},
                                      {"energy error", {{"energy_error", "energy_error.largest"}}}};
  static const std::vector<Shown> section{{"points", {{"points", "points"}}},
                                          {"orbits", {{"orbits", "orbits"}}},
                                          {"collisions", {{"collisions", "collisions"}}},
                                          {"status", {{"status", "status"}}}};
  static const std::vector<Shown> lyapunov{
      {"lambda", {{"lambda", "lambda.0.value", "lambda.0.stderr"}}},
      {"entropy", {{"entropy", "entropy.value", "entropy.stderr"}}},
      {"lambda a hit", {{"per_collision", "per_collision.0.value", "per_collision.0.stderr"}}},
      {"chaotic share", {{"chaotic_share", "chaotic_share.value", "chaotic_share.stderr"}}}};
  static const std::vector<Shown> returns{
      {"mean time", {{"mean_time", "mean_time.value", "mean_time.stderr"}}},
      {"mean hits", {{"mean_hits", "mean_hits.value", "mean_hits.stderr"}}},
      {"tail", {{"exponent", "tail.exponent.value", "tail.exponent.stderr"}}}};
  static const std::vector<Shown> relax{
      {"lowest energy", {{"energy", "equilibria.0.energy", "", "", "", 10}}},
      {"it is a", {{"kind", "equilibria.0.kind"}}},
      {"highest frequency", {{"frequency", "equilibria.0.frequencies.0"}}},
      {"equilibria", {{"number", "number"}}}};
  static const std::vector<Shown> orbit{
      {"escape rate", {{"escape_rate", "zeta.escape_rate", "zeta.error"}}},
      {"orbits", {{"number", "number"}}},
      {"shortest period", {{"period", "orbits.0.period"}}},
      {"its trace", {{"trace", "orbits.0.trace"}}}};
  static const std::vector<Shown> compare{
      {"cheapest", {{"scheme", "cheapest.scheme"}}},
      {"step", {{"step", "cheapest.step"}, {"tolerance", "cheapest.tolerance"}}},
      {"evaluations", {{"force_evaluations", "cheapest.force_evaluations"}}},
      {"compared at t", {{"t", "t"}}}};
  static const std::vector<std::pair<std::string, const std::vector<Shown>*>> all{
      {"escape", &escape},   {"diffusion", &diffusion}, {"run", &run},
      {"section", &section}, {"lyapunov", &lyapunov},   {"relax", &relax},
      {"orbit", &orbit},     {"compare", &compare},     {"returns", &returns}};
  for (const auto& [name, shown] : all)
    if (name == command) return *shown;
  throw InternalError("no table for a sweep of " + command);
}

struct Found {
  double value = none, error = none;
  std::string text;
  bool any() const { return !text.empty() || !std::isnan(value); }
};

double number_at(const Json& report, const char* path) {
  const Json* found = *path ? report.find(path) : nullptr;
  return found ? found->number().value_or(none) : none;
}

Found find(const Json& report, const Quantity& quantity) {
  const Json* found = report.find(quantity.value);
  if (!found) return {};
  Found result{found->number().value_or(none), number_at(report, quantity.error), ""};
  // Both sides of a 95 % interval are 1.96 standard errors of a normal distribution.
  if (*quantity.low && !report.find("no_errors"))
    result.error = (number_at(report, quantity.high) - number_at(report, quantity.low)) / 3.92;
  if (std::isnan(result.value)) result.text = found->string().value_or("");
  return result;
}

std::string cell(const Json& report, const Shown& shown) {
  for (const Quantity& quantity : shown.quantities) {
    const Found found = find(report, quantity);
    if (!found.any()) continue;
    if (!found.text.empty()) {
      const Json* decided = report.find("fit.decided");
      const bool doubtful =
          decided && !decided->is_true() && quantity.value == std::string("fit.model");
      const Json* local = report.find("fit.local_slope");
      const bool here = local && local->is_true() && quantity.value == std::string("fit.model");
      return found.text + (here ? ", local" : "") + (doubtful ? " ?" : "");
    }
    if (!std::isnan(found.error)) return cli::with_error(found.value, found.error);
    const bool whole =
        found.value == std::floor(found.value) && found.value >= 0 && found.value < 1e15;
    return whole ? grouped(static_cast<std::uint64_t>(found.value))
                 : fmt::format("{:.{}g}", found.value, quantity.digits);
  }
  return {};
}

double sum_of(const SweepResult& result, const char* key) {
  double sum = 0.0;
  for (const SweepRow& row : result.rows) {
    const double one = number_at(row.report, key);
    if (!std::isnan(one)) sum += one;
  }
  return sum;
}

// As it is written, where that is a short number.
std::string shown_value(const std::string& text) {
  constexpr std::size_t longest = 10;
  return text.size() <= longest ? text : fmt::format("{:.6g}", ExactNumber(text).to_double());
}

bool sweeps(const files::SweepPlan& plan, const std::string& key) {
  return std::any_of(plan.keys.begin(), plan.keys.end(),
                     [&](const files::SweptKey& swept) { return swept.key == key; });
}

std::string head(const SweepResult& result) {
  std::string text;
  for (const files::SweptKey& key : result.plan.keys)
    text += fmt::format("{}{} of {} from {} to {}", text.empty() ? "" : ", ",
                        counted(key.values.size(), "value"), key.key,
                        shown_value(key.values.front()), shown_value(key.values.back()));
  if (result.rows.empty())
    return folded(base::printable(result.title)) + "\n" + folded(text + ": none was computed") +
           "\n";
  const Json& first = result.rows.front().report;
  if (const double all = number_at(first, "trajectories");
      !std::isnan(all) && !sweeps(result.plan, "run.trajectories"))
    text += fmt::format(", {} each", counted(static_cast<std::uint64_t>(all), "trajectory"));
  if (const Json* seed = first.find("seed"); seed && !sweeps(result.plan, "run.seed"))
    text += fmt::format(", seed {} for each", seed->text());
  return folded(base::printable(result.title)) + "\n" + folded(text) + "\n";
}

std::string table(const SweepResult& result) {
  std::vector<Column> columns;
  for (std::size_t k = 0; k < result.plan.keys.size(); ++k) {
    columns.push_back({result.plan.keys[k].key, {}});
    for (const SweepRow& row : result.rows)
      columns[k].cells.push_back(shown_value(result.plan.at(row.index)[k]));
  }
  for (const Shown& shown : shown_of(result.plan.command)) {
    std::vector<std::string> cells;
    bool any = false, texts = false;
    for (const SweepRow& row : result.rows) {
      cells.push_back(cell(row.report, shown));
      any = any || !cells.back().empty();
      texts = texts || !find(row.report, shown.quantities.front()).text.empty();
    }
    if (!any) continue;
    columns.push_back({shown.header, cells, texts});
    if (width_of(aligned(columns)) > line_width) columns.pop_back();
  }
  return aligned(columns);
}

/// Why rows lack what a command is run for.
struct Reason {
  std::string text, first;
  std::size_t rows;
  std::string sentence() const {
    return fmt::format("{}{}: {}", first, rows > 1 ? fmt::format(" and {} more", rows - 1) : "",
                       text);
  }
};

/// Each reason once.
std::vector<Reason> reasons_of(const SweepResult& result) {
  std::vector<Reason> all;
  for (const SweepRow& row : result.rows)
    for (const char* path : {"reason", "fit.reason", "no_errors", "no_share", "note"}) {
      if (path == std::string("note") && !row.doubts().empty()) continue;  // they say more
      const Json* found = row.report.find(path);
      const std::string text = found ? found->string().value_or("") : "";
      if (text.empty()) continue;
      const auto same = std::find_if(all.begin(), all.end(),
                                     [&](const Reason& reason) { return reason.text == text; });
      if (same != all.end())
        ++same->rows;
      else
        all.push_back({text, result.plan.named(row.index), 1});
    }
  return all;
}

std::string reasons(const SweepResult& result) {
  constexpr std::size_t most = 5;
  const std::vector<Reason> all = reasons_of(result);
  std::string text;
  for (std::size_t i = 0; i < all.size() && i < most; ++i) text += folded(all[i].sentence()) + "\n";
  if (all.size() > most) text += fmt::format("and {} other reasons: --json\n", all.size() - most);
  return text;
}

}  // namespace

SweepRow::SweepRow(std::size_t row, const Outcome& outcome) : index(row), report(outcome.json()) {
  std::string text;
  for (const std::string& line : outcome.doubts()) text += line + "\n";
  if (!text.empty()) report.set("doubts", text);
}

std::string SweepRow::doubts() const {
  const Json* found = report.find("doubts");
  return found ? found->string().value_or("") : "";
}

// The other commands have a result also where their fit has none.
bool SweepRow::measured_nothing() const {
  const Json* const status = report.find("status");
  return report.find("lambda") && report.find("reason") && doubts().empty() && status &&
         status->string() == "completed";
}

std::optional<InputError> why_nothing(const SweepResult& result) {
  if (result.rows.size() < result.plan.systems.size() ||
      !std::all_of(result.rows.begin(), result.rows.end(),
                   [](const SweepRow& row) { return row.measured_nothing(); }))
    return std::nullopt;
  return InputError(
      Place{"command line", 0, 0, "--sweep"},
      "no value measures an exponent; " + reasons_of(result).front().sentence(),
      "a value, --t-max, --collisions, --window or --trajectories of which one can be "
      "measured");
}

std::vector<SweepColumn> sweep_table(const files::SweepPlan& plan,
                                     const std::vector<SweepRow>& rows) {
  std::vector<SweepColumn> columns;
  for (std::size_t k = 0; k < plan.keys.size(); ++k) {
    columns.push_back({plan.keys[k].key, {}, {}});
    for (const SweepRow& row : rows)
      columns.back().numbers.push_back(ExactNumber(plan.at(row.index)[k]).to_double());
  }
  const auto column = [&](const std::string& name) -> SweepColumn& {
    for (SweepColumn& one : columns)
      if (one.name == name) return one;
    columns.push_back(
        {name, std::vector<double>(rows.size(), none), std::vector<std::string>(rows.size())});
    return columns.back();
  };
  for (const Shown& shown : shown_of(plan.command))
    for (const Quantity& quantity : shown.quantities)
      for (std::size_t i = 0; i < rows.size(); ++i) {
        const Found found = find(rows[i].report, quantity);
        if (!found.any()) continue;
        column(quantity.name).numbers[i] = found.value;
        column(quantity.name).texts[i] = found.text;
        if (!std::isnan(found.error))
          column(std::string(quantity.name) + "_stderr").numbers[i] = found.error;
      }
  // Why a row cannot be trusted, or what its numbers lack.
  for (const char* key : {"doubts", "note"})
    for (std::size_t i = 0; i < rows.size(); ++i)
      if (const Json* found = rows[i].report.find(key))
        if (const std::string text = found->string().value_or(""); !text.empty())
          column(key).texts[i] = text;
  for (SweepColumn& one : columns)
    if (std::all_of(one.texts.begin(), one.texts.end(),
                    [](const std::string& text) { return text.empty(); }))
      one.texts.clear();
  return columns;
}

std::vector<files::SweepNumbers> sweep_numbers(const SweepResult& result) {
  std::vector<files::SweepNumbers> numbers;
  const std::vector<SweepColumn> columns = sweep_table(result.plan, result.rows);
  for (std::size_t c = result.plan.keys.size(); c < columns.size(); ++c) {
    if (!columns[c].texts.empty()) continue;
    files::SweepNumbers made{columns[c].name,
                             std::vector<double>(result.plan.systems.size(), none)};
    for (std::size_t i = 0; i < result.rows.size(); ++i)
      made.values[result.rows[i].index] = columns[c].numbers[i];
    numbers.push_back(std::move(made));
  }
  return numbers;
}

Json sweep_json(const SweepResult& result) {
  Json json = Json::object().set("version", version).set("system", result.plan.system_name);
  if (!result.title.empty()) json.set("title", result.title);
  json.set("command", result.plan.command);
  if (!result.rows.empty())
    for (const char* key : {"seed", "threads", "engine", "isa"})
      if (const Json* found = result.rows.front().report.find(key))
        json.set(key, sweeps(result.plan, fmt::format("run.{}", key)) ? Json() : *found);
  json.set("seconds", sum_of(result, "seconds")).set("cpu_seconds", sum_of(result, "cpu_seconds"));
  json.set("status", result.status);
  Json keys = Json::array(), rows = Json::array();
  for (const files::SweptKey& key : result.plan.keys) {
    Json values = Json::array();
    for (const std::string& value : key.values) values.push(value);
    keys.push(Json::object().set("key", key.key).set("values", std::move(values)));
  }
  for (const SweepRow& row : result.rows) {
    const std::vector<std::string> at = result.plan.at(row.index);
    Json values = Json::object();
    for (std::size_t k = 0; k < at.size(); ++k)
      values.set(result.plan.keys[k].key, ExactNumber(at[k]).to_double());
    rows.push(Json::object().set("values", std::move(values)).add(row.report));
  }
  json.set("keys", std::move(keys)).set("sweep", std::move(rows));
  if (!result.archive.empty()) json.set("archive", result.archive);
  return json;
}

std::string sweep_text(const SweepResult& result) {
  std::string text, after;
  for (const SweepRow& row : result.rows)
    for (const std::string& doubt : lines_of(row.doubts()))
      text += folded(fmt::format("{}: {}", result.plan.named(row.index), doubt)) + "\n";
  text += head(result);
  if (result.status != "completed")
    text += fmt::format("({}: {} of {})\n", result.status, result.rows.size(),
                        counted(result.plan.systems.size(), "value"));
  if (!result.rows.empty()) text += "\n" + table(result);
  const auto any = [&](const char* path, bool wanted) {
    return std::any_of(result.rows.begin(), result.rows.end(), [&](const SweepRow& row) {
      const Json* found = row.report.find(path);
      return found && found->is_true() == wanted;
    });
  };
  if (any("fit.local_slope", true))
    text += "  local: the slope in a window that does not show a law by itself\n";
  if (any("fit.decided", false))
    text += "  ?: the data cannot distinguish this law from the next\n";
  if (const std::string why = reasons(result); !why.empty()) text += "\n" + why;
  text += fmt::format("\ncomputed in {:.3g} s\n", sum_of(result, "seconds"));
  if (!result.archive.empty()) text += fmt::format("archive: {}\n", result.archive);
  text += grounds_text("each value as a single run", "values between them");
  return text;
}

}  // namespace carom::cli
