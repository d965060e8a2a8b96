// carom run: one trajectory, of one or several particles.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>

#include "analyses/run/command_certified.hpp"
#include "analyses/run/report.hpp"
#include "analyses/run/stored_run.hpp"
#include "carom/analyses/run.hpp"
#include "carom/analyses/run/archive.hpp"
#include "carom/analyses/run/rows.hpp"
#include "carom/base/error.hpp"
#include "carom/files/ensembles.hpp"
#include "carom/starts/injection.hpp"
#include "carom/starts/sampler.hpp"
#include "cli/commands/commands.hpp"
#include "cli/commands/own_step.hpp"
#include "cli/common.hpp"
#include "cli/loading.hpp"
#include "cli/reports/doubts.hpp"
#include "cli/signals.hpp"
#include "files/progress.hpp"

namespace carom::cli {

namespace {

// Passes everything on and remembers how far the run is.
class Counting : public Observer {
 public:
  explicit Counting(Observer* next) : next_(next) {}
  void hit(const HitEvent& event) override {
    ++hits;
    time = event.time.value();
    if (next_) next_->hit(event);
  }
  void contact(const ContactEvent& event) override {
    time = event.time.value();
    if (next_) next_->contact(event);
  }
  void sample(int particle, Time at, const State& state) override {
    if (next_) next_->sample(particle, at, state);
  }
  bool sampled(Time at) override {
    time = at.value();
    return !next_ || next_->sampled(at);
  }
  std::uint64_t hits = 0;
  double time = 0.0;

