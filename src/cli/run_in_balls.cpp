// carom run --precision certified: every digit that is printed is guaranteed.
#include "cli/run_in_balls.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "carom/base/error.hpp"
#include "carom/certify/certified_orbit.hpp"
#include "carom/ensemble/stopwatch.hpp"
#include "carom/io/certified_archive.hpp"
#include "cli/common.hpp"
#include "cli/exact_run.hpp"
#include "io/progress.hpp"

namespace carom::cli {

namespace {

Place place_of(const char* option) { return {"command line", 0, 0, option}; }

CertifiedTask task_of(const Options& options, const LoadedSystem& loaded) {
  CertifiedTask task;
  task.collisions = loaded.system.run.collisions;
  if (loaded.system.run.t_max < no_last_time) task.t_max = loaded.t_max;
  if (!options.digits.empty()) {
    const std::uint64_t digits = whole_number(options.digits, "--digits", 0);
    check_digits(digits, *loaded.system.table, place_of("--digits"));
    task.digits = static_cast<int>(digits);
  }
  return task;
}

PrintedEnd printed(const System& system, const CertifiedEnd& end, const std::string& status, int digits,
                   const CertifiedEffort& effort) {
  PrintedEnd r{status, end.collisions, end.wall, end.hole, end.cell, end.t.text(digits), end.x.text(digits),
               end.y.text(digits), end.vx.text(digits), end.vy.text(digits), end.reason, {}};
  if (says_rescaled(system, effort.rescaled))
    r.notes.push_back("velocity      gave the direction; its length was made the speed, exactly");
  for (const std::string& tie : end.ties) r.notes.push_back("exact tie     " + tie);
  return r;
}

Json own_keys(Json json, const System& system, const CertifiedEnd& end, const CertifiedTask& task,
              const CertifiedEffort& effort, const std::string& output) {
  if (!end.ties.empty()) {
    Json ties = Json::array();
    for (const std::string& tie : end.ties) ties.push(tie);
    json.set("ties", std::move(ties));
  }
  json.set("rescaled", says_rescaled(system, effort.rescaled));
  json.set("digits", task.digits).set("bits", effort.bits).set("attempts", effort.attempts);
  json.set("lost_bits", effort.tangent_bits);
  if (!output.empty()) json.set("archive", output);
  return json;
}

std::string own_lines(const CertifiedTask& task, const CertifiedEffort& effort, const std::string& output,
                      double seconds) {
  std::string text = fmt::format("  guaranteed    {} decimals, by {} bits ({} lost on the way, {} attempt{})\n", task.digits,
                                 effort.bits, static_cast<long>(effort.tangent_bits), effort.attempts,
                                 effort.attempts == 1 ? "" : "s");
  text += fmt::format("  computed in   {:.3g} s\n", seconds);
  return output.empty() ? text : text + fmt::format("  archive       {}\n", output);
}

void follow(CertifiedOrbit& orbit, const Options& options, const CertifiedTask& task,
            CertifiedArchive* archive) {
  Progress progress(!options.quiet);
  while (const auto hit = orbit.next()) {
    if (archive) archive->hit(*hit);
    if (progress.due()) {
      const double by_hits = task.collisions == 0
                                 ? 0.0
                                 : static_cast<double>(hit->number) / static_cast<double>(task.collisions);
      const double by_time = task.t_max ? hit->t.to_double() / task.t_max->to_double() : 0.0;
      progress.show(std::max(by_hits, by_time),
                    with_prefix(static_cast<double>(hit->number) / progress.seconds()) + "hits/s");
    }
  }
}

}  // namespace

int run_in_balls(const Options& options) {
  if (!options.resume.empty())
    throw InputError(place_of("--resume"), "certified runs start at the beginning",
                     "-o FILE.h5, or --precision double");
  if (options.precision != "certified" && options.precision != "double") return run_in_plain_numbers(options);
  if (options.precision == "double")
    throw InputError(place_of("--digits"), "digits of a run in double precision are not guaranteed",
                     "--precision certified beside --digits");
  const LoadedSystem loaded = load_exact_run(options);
  const CertifiedTask task = task_of(options, loaded);
  const Stopwatch watch;
  const std::atomic<bool>& signal = catch_interrupts();
  CertifiedOrbit orbit(loaded.exact, task, [&signal] { return signal.load(std::memory_order_relaxed); });
  std::unique_ptr<CertifiedArchive> archive;
  if (!options.output.empty())
    archive = std::make_unique<CertifiedArchive>(
        options.output, loaded, provenance_of(options, loaded.system, 1), task, options.force, lock_output(options.output));
  follow(orbit, options, task, archive.get());
  const CertifiedEnd& end = orbit.end_state();
  const bool interrupted = end.fate == CertifiedFate::interrupted;
  const double seconds = watch.seconds(), cpu_seconds = watch.cpu_seconds();
  const std::string status = name_of(end.fate);
  if (archive) archive->finish(end, orbit.effort(), status, !interrupted);
  const PrintedEnd result = printed(loaded.system, end, status, task.digits, orbit.effort());
  if (options.json)
    print(own_keys(end_json(loaded.system, result, seconds, cpu_seconds), loaded.system, end, task, orbit.effort(),
                   options.output)
              .text() +
          "\n");
  else
    print(end_text(loaded.system, result) + own_lines(task, orbit.effort(), options.output, seconds));
  return interrupted ? stopped : done;
}

}  // namespace carom::cli
