#include "cli/commands/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <utility>

#include "carom/base/error.hpp"
#include "cli/commands/ensemble_job.hpp"
#include "cli/commands/run_ensemble.hpp"
#include "cli/common.hpp"
#include "cli/loading.hpp"
#include "cli/outcome.hpp"
#include "cli/ranks.hpp"
#include "cli/signals.hpp"
#include "files/checkpoint/rank_parts.hpp"
#include "files/checkpoint/work_folder.hpp"

namespace carom::cli {

using files::Json;

namespace {

bool asks_for_a_system(const Options& options) {
  const SystemOverrides& o = options.overrides;
  return !options.system.empty() || !options.sweep.empty() || !o.set.empty() || !o.seed.empty() ||
         !o.trajectories.empty() || !o.t_max.empty() || !o.collisions.empty() || !o.times.empty() ||
         !o.position.empty() || !o.velocity.empty();
}

class Sweep {
 public:
  Sweep(const Options& options, SweptCommand command)
      : options_(options),
        command_(command),
        ranks_(is_plain_ensemble(options) ? start_ranks() : nullptr) {}

  int run();

 private:
  bool first() const { return !ranks_ || ranks_->rank() == 0; }
  /// What rank 0 says.
  std::string tell(const std::string& text) const { return ranks_ ? ranks_->tell(text) : text; }
  void prepare();
  void go_on(const std::string& file);
  int compute(std::size_t index, const std::string& archive, bool goes_on);
  int take_stored(std::size_t index, const std::string& archive);
  bool has_begun(std::size_t index) const;
  int compute_all();
  int show_stored();
  int finish(int status);
  void say_what_is_kept();

