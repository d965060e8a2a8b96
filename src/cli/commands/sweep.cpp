#include "cli/commands/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include "carom/base/error.hpp"
#include "cli/commands/ensemble_job.hpp"
#include "cli/commands/run_shared.hpp"
#include "cli/commands/sweep_plan.hpp"
#include "cli/common.hpp"
#include "cli/ranks.hpp"
#include "cli/reports/sweep_report.hpp"
#include "cli/temporary_folder.hpp"
#include "files/checkpoint/rank_parts.hpp"
#include "files/checkpoint/sweep_archive.hpp"
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
  bool has_begun(std::size_t index) const;
  bool take_kept_report(std::size_t index);
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

/// What a rank is told to do with a value.
constexpr const char *begin_value = "begin", *resume_value = "resume", *stop_here = "stop",
                     *skip_value = "skip";

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
    throw InputError(Place{"command line", 0, 0, "--output"}, "a sweep goes on in the same archive",
                     "no -o beside --resume");
  std::optional<files::StoredSweep> stored;
  if (!files::has_sweep(file_)) {
    stored = files::read_sweep(file_);
    complete_ = stored->complete;
    result_.plan = stored->plan;
    before_ = stored->origins;
  } else {
    result_.plan = files::kept_plan(file_);
  }
  if (result_.plan.command != options_.command)
    throw InputError(Place{file_, 0, 0, ""},
                     fmt::format("it is a sweep of carom {}", result_.plan.command),
                     fmt::format("carom {} --resume {}", result_.plan.command, file_));
  if (asks_for_a_system(options_)) {
    if (options_.sweep.empty() || options_.system.empty())
      throw InputError(Place{"command line", 0, 0, "--resume"},
                       "a sweep that goes on is not changed",
                       "SYSTEM and all options as before, or none of them");
    refuse_another(result_.plan, plan_of_sweep(options_), file_);
  }
  restore_options(result_.plan, options_);
  if (complete_) return;
  lock_ = lock_output(options_, file_);
  // Now, and not after hours of computing.
  for (std::size_t i = 0; !stored && i < result_.plan.systems.size(); ++i)
    files::kept_report(file_, result_.plan, i);
  catch_interrupts();
  if (stored) files::unpack_sweep(file_);
}

bool Sweep::has_begun(std::size_t index) const {
  const std::string value = files::value_of_sweep(file_, index);
  return files::exists(value) || has_checkpoint(value) || !files::parts_of_ranks(value).empty();
}

// A value whose command cannot go on is done where its report is there. So is one that measured
// nothing: its archive does not say why.
bool Sweep::take_kept_report(std::size_t index) {
  if (file_.empty()) return false;
  const auto report = files::kept_report(file_, result_.plan, index);
  if (!report) return false;
  SweepRow row(index, Json::parse(*report, file_));
  if (is_plain_ensemble(options_) && !row.measured_nothing()) return false;
  result_.rows.push_back(std::move(row));
  return true;
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

int Sweep::compute_all() {
  const std::atomic<bool>& interrupted = catch_interrupts();
  int worst = done;
  for (std::size_t i = 0; i < result_.plan.systems.size(); ++i) {
    std::string task = begin_value;
    if (first()) {
      if (interrupted && !ranks_)
        task = stop_here;
      else if (take_kept_report(i))
        task = skip_value;
      else if (!file_.empty() && is_plain_ensemble(options_) && has_begun(i))
        task = resume_value;
    }
    task = tell(task);
    if (task == stop_here) return stopped;
    if (task == skip_value) {
      if (first() && !result_.rows.back().doubts().empty()) worst = std::max<int>(worst, untrusted);
      continue;
    }
    const std::string archive = file_.empty() ? "" : files::value_of_sweep(file_, i);
    if (first() && !file_.empty()) files::remove_report(file_, i);  // of what is gone on with
    const int status = compute(i, archive, task == resume_value);
    if (status == bad_input || status == usage) return status;
    const bool ended = status != stopped;
    if (first() && !file_.empty() && !result_.rows.empty()) {
      if (ended || is_plain_ensemble(options_)) {
        files::keep_report(file_, result_.plan, i, result_.rows.back().report.text());
      } else {
        std::remove(archive.c_str());
        result_.rows.pop_back();
      }
    }
    if (!ended) return stopped;
    worst = std::max(worst, status);
  }
  return worst;
}

// A complete sweep: its reports, or those that another window gives.
int Sweep::show_stored() {
  const files::StoredSweep stored = files::read_sweep(file_);
  const bool again = is_plain_ensemble(options_) && !options_.window.empty();
  int worst = done;
  for (std::size_t i = 0; i < stored.reports.size(); ++i) {
    if (!again) {
      result_.rows.emplace_back(i, Json::parse(stored.reports[i], file_));
      if (!result_.rows.back().doubts().empty()) worst = untrusted;
      continue;
    }
    const TemporaryFolder folder;
    const std::string archive = folder.file("value.h5");
    if (!files::extract_value(file_, i, archive))
      throw InputError(Place{file_, 0, 0, fmt::format("values/{}", i)}, "there is no archive",
                       "a sweep as carom wrote it");
    worst = std::max(worst, compute(i, archive, true));
  }
  result_.status = stored.status;
  print_sweep(options_, result_, file_);
  return worst;
}

// After an error. Where nothing was computed, nothing is left.
void Sweep::say_what_is_kept() {
  bool any = false;
  for (std::size_t i = 0; i < result_.plan.systems.size() && !any; ++i)
    any = has_begun(i) || files::has_report(file_, i);
  if (!any) return files::remove_sweep(file_);
  if (!options_.hidden_archive)
    warn(fmt::format("what was computed is kept; this goes on with it: carom {} --resume {}",
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
    warn(fmt::format("this goes on with it: carom {} --resume {}", options_.command, file_));
  return status;
}

int Sweep::run() {
  constexpr const char *go = "go", *nothing = "nothing";
  const std::string word = word_of_first(ranks_, [&] {
    prepare();
    return complete_ ? nothing : go;
  });
  if (word.empty()) return bad_input;
  if (word == nothing) return first() ? show_stored() : done;
  if (ranks_) {
    const std::string plan = tell(first() ? result_.plan.json().text() : "");
    file_ = tell(file_);
    if (!first()) result_.plan = files::SweepPlan::of(Json::parse(plan, "plan"), "plan");
    restore_options(result_.plan, options_);
  }
  int status = bad_input;
  try {
    status = compute_all();
  } catch (...) {
    if (first() && !file_.empty()) say_what_is_kept();
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
    throw InputError(Place{file, 0, 0, ""}, "there is no sweep to go on with",
                     fmt::format("an archive of carom {} --sweep", options.command));
  return false;
}

int sweep(const Options& options, SweptCommand command) { return Sweep(options, command).run(); }

}  // namespace carom::cli
