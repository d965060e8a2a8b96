// carom run --precision certified: every digit that is printed is guaranteed.
#include "analyses/run/command_certified.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "carom/analyses/run.hpp"
#include "carom/analyses/run/certified_archive.hpp"
#include "carom/base/error.hpp"
#include "carom/base/stopwatch.hpp"
#include "carom/events/world.hpp"
#include "carom/starts/sampler.hpp"
#include "cli/loading.hpp"
#include "cli/signals.hpp"
#include "files/progress.hpp"

namespace carom::cli {

using files::Json;

namespace {

void check_options(const Options& options) {
  if (!options.resume.empty())
    throw InputError(place_of("--resume"), "certified runs start at the beginning",
                     "-o FILE.h5, or --precision double");
  if (options.precision == "double")
    throw InputError(place_of("--digits"), "digits of a run in double precision are not guaranteed",
                     "--precision certified beside --digits");
  if (options.precision == "certified") return;
  const bool bits = options.precision.find_first_not_of("0123456789.e+") == std::string::npos;
  throw InputError(
      place_of("--precision"), "'" + options.precision + "' is not a precision",
      bits ? "certified with --digits D: the program chooses the bits that D decimals need"
           : "double or certified",
      nearest_name(options.precision, {"double", "certified"}));
}

// A start that was drawn. Of one that was written, the orbit itself asks whether it lies in the
// table.
void draw_start(const Options& options, LoadedSystem& loaded) {
  const System& system = loaded.system;
  if (system.initial.kind == InitialCondition::Kind::point) return;
  check_start(system);
  const std::uint64_t trajectory =
      options.trajectory.empty() ? 0 : whole_number(options.trajectory, "--trajectory", 0);
  loaded.exact.start = exact_start(draw_initial_state(system, World(*system.table), trajectory, 0));
}

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

// "" before the first hit.
std::string wall_of(const System& system, int wall) {
  return wall < 0 ? std::string() : system.table->walls[static_cast<std::size_t>(wall)].name;
}

// Was a velocity that the user wrote taken as a direction?
bool says_rescaled(const System& system, const CertifiedEffort& effort) {
  return effort.rescaled && system.initial.kind == InitialCondition::Kind::point;
}

}  // namespace

Json certified_json(const System& system, const CertifiedEnd& end, const CertifiedTask& task,
                    const CertifiedEffort& effort, const std::string& output, double seconds,
                    double cpu_seconds) {
  Json json = Json::object();
  add_common_keys(json, system, 1, seconds, cpu_seconds);
  json.set("status", name_of(end.fate));
  json.set("collisions", end.collisions);
  const std::string wall = wall_of(system, end.wall);
  json.set("wall", wall.empty() ? Json() : Json(wall));
  const int digits = task.digits;
  json.set("t", end.t.text(digits)).set("x", end.x.text(digits)).set("y", end.y.text(digits));
  json.set("vx", end.vx.text(digits)).set("vy", end.vy.text(digits));
  json.set("cell", Json::array().push(end.cell.first).push(end.cell.second));
  if (end.hole >= 0) json.set("hole", system.table->holes[static_cast<std::size_t>(end.hole)].name);
  if (!end.reason.empty()) json.set("reason", end.reason);
  if (!end.ties.empty()) {
    Json ties = Json::array();
    for (const std::string& tie : end.ties) ties.push(tie);
    json.set("ties", std::move(ties));
  }
  json.set("rescaled", says_rescaled(system, effort));
  json.set("digits", digits).set("bits", effort.bits).set("attempts", effort.attempts);
  json.set("lost_bits", effort.tangent_bits);
  if (!output.empty()) json.set("archive", output);
  return json;
}

std::string certified_text(const System& system, const CertifiedEnd& end, const CertifiedTask& task,
                           const CertifiedEffort& effort, const std::string& output,
                           double seconds) {
  const int digits = task.digits;
  std::string text = heading(system);
  text += fmt::format("  status        {}", name_of(end.fate));
  if (end.hole >= 0)
    text +=
        fmt::format(" through '{}'", system.table->holes[static_cast<std::size_t>(end.hole)].name);
  if (!end.reason.empty()) text += ": " + end.reason;
  if (says_rescaled(system, effort))
    text += "\n  velocity      gave the direction; its length was made the speed, exactly";
  for (const std::string& tie : end.ties) text += "\n  exact tie     " + tie;
  text += fmt::format("\n  collisions    {}", grouped(end.collisions));
  const std::string wall = wall_of(system, end.wall);
  if (!wall.empty()) text += fmt::format(", the last on '{}'", wall);
  text += fmt::format("\n  t             {}\n  position      {}, {}", end.t.text(digits),
                      end.x.text(digits), end.y.text(digits));
  if (system.table->lattice)
    text += fmt::format("   in cell {}, {}", end.cell.first, end.cell.second);
  text += fmt::format("\n  velocity      {}, {}\n", end.vx.text(digits), end.vy.text(digits));
  text += fmt::format("  guaranteed    {}, by {} bits ({} lost on the way, {})\n",
                      counted(static_cast<std::uint64_t>(digits), "decimal"), effort.bits,
                      static_cast<long>(effort.tangent_bits),
                      counted(static_cast<std::uint64_t>(effort.attempts), "attempt"));
  text += fmt::format("  computed in   {:.3g} s\n", seconds);
  text += "  checked       every printed digit, by enclosures\n";
  return output.empty() ? text : text + fmt::format("  archive       {}\n", output);
}

namespace {

void follow(CertifiedOrbit& orbit, const Options& options, const CertifiedTask& task,
            CertifiedArchive* archive) {
  files::Progress progress(!options.quiet);
  while (const auto hit = orbit.next()) {
    if (archive) archive->hit(*hit);
    if (progress.due()) {
      const double by_hits = task.collisions == 0 ? 0.0
                                                  : static_cast<double>(hit->number) /
                                                        static_cast<double>(task.collisions);
      const double by_time = task.t_max ? hit->t.to_double() / task.t_max->to_double() : 0.0;
      progress.show(
          std::max(by_hits, by_time),
          files::with_prefix(static_cast<double>(hit->number) / progress.seconds()) + "hits/s");
    }
  }
}

}  // namespace

void check_form(const System& system, const char* option) {
  const auto refuse = [&](const char* what, const char* expected) {
    throw InputError(Place{"command line", 0, 0, option}, std::string(what) + " no exact form",
                     expected);
  };
  if (system.has_forces())
    refuse("[[potential]] and [interaction] have", "a system without forces, or double precision");
  if (system.of_discs()) refuse("hard discs have", "point particles, or double precision");
  if (system.particles.size() > 1)
    refuse("several particles have", "particles.count = 1, or double precision");
  if (!system.injections.empty())
    refuse("[[injection]] has", "a system without it, or double precision");
}

ExactStart exact_start(const State& state) {
  ExactStart start;
  start.position = {state.position.x, state.position.y};
  start.direction = {state.velocity.x, state.velocity.y};
  start.wall = state.wall;
  start.u = state.u;
  return start;
}

CertifiedTask certified_task(const Options& options, LoadedSystem& loaded) {
  check_options(options);
  check_form(loaded.system, "--precision");
  draw_start(options, loaded);
  return task_of(options, loaded);
}

int run_certified(const Options& options) {
  LoadedSystem loaded = load(options, run_overrides(options));
  const CertifiedTask task = certified_task(options, loaded);
  const Stopwatch watch;
  const std::atomic<bool>& signal = catch_interrupts();
  CertifiedOrbit orbit(loaded.exact, task,
                       [&signal] { return signal.load(std::memory_order_relaxed); });
  std::unique_ptr<CertifiedArchive> archive;
  if (!options.output.empty())
    archive = std::make_unique<CertifiedArchive>(
        options.output, loaded, provenance_of(options, loaded.system, 1), task, options.force,
        lock_output(options, options.output));
  follow(orbit, options, task, archive.get());
  const CertifiedEnd& end = orbit.end_state();
  const bool interrupted = end.fate == CertifiedFate::interrupted;
  const double seconds = watch.seconds(), cpu_seconds = watch.cpu_seconds();
  if (archive) archive->finish(end, orbit.effort(), name_of(end.fate), !interrupted);
  const CertifiedEffort& effort = orbit.effort();
  const std::string archive_name = named_archive(options, options.output);
  print_report(
      options,
      [&] {
        return certified_json(loaded.system, end, task, effort, archive_name, seconds, cpu_seconds);
      },
      [&] { return certified_text(loaded.system, end, task, effort, archive_name, seconds); });
  return interrupted ? stopped : done;
}

void CertifiedOutcome::save(const std::string& file, bool force, const std::atomic<bool>&) const {
  CertifiedArchive archive(followed(file), loaded->loaded,
                           provenance_of(loaded->options, system(), 1), task, force);
  for (const CertifiedHit& hit : hits) archive.hit(hit);
  archive.finish(end, effort, name_of(end.fate), end.fate != CertifiedFate::interrupted);
}

OutcomePointer open_certified(const std::string& file) {
  StoredCertified stored = read_certified(file);
  if (!stored.end.x.has_value())
    throw InputError(Place{file, 0, 0, ""}, "the run was interrupted before its first state");
  auto outcome = std::make_shared<CertifiedOutcome>(
      loaded_again("run", stored.system_toml, stored.system_name, file));
  outcome->task = std::move(stored.task);
  outcome->end = std::move(stored.end);
  outcome->effort = stored.effort;
  outcome->hits = std::move(stored.hits);
  return outcome;
}

}  // namespace carom::cli