  Options options_;
  const SweptCommand command_;
  Ranks* ranks_;
  SweepResult result_;
  ArchiveLock lock_;
  std::string file_;       ///< archive, or ""
  bool complete_ = false;  ///< the archive is, and is only shown
  std::vector<Origin> before_;
};

/// What a rank has to do with a value.
constexpr const char *begin_value = "begin", *stored_value = "stored", *stop_here = "stop";

void Sweep::prepare() {
  check_engine(options_);
  if (!options_.resume.empty()) return go_on(archive_named(options_.resume));
  result_.plan = plan_of_sweep(options_);
  file_ = options_.output;
  if (file_.empty()) return;
  lock_ = lock_output(options_, file_);
  refuse_existing(file_, options_.force);
  catch_interrupts();  // from here on there is something to go on with
  files::give_up_checkpoint(file_);
  files::keep_plan(file_, result_.plan);
}

void Sweep::go_on(const std::string& file) {
  file_ = file;
  if (!options_.output.empty() && options_.output != file_)
    throw InputError(Place{"command line", 0, 0, "--output"},
                     "a sweep continues in the same archive", "no -o beside --resume");
  const bool in_parts = files::has_sweep(file_);
  files::StoredSweep stored = files::read_sweep(file_);
  result_.plan = std::move(stored.plan);
  result_.status = stored.status;
  complete_ = stored.complete;
  if (!in_parts) before_ = stored.origins;
  if (result_.plan.command != options_.command)
    throw InputError(Place{file_, 0, 0, ""},
                     fmt::format("it is a sweep of carom {}", result_.plan.command),
                     fmt::format("carom {} --resume {}", result_.plan.command, file_));
  if (asks_for_a_system(options_)) {
    if (options_.sweep.empty() || options_.system.empty())
      throw InputError(Place{"command line", 0, 0, "--resume"},
                       "a continued sweep cannot be changed",
                       "SYSTEM and all options as before, or none of them");
    refuse_another(result_.plan, plan_of_sweep(options_), file_);
  }
  if (complete_) return;
  lock_ = lock_output(options_, file_);
  if (in_parts) files::check_parts(file_, result_.plan);  // now, and not after hours of computing
  catch_interrupts();
  if (!in_parts) files::unpack_sweep(file_);
}

// Commands that cannot go on begin anew with a value that was interrupted.
bool Sweep::has_begun(std::size_t index) const {
  const std::string part = files::part_of_sweep(file_, index);
  if (!is_plain_ensemble(options_)) return is_complete(part);
  return files::exists(part) || has_checkpoint(part) || !files::parts_of_ranks(part).empty();
}

int Sweep::compute(std::size_t index, const std::string& archive, bool goes_on) {
  Options one = options_;
  one.sweep.clear();
  one.overrides = {};
  one.on = one.direction = one.points = one.orbits = "";
  one.system = goes_on ? "" : result_.plan.system_name;
  one.output = goes_on ? "" : archive;
  one.resume = goes_on ? archive : "";
  one.force = true;
  auto value = std::make_shared<ValueOfSweep>();
  value->index = index;
  value->system_name = result_.plan.system_name;
  value->system_toml = result_.plan.systems[index];
  value->take = [&](const Json& report, const std::string& doubts) {
    result_.rows.emplace_back(index, report, doubts);
  };
  one.of_sweep = value;
  return command_(one);
}

// Of an ensemble its command goes on with what is stored, or reports it by another window.
int Sweep::take_stored(std::size_t index, const std::string& archive) {
  if (is_plain_ensemble(options_)) return compute(index, archive, true);
  result_.rows.emplace_back(index, *open_outcome(archive));
  return result_.rows.back().doubts().empty() ? done : untrusted;
}

int Sweep::compute_all() {
  const std::atomic<bool>& interrupted = catch_interrupts();
  int worst = done;
  for (std::size_t i = 0; i < result_.plan.systems.size(); ++i) {
    std::string task = begin_value;
    if (first() && interrupted && !ranks_)
      task = stop_here;
    else if (first() && !file_.empty() && has_begun(i))
      task = stored_value;
    task = tell(task);
    if (task == stop_here) return stopped;
    const std::string archive = file_.empty() ? "" : files::part_of_sweep(file_, i);
    const int status = task == stored_value ? take_stored(i, archive) : compute(i, archive, false);
    if (status == bad_input || status == usage) return status;
    if (status == stopped) {
      if (!file_.empty() && !is_plain_ensemble(options_)) {
        std::remove(archive.c_str());
        std::erase_if(result_.rows, [&](const SweepRow& row) { return row.index == i; });
      }
      return stopped;
    }
    worst = std::max(worst, status);
  }
  return worst;
}

// A complete sweep: its values, with the fits that another window gives.
int Sweep::show_stored() {
  int worst = done;
  for (std::size_t i = 0; i < result_.plan.systems.size(); ++i)
    worst = std::max(worst, take_stored(i, files::value_of_sweep(file_, i)));
  if (first()) print_sweep(options_, result_, file_);
  return worst;
}

// After an error. Where nothing was computed, nothing is left.
void Sweep::say_what_is_kept() {
  bool any = false;
  for (std::size_t i = 0; i < result_.plan.systems.size() && !any; ++i) any = has_begun(i);
  if (!any) return files::remove_sweep(file_);
  if (!options_.hidden_archive)
    warn(fmt::format("finished values are kept; to continue: carom {} --resume {}",
                     options_.command, file_));
}

int Sweep::finish(int status) {
  result_.status = status_of(status != stopped);
  if (const auto error = why_nothing(result_)) {
    if (!file_.empty()) files::remove_sweep(file_);
    throw *error;
  }
  end_sweep(options_, result_, file_, before_);
  lock_.reset();
  if (status == stopped && !result_.archive.empty())
    warn(fmt::format("to continue: carom {} --resume {}", options_.command, file_));
  return status;
}

int Sweep::run() {
  constexpr const char *go = "go", *only_shown = "only shown";
  const std::string word = word_of_first(ranks_, [&] {
    prepare();
    return complete_ ? only_shown : go;
  });
  if (word.empty()) return bad_input;
  file_ = tell(file_);
  int status = bad_input;
  try {
    if (!first())
      result_.plan =
          options_.resume.empty() ? plan_of_sweep(options_) : files::read_sweep(file_).plan;
    restore_options(result_.plan, options_);
    if (word == only_shown) return show_stored();
    status = compute_all();
  } catch (...) {
    if (word == go && first() && !file_.empty()) say_what_is_kept();
    if (ranks_) ranks_->give_up();  // the others wait for the next value
    throw;
  }
  if (!first() || status == bad_input || status == usage) return status;
  return finish(status);
}

}  // namespace

bool is_sweep(const Options& options) {
  if (!options.sweep.empty()) return true;
  if (options.resume.empty()) return false;
  const std::string file = archive_named(options.resume);
  if (files::has_sweep(file) || files::is_sweep_archive(file)) return true;
  if (!is_plain_ensemble(options) && options.command != "run" && options.command != "escape")
    throw InputError(Place{file, 0, 0, ""}, "there is no sweep to continue",
                     fmt::format("an archive of carom {} --sweep", options.command));
  return false;
}

int sweep(const Options& options, SweptCommand command) { return Sweep(options, command).run(); }

void print_sweep(const Options& options, SweepResult& result, const std::string& file) {
  const System base = result.plan.base().system;
  result.title = base.title.empty() ? base.name : base.title;
  result.archive = named_archive(options, file);
  print_report(
      options, [&] { return sweep_json(result); }, [&] { return sweep_text(result); });
}

void keep_sweep(const Options& options, const SweepResult& result, const std::string& file,
                const std::vector<Origin>& before) {
  LoadedSystem base = result.plan.base();
  if (options.command != "relax") choose_engine(options.engine, base.system);
  Provenance origin = provenance_of(options, base.system, threads_of(options));
  origin.before = before;
  files::write_sweep(file, result.plan, sweep_numbers(result), origin, result.status,
                     result.status == "completed");
}

void end_sweep(const Options& options, SweepResult& result, const std::string& file,
               const std::vector<Origin>& before) {
  if (!file.empty()) keep_sweep(options, result, file, before);
  print_sweep(options, result, file);
}

}  // namespace carom::cli
