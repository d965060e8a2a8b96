// carom validate: the engine against identities and published values.
#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "carom/base/error.hpp"
#include "carom/base/exact_number.hpp"
#include "carom/events/report.hpp"
#include "cli/commands/commands.hpp"
#include "cli/common.hpp"
#include "io/progress.hpp"
#include "validation/cases/cases.hpp"

namespace carom::cli {

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

std::string line_of(const validation::Check& c, validation::Allowance allowance) {
  std::string line =
      fmt::format("{}  {:<34} seed {}  {:>12.4g} hits {:>7.2f} s  ", c.passed ? "passed" : "FAILED",
                  c.name, c.seed, static_cast<double>(c.hits), c.seconds);
  if (c.error > 0.0)
    line += fmt::format("{} +- {}  expected {}{}  {:+.1f} sigma", number_text(c.value),
                        number_text(c.error), number_text(c.expected),
                        c.expected_error > 0.0 ? " +- " + number_text(c.expected_error) : "",
                        c.distance);
  else if (c.digest != 0)
    line += fmt::format("{} lost, {}{} singular, filter share {:.9f}, digest {:016x}", c.lost,
                        c.unresolved > 0 ? fmt::format("{} unresolved, ", c.unresolved) : "",
                        c.singular, c.filter_share, c.digest);
  else
    line += fmt::format("{:.15f}  expected {:.15f}  difference {:+.2g}", c.value, c.expected,
                        c.distance);
  if (allowance.below > 0.0 || allowance.above > 0.0)
    line += fmt::format(" (allowed -{:g}, +{:g})", allowance.below, allowance.above);
  return line + (c.report.empty() ? "" : "\n        " + std::string(shown(c.report))) + "\n";
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

int validate(const Options& options) {
  const std::vector<validation::Case> plan = validation::all_cases(options.soak, scale_of(options));
  validation::CheckOptions how;
  how.threads = threads_of(options);
  how.interrupted = &catch_interrupts();
  Progress progress(!options.quiet && options.json);  // text shows its progress by itself
  Json list = Json::array();
  int passed = 0, failed = 0, threads = 1;
  double seconds = 0.0, cpu_seconds = 0.0;
  bool complete = true;
  for (std::size_t i = 0; i < plan.size() && complete; ++i) {
    if (progress.enabled())
      progress.show(static_cast<double>(i) / static_cast<double>(plan.size()), plan[i].name);
    validation::Check c = plan[i].run(how);
    c.name = plan[i].name;
    c.source = plan[i].source;
    complete = c.complete;
    if (!complete) break;
    c.passed ? ++passed : ++failed;
    threads = std::max(threads, c.threads);
    seconds += c.seconds;
    cpu_seconds += c.cpu_seconds;
    list.push(json_of(c, plan[i].allowance));
    if (!options.json) print(line_of(c, plan[i].allowance));
  }
  if (options.json) {
    Json json = Json::object();
    add_common_keys(json, System(), threads, seconds, cpu_seconds);
    json.set("passed", passed).set("failed", failed).set("cases", std::move(list));
    print(json.text() + "\n");
  } else {
    print(
        fmt::format("\n{} passed, {} failed{}\n", passed, failed, complete ? "" : ", interrupted"));
  }
  if (failed > 0) return untrusted;
  return complete ? done : stopped;
}

}  // namespace carom::cli