 private:
  Observer* next_;
};

}  // namespace

// A run that is asked for a number of collisions has no last time, unless that is asked for too.
SystemOverrides run_overrides(const Options& options) {
  SystemOverrides overrides = options.overrides;
  if (!overrides.collisions.empty() && overrides.t_max.empty())
    overrides.t_max = fmt::format("{}", no_last_time);
  return overrides;
}

namespace {

void refuse_going_back(const System& system, const StoredRun& stored) {
  const bool more_hits = system.run.collisions == 0;
  for (const ParticleProgress& p : stored.particles) {
    if (p.state.time > Time(system.run.t_max) ||
        (p.fate == Fate::survived && p.end > Time(system.run.t_max)))
      throw InputError(Place{"command line", 0, 0, "--t-max"},
                       fmt::format("the stored run has already reached t = {}", p.end.value()),
                       "a later time");
    if (!more_hits && p.hits > system.run.collisions)
      throw InputError(Place{"command line", 0, 0, "--collisions"},
                       "the stored run has already " + counted(p.hits, "collision"),
                       "a larger number");
  }
}

// A limit on hits stops each particle at a time of its own, and those that go on feel its force no
// more. Flown on from there they would meet at times that are not the same.
void refuse_other_times(const System& system, const StoredRun& stored) {
  if (!act_on_each_other(system)) return;
  for (const ParticleProgress& p : stored.particles)
    if (p.fate == Fate::capped && (system.run.collisions == 0 || p.hits < system.run.collisions))
      throw InputError(Place{"command line", 0, 0, "--collisions"},
                       "particles that act on each other were stopped by the limit on collisions, "
                       "each at a different time",
                       "a new run with more --collisions");
}

// Afterwards the archive is that of an uninterrupted run, so only how far it goes, what is sampled
// and how much energy may change are open.
void refuse_another_run(const Options& options, const LoadedSystem& loaded,
                        const StoredRun& stored) {
  const auto refuse = [&](const std::string& what) {
    throw InputError(Place{options.resume, 0, 0, ""},
                     "this is another run than the stored one: " + what,
                     "a later --t-max, more --collisions, or a new run");
  };
  // As this build writes it: that of an earlier one may lack keys.
  const std::string before = read_system(stored.system_toml, options.resume).resolved_toml;
  const std::string differs = difference(
      before, loaded.resolved_toml,
      {"run.t_max", "run.collisions", "run.sample", "run.times", "integrator.energy_tolerance"});
  if (!differs.empty()) refuse(differs);
  if (const std::string engine = engine_of(loaded.system); engine != stored.engine)
    refuse(fmt::format("--engine is {}, not {}", engine, stored.engine));
  if (!options.trajectory.empty() &&
      whole_number(options.trajectory, "--trajectory", 0) != stored.trajectory)
    refuse(fmt::format("--trajectory is {}, not {}", options.trajectory, stored.trajectory));
}

// The archive stays as it is, and the result is printed again; that nothing was added must be said.
void say_if_ended(const StoredRun& stored) {
  const auto ended = [](const ParticleProgress& p) {
    return p.fate == Fate::escaped || p.fate == Fate::unbounded || p.fate == Fate::singular ||
           is_failure(p.fate);
  };
  if (!std::all_of(stored.particles.begin(), stored.particles.end(), ended)) return;
  const Fate fate = stored.particles.front().fate;
  const bool same = std::all_of(stored.particles.begin(), stored.particles.end(),
                                [&](const ParticleProgress& p) { return p.fate == fate; });
  const std::string how = same && fate == Fate::escaped ? "escaped"
                          : same                        ? fmt::format("ended ({})", name_of(fate))
                                                        : "ended";
  warn(fmt::format("the orbit has already {}: there is nothing to continue", how));
}

}  // namespace

LoadedSystem system_of_run(const Options& options) {
  LoadedSystem loaded = load(options, run_overrides(options));
  choose_engine(options.engine, loaded.system);
  return loaded;
}

int run(const Options& options) {
  if (options.precision != "double" || !options.digits.empty()) {
    return run_certified(options);
  }
  check_engine(options);
  SingleRunOptions how;
  if (!options.trajectory.empty())
    how.trajectory = whole_number(options.trajectory, "--trajectory", 0);

  LoadedSystem loaded;
  std::optional<files::Progress> preparing(std::in_place, !options.quiet);
  std::unique_ptr<RunArchive> archive;
  std::string output = options.output;
  ArchiveLock lock;
  const auto begin_archive = [&](bool force) {
    if (!output.empty())
      archive = RunArchive::create(output, loaded, provenance_of(options, loaded.system, 1), force,
                                   how.trajectory, lock);
  };
  if (options.resume.empty()) {
    loaded = load(options, run_overrides(options));
    choose_engine(options.engine, loaded.system);
    // Of a picture: where forces act, hits alone would be joined by straight lines.
    RunPlan& plan = loaded.system.run;
    if (options.hidden_archive && engine_of(loaded.system) != "events" && plan.sample == 0.0 &&
        plan.t_max < no_last_time)
      plan.sample = plan.t_max / 2000;
    check_start(loaded.system);  // a start that is impossible must not cost an old archive
    // From here on a signal must leave a valid archive. Before, it simply ends the program,
    // whatever that computes.
    catch_interrupts();
    if (!output.empty()) lock = lock_output(options, output);
    begin_archive(options.force);
  } else {
    if (output.empty()) output = options.resume;
    lock = lock_output(options, output);
    const StoredRun stored = read_run(options.resume);
    loaded = read_system(stored.system_toml, options.resume + ": /system", run_overrides(options));
    loaded.system.name = stored.system_name;
    choose_engine(options.engine == "auto" && stored.engine == "steps" ? "steps" : options.engine,
                  loaded.system);
    refuse_injections(loaded.system, "a run that is continued");
    if (!options.overrides.trust_tolerance.empty())
      throw InputError(Place{"command line", 0, 0, "--trust-tolerance"},
                       "the stored run has its own tolerance", "a new run");
    analyses::check_stored(stored, loaded.system, options.resume);
    refuse_another_run(options, loaded, stored);
    catch_interrupts();
    how.resume = stored.particles;
    how.steps = stored.steps;
    how.evaluations = stored.evaluations;
    how.seconds = stored.seconds;
    how.cpu_seconds = stored.cpu_seconds;
    how.trajectory = stored.trajectory;
    refuse_going_back(loaded.system, stored);
    refuse_other_times(loaded.system, stored);
    say_if_ended(stored);
    archive = RunArchive::extend(options.resume, output, loaded,
                                 provenance_of(options, loaded.system, 1), options.force, lock);
  }
  const std::atomic<bool>& interrupted = catch_interrupts();
  const System& system = loaded.system;
  if (estimates_trust(system)) how.written = written_system(loaded);
  how.estimate_state_error = true;

  preparing.reset();
  OwnStep own_step(options);
  SingleRunResult result;
  for (;;) {
    Counting counting(archive.get());
    files::Progress progress(!options.quiet);
    how.interrupted = [&] {
      if (progress.due()) {
        const double by_time = counting.time / system.run.t_max;
        const double by_hits = system.run.collisions == 0
                                   ? 0.0
                                   : static_cast<double>(counting.hits) /
                                         (static_cast<double>(system.run.collisions) *
                                          static_cast<double>(system.particles.size()));
        progress.show(by_time > by_hits ? by_time : by_hits,
                      counting.hits > 0 ? files::with_prefix(static_cast<double>(counting.hits) /
                                                             progress.seconds()) +
                                              "hits/s"
                                        : fmt::format("t = {:.4g}", counting.time));
      }
      return interrupted.load(std::memory_order_relaxed);
    };
    if (archive) {
      archive->listen(how.interrupted);
      how.started = [&](const World& world) { archive->start(start_rows(world, *system.table)); };
    }
    result = run_single(system, counting, how);
    if (result.interrupted || !own_step.halve(loaded, energy_error_of(result))) break;
    archive.reset();
    begin_archive(true);
  }
  const std::string status = run_status(result);
  if (archive) archive->finish(result, status);

  warn_of(result);
  const std::string archive_name = named_archive(options, output);
  const Doubts doubts = doubts_of(system, result);
  print_report(
      options,
      [&] { return own_step.with_halvings(run_json(system, result, status, archive_name)); },
      [&] {
        return run_text(system, result, status, archive_name, options.verbose) + own_step.text();
      },
      doubts.text());
  return doubts.status(!result.interrupted);
}

}  // namespace carom::cli
