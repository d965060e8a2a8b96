#include "cli/commands/certified_sample.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "carom/base/error.hpp"
#include "carom/certify/certified_orbit.hpp"
#include "carom/ensemble/sampler.hpp"
#include "carom/ensemble/single_run.hpp"
#include "carom/events/world.hpp"
#include "cli/commands/run_certified.hpp"
#include "cli/common.hpp"
#include "cli/reports/aligned.hpp"
#include "cli/reports/doubts.hpp"
#include "io/progress.hpp"

namespace carom::cli {

using io::Json;

namespace {

OtherFlight certified_flight(const LoadedSystem& loaded, int digits,
                             const std::atomic<bool>& stop) {
  ExactSystem system = loaded.exact;
  CertifiedTask task;
  task.collisions = loaded.system.run.collisions;
  if (loaded.system.run.t_max < no_last_time) task.t_max = ExactNumber(loaded.t_max);
  task.digits = digits;
  task.most_bits = 200'000;
  const bool written = loaded.system.initial.kind == InitialCondition::Kind::point;
  return [system, task, written, &stop](const State& start) mutable -> OtherEnd {
    // A start that was drawn is its doubles, taken exactly; the direction's length is free.
    if (!written) system.start = exact_start(start);
    std::optional<CertifiedOrbit> orbit;
    try {
      orbit.emplace(system, task, [&stop] { return stop.load(std::memory_order_relaxed); });
    } catch (const InputError&) {  // next to a wall, and outside of the table as it was written
      return {};
    }
    const CertifiedEnd& end = orbit->finish();
    OtherEnd result{OtherEnd::known, {}};
    result.end.hits = end.collisions;
    result.end.hole = end.hole;
    switch (end.fate) {
      case CertifiedFate::completed:
      case CertifiedFate::pinned:
        return result;
      case CertifiedFate::escaped:
      case CertifiedFate::unbounded:
        result.end.time = end.t.to_double();
        return result;
      case CertifiedFate::singular:
        return {OtherEnd::singular, {}};
      default:
        return {};
    }
  };
}

int digits_of(const Options& options) {
  if (options.digits.empty()) return 10;
  const std::uint64_t digits = whole_number(options.digits, "--digits", 1);
  if (digits > 1000)
    throw InputError(place_of("--digits"), "a sample needs few digits", "at most 1000");
  return static_cast<int>(digits);
}

// Refuses what has no certified form before anything is computed.
void check(const LoadedSystem& loaded) {
  check_form(loaded.system, "--certify-sample");
  check_start(loaded.system);
  ExactSystem exact = loaded.exact;
  if (loaded.system.initial.kind != InitialCondition::Kind::point)
    exact.start = exact_start(draw_initial_state(loaded.system, World(*loaded.system.table), 0, 0));
  CertifiedTask task;
  task.collisions = 1;
  const CertifiedOrbit orbit(exact, task);
}

void add_result(Json& json, const PairedEscapeResult& result, int digits) {
  const PairedResult& r = result.pairs;
  json.set("status", result.complete ? "completed" : "interrupted");
  json.set("pairs", r.pairs).set("digits", digits).set("singular", result.singular);
  json.set("unresolved", result.unresolved).set("lost", result.lost);
  json.set("certified_singular", result.other_singular).set("undecided", result.unknown);
  json.set("other_hole", r.other_hole)
      .set("other_hits", r.other_hits)
      .set("other_time", r.other_time);
  const auto of_pairs = [&](double x) { return r.pairs > 0 ? Json(x) : Json(); };
  json.set("statistic", of_pairs(r.statistic)).set("threshold", of_pairs(r.threshold));
  json.set("p_value", of_pairs(r.p_value)).set("swaps", r.swaps);
  Json points = Json::array();
  for (const PairedPoint& p : r.points)
    points.push(Json::object()
                    .set("t", p.t)
                    .set("double", p.first)
                    .set("certified", p.second)
                    .set("difference", p.difference)
                    .set("stderr", p.error)
                    .set("only_double", p.only_first)
                    .set("only_certified", p.only_second)
                    .set("detectable", p.detectable));
  json.set("survival", std::move(points));
}

std::string text_of(const PairedEscapeResult& result, int digits, std::size_t most) {
  const PairedResult& r = result.pairs;
  const double all = r.pairs > 0 ? static_cast<double>(r.pairs) : 1.0;
  const auto share = [&](std::uint64_t n) {
    return fmt::format("{:>10}  {:>7.3f} %", grouped(n), 100.0 * static_cast<double>(n) / all);
  };
  std::string text = fmt::format("The same starts in doubles and certified, {}: {}{}\n",
                                 counted(static_cast<std::uint64_t>(digits), "decimal"),
                                 counted(r.pairs, "pair"), result.complete ? "" : " (interrupted)");
  text += fmt::format("  escape otherwise      {}\n", share(r.different()));
  text += fmt::format("    elsewhere or not    {}\n", share(r.other_hole));
  text += fmt::format("    after other hits    {}\n", share(r.other_hits));
  text += fmt::format("    at another time     {}\n", share(r.other_time));
  if (result.singular + result.unresolved + result.lost + result.other_singular + result.unknown >
      0)
    text += fmt::format(
        "  not compared          {} singular in doubles, {} certified as singular,\n"
        "                        {} unresolved, {} lost, {} undecided\n",
        result.singular, result.other_singular, result.unresolved, result.lost, result.unknown);
  if (r.pairs == 0)
    return text + fmt::format(
                      "  no pair was compared: nothing is known of the curves\n  computed in       "
                      "    {:.3g} s\n",
                      result.seconds);
  std::vector<double> times;
  std::vector<Column> columns(6);
  const char* const headers[] = {"t", "double", "certified", "difference", "error", "detectable"};
  for (std::size_t c = 0; c < columns.size(); ++c) columns[c].header = headers[c];
  for (const std::size_t row : every_kth(r.points.size(), most)) {
    const PairedPoint& p = r.points[row];
    const double standard_error = std::sqrt(p.first * (1 - p.first) / all);
    const Rounding rounded = rounding_of(p.first, standard_error);
    const Rounding difference = rounding_of(p.error, p.error);
    times.push_back(p.t);
    const std::string cells[] = {rounded(p.first), rounded(p.second), difference(p.difference),
                                 difference(p.error),
                                 rounding_of(p.detectable, p.detectable)(p.detectable)};
    for (std::size_t c = 0; c < std::size(cells); ++c) columns[c + 1].cells.push_back(cells[c]);
  }
  columns.front().cells = times_text(times);
  text += "\n" + fitted(columns) + "\n";
  text += fmt::format(
      "  largest difference    {:.2f} standard errors;\n"
      "                        {} random swaps of pairs exceed {:.2f} in 5 %\n",
      r.statistic, grouped(r.swaps), r.threshold);
  text += fmt::format("  swap test             p = {:.4f}: the curves {}\n", r.p_value,
                      r.p_value > 0.05 ? "do not differ" : "differ");
  return text + fmt::format("  computed in           {:.3g} s\n", result.seconds);
}

}  // namespace

CertifiedSample compare_with_certified(const Options& options, const LoadedSystem& loaded,
                                       const std::atomic<bool>& stop,
                                       std::function<void(std::uint64_t)> progress) {
  PairedEscapeOptions how;
  how.sample = whole_number(options.certify_sample, "--certify-sample", 1);
  how.threads = threads_of(options);
  how.interrupted = &stop;
  how.progress = std::move(progress);
  CertifiedSample sample;
  sample.digits = digits_of(options);
  const System& system = loaded.system;
  if (how.sample > system.run.trajectories)
    throw InputError(place_of("--certify-sample"),
                     "the ensemble has " + counted(system.run.trajectories, "trajectory"),
                     "a sample of at most these, or more --trajectories");
  check(loaded);
  sample.result = compare_escapes(
      system, [&] { return certified_flight(loaded, sample.digits, stop); }, how);
  return sample;
}

Json sample_json(const System& system, const CertifiedSample& sample) {
  const PairedEscapeResult& result = sample.result;
  Json json = Json::object();
  add_common_keys(json, system, result.threads, result.seconds, result.cpu_seconds);
  add_result(json, result, sample.digits);
  return json;
}

std::string sample_text(const System& system, const CertifiedSample& sample, std::size_t rows) {
  return heading(system) + text_of(sample.result, sample.digits, rows);
}

int certified_sample(const Options& options) {
  if (!options.output.empty())
    throw InputError(place_of("--output"), "a certified sample writes no archive",
                     "--json, or no -o");
  check_engine(options);
  const std::uint64_t wanted = whole_number(options.certify_sample, "--certify-sample", 1);
  threads_of(options);
  digits_of(options);
  LoadedSystem loaded = load(options, options.overrides);
  choose_engine(options.engine, loaded.system);
  CertifiedSample sample;
  {
    io::Progress progress(!options.quiet);
    const double all = static_cast<double>(wanted);
    sample = compare_with_certified(options, loaded, catch_interrupts(), [&](std::uint64_t done) {
      if (progress.due())
        progress.show(
            static_cast<double>(done) / all,
            io::with_prefix(static_cast<double>(done) / progress.seconds()) + "certified orbits/s");
    });
  }
  const PairedEscapeResult& result = sample.result;
  const Doubts doubts = doubts_of_failures(result.unresolved, result.lost);
  print_report(
      options, [&] { return sample_json(loaded.system, sample); },
      [&] { return doubts.folded_text() + sample_text(loaded.system, sample, rows_of(options)); },
      doubts.text());
  return doubts.status(result.complete);
}

}  // namespace carom::cli
