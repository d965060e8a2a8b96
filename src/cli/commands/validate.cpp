// carom validate: the engine against identities and published values.
#include "cli/commands/validate.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "carom/base/error.hpp"
#include "carom/base/exact_number.hpp"
#include "carom/events/report.hpp"
#include "carom/files/ensembles.hpp"
#include "cli/commands/commands.hpp"
#include "cli/common.hpp"
#include "cli/reports/aligned.hpp"
#include "cli/reports/doubts.hpp"
#include "cli/signals.hpp"
#include "files/progress.hpp"

namespace carom::cli {

using files::Json;

namespace {

double scale_of(const Options& options) {
  if (options.scale.empty()) return 1.0;
  const Place place{"command line", 0, 0, "--scale"};
  const double scale = ExactNumber(options.scale, place).to_double();
  if (!(scale > 0.0 && scale <= 1000.0))
    throw InputError(place, fmt::format("{} is out of range", options.scale),
                     "a number above 0, at most 1000");
  return scale;
}

/// Seven decimals, or as many digits of large numbers.
std::string number_text(double value) {
  return value < 10.0 ? fmt::format("{:.7f}", value) : fmt::format("{:.7g}", value);
}

// Two lines: which case, and what it gave.
std::string lines_of(const validation::Check& c, validation::Allowance allowance, bool verbose) {
  const std::string indent = "\n        ";
  std::string text = fmt::format("{}  {:<40} {:>9.3g} hits  {:>8}", c.passed ? "passed" : "FAILED",
                                 c.name, static_cast<double>(c.hits), short_duration(c.seconds));
  text += indent;
  if (c.error > 0.0)
    text += fmt::format(
        "{}, expected {}{}: {:+.1f} sigma", with_error(c.value, c.error), number_text(c.expected),
        c.expected_error > 0.0 ? " +- " + number_text(c.expected_error) : "", c.distance);
  else if (c.digest != 0)
    text += fmt::format("{} lost, {}{} singular", c.lost,
                        c.unresolved > 0 ? fmt::format("{} unresolved, ", c.unresolved) : "",
                        c.singular);
  else
    text += fmt::format("{:.12g}, expected {:.12g}: {:+.2g}", c.value, c.expected, c.distance);
  if (allowance.below > 0.0 || allowance.above > 0.0)
    text += fmt::format(" (allowed -{:g}, +{:g})", allowance.below, allowance.above);
  if (verbose) {
    text += indent + fmt::format("seed {}", c.seed);
    if (c.digest != 0)
      text += fmt::format(", filter share {:.9f}, digest {:016x}", c.filter_share, c.digest);
  }
  return text + (c.report.empty() ? "" : indent + std::string(shown(c.report))) + "\n";
}

Json json_of(const validation::Check& c, validation::Allowance allowance) {
  Json json = Json::object();
  json.set("name", c.name).set("passed", c.passed).set("seed", c.seed).set("value", c.value);
  json.set("error", c.error).set("expected", c.expected);
  json.set("expected_error", c.expected_error).set("sigma", c.distance);
  json.set("allowed_below", allowance.below)
      .set("allowed_above", allowance.above)
      .set("source", c.source);
  json.set("hits", c.hits)
      .set("unresolved", c.unresolved)
      .set("lost", c.lost)
      .set("singular", c.singular);
  json.set("filter_share", c.filter_share).set("digest", fmt::format("{:016x}", c.digest));
  if (!c.report.empty()) json.set("report", c.report);
  return json.set("seconds", c.seconds).set("cpu_seconds", c.cpu_seconds);
}

}  // namespace

int Validation::passed() const {
  return static_cast<int>(
      std::count_if(cases.begin(), cases.end(), [](const Done& c) { return c.check.passed; }));
}
int Validation::failed() const { return static_cast<int>(cases.size()) - passed(); }

Validation run_validation(const Options& options, const validation::CheckOptions& how,
                          const std::function<void(double, const std::string&)>& before,
                          const std::function<void(const Validation::Done&)>& after) {
  const std::vector<validation::Case> plan = validation::all_cases(options.soak, scale_of(options));
  Validation all;
  for (std::size_t i = 0; i < plan.size(); ++i) {
    before(static_cast<double>(i) / static_cast<double>(plan.size()), plan[i].name);
    validation::Check c = plan[i].run(how);
    c.name = plan[i].name;
    c.source = plan[i].source;
    all.complete = c.complete;
    if (!all.complete) break;
    all.cases.push_back({plan[i], std::move(c)});
    after(all.cases.back());
  }
  return all;
}

Json validation_json(const Validation& all) {
  int threads = 1;
  double seconds = 0.0, cpu_seconds = 0.0;
  Json list = Json::array();
  for (const auto& [of, check] : all.cases) {
    threads = std::max(threads, check.threads);
    seconds += check.seconds;
    cpu_seconds += check.cpu_seconds;
    list.push(json_of(check, of.allowance));
  }
  Json json = Json::object();
  add_common_keys(json, System(), threads, seconds, cpu_seconds);
  return json.set("passed", all.passed()).set("failed", all.failed()).set("cases", std::move(list));
}

std::string text_of(const Validation::Done& one, bool verbose) {
  return lines_of(one.check, one.of.allowance, verbose);
}

std::string summary_of(const Validation& all) {
  return fmt::format(
      "\n{} passed, {} failed{}\n{}", all.passed(), all.failed(),
      all.complete ? "" : ", interrupted",
      all.cases.empty()
          ? ""
          : grounds_text("formulas, published values, another simulation", "other systems"));
}

int validate(const Options& options) {
  validation::CheckOptions how;
  how.threads = threads_of(options);
  how.interrupted = &catch_interrupts();
  files::Progress progress(!options.quiet && options.json);  // text shows its progress by itself
  const Validation all = run_validation(
      options, how,
      [&](double share, const std::string& name) {
        if (progress.enabled()) progress.show(share, name);
      },
      [&](const Validation::Done& one) {
        if (!options.json) print(text_of(one, options.verbose));
      });
  print(options.json ? validation_json(all).text() + "\n" : summary_of(all));
  if (all.failed() > 0) return untrusted;
  return all.complete ? done : stopped;
}

}  // namespace carom::cli
