// A command that runs an ensemble, from the start or from where it was left.
#pragma once

#include <fmt/format.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "carom/analyses/kinds.hpp"
#include "carom/base/error.hpp"
#include "carom/files/ensembles.hpp"
#include "cli/commands/ensemble_job.hpp"
#include "cli/commands/own_step.hpp"
#include "cli/common.hpp"
#include "cli/loading.hpp"
#include "cli/ranks.hpp"
#include "cli/reports/ensemble_context.hpp"
#include "cli/signals.hpp"
#include "files/progress.hpp"

namespace carom::cli {

template <class Result>
EnsembleJob<Result> job_of(const Options& options, Sharing sharing = Sharing::alone) {
  if (!options.resume.empty()) return job_to_go_on<Result>(options, sharing);
  EnsembleJob<Result> job;
  job.output = options.output;
  job.shard = shard_of(options);
  // First, for a step may be chosen by minutes of trial runs.
  if (!job.output.empty() && sharing != Sharing::other) {
    job.lock = lock_output(options, job.output);
    refuse_existing(job.output, options.force);
  }
  job.loaded = load_ensemble(options);
  return job;
}

template <class Result>
EnsembleOptions<Result> how_to_run(const Options& options) {
  EnsembleOptions<Result> how;
  how.threads = threads_of(options);
  how.lanes = instruction_set_of(options);
  if (!options.block.empty()) how.block = whole_number(options.block, "--block", 1);
  if (!options.checkpoint.empty()) {
    const CheckpointInterval interval = checkpoint_interval(options.checkpoint);
    how.save_every = interval.seconds;
    how.save_every_blocks = interval.blocks;
  }
  return how;
}

template <class Result>
Provenance origin_of(const Options& options, const EnsembleJob<Result>& job) {
  Provenance origin = provenance_of(options, job.loaded.system, threads_of(options));
  if (job.stored) origin.before = job.stored->origins;
  return origin;
}

// The archive that the ensemble goes into, or null.
template <class Result>
std::unique_ptr<EnsembleArchive<Result>> archive_of(const Options& options,
                                                    const EnsembleJob<Result>& job) {
  using Archive = EnsembleArchive<Result>;
  if (job.output.empty()) return nullptr;
  const typename Archive::Plan plan{options.force, options.per_trajectory, job.shard, warn,
                                    job.lock};
  const Provenance origin = origin_of(options, job);
  if (job.stored)
    return std::make_unique<Archive>(job.output, job.loaded, origin, *job.stored, plan);
  return std::make_unique<Archive>(job.output, job.loaded, origin, plan);
}

inline const char* status_of(bool complete) { return complete ? "completed" : "interrupted"; }

inline EnsembleContext context_of(const Options& options, std::string status, std::string output,
                                  const Shard& part) {
  return {std::move(status), std::move(output), part, options.verbose, rows_of(options)};
}

/// Prints a result; the exit status. `complete`: it was not interrupted.
int report(const Options& options, const System& system, const auto& result,
           const EnsembleContext& context, bool complete, const OwnStep* own_step = nullptr) {
  const Doubts doubts = doubts_of(system, result);
  warn_of(result.reports, doubts.failed);
  const auto json = [&] { return result_json(system, result, context); };
  const auto text = [&] { return result_text(system, result, context); };
  print_report(
      options, [&] { return own_step ? own_step->with_halvings(json()) : json(); },
      [&] { return own_step ? text() + own_step->text() : text(); }, doubts.text());
  return doubts.status(complete);
}

template <class Result>
int report(const Options& options, const EnsembleJob<Result>& job, const Result& result,
           const std::string& status, const OwnStep* own_step = nullptr) {
  return report(options, job.loaded.system, result,
                context_of(options, status, named_archive(options, job.output), job.shard),
                result.complete, own_step);
}

template <class Result>
void say_how_to_go_on(const Options& options, const EnsembleJob<Result>& job, std::uint64_t kept) {
  if (named_archive(options, job.output).empty() || kept == 0) return;
  warn(fmt::format("{} {} kept; to continue: carom {} --resume {}", counted(kept, "trajectory"),
                   kept == 1 ? "is" : "are", options.command, job.output));
}

// Reports a result that was just computed. How to go on is said at the end, where it is seen; it is
// said also if the report cannot be written.
template <class Result>
int report_and_say_how_to_go_on(const Options& options, const EnsembleJob<Result>& job,
                                const Result& result, const std::string& status,
                                const OwnStep& own_step) {
  const bool said = options.of_sweep && options.of_sweep->index > 0;
  if (options.isa != "auto" && !result.lanes && !said)
    warn("--isa changed nothing: these particles fly one after the other, in no lanes");
  const auto go_on = [&] {
    if (!result.complete) say_how_to_go_on(options, job, result.done.size());
  };
  int exit = done;
  try {
    exit = report(options, job, result, status, &own_step);
  } catch (...) {
    go_on();
    throw;
  }
  go_on();
  return exit;
}

// Runs the ensemble and shows the progress of this process.
template <class Result>
Result fly(const Options& options, const System& system, EnsembleOptions<Result> how) {
  const double all = static_cast<double>(how.part.last - how.part.first);
  const std::uint64_t before = how.before ? how.before->done.size() : 0;
  files::Progress progress(!options.quiet, all > 0 ? static_cast<double>(before) / all : 0.0);
  if (progress.enabled())
    how.progress = [&](std::uint64_t trajectories, std::uint64_t hits) {
      if (progress.due())
        progress.show(
            static_cast<double>(trajectories) / all,
            hits > 0 ? files::with_prefix(static_cast<double>(hits) / progress.seconds()) + "hits/s"
                     : files::with_prefix(static_cast<double>(trajectories) / progress.seconds()) +
                           "trajectories/s");
    };
  return flown(system, how);  // run_escape in analyses/escape/escape.cpp, and its likes
}

inline SplittingOptions how_to_complete(const Options& options) {
  SplittingOptions how;
  how.threads = threads_of(options);
  how.lanes = instruction_set_of(options);
  how.interrupted = &catch_interrupts();
  return how;
}

// Refuses a system of which nothing could be measured. A value of a sweep has none then.
void refuse_nothing(const Options& options, const System& system, const auto& result) {
  if (options.of_sweep) return;
  if (const auto error = why_nothing(system, result)) throw *error;
}

template <class Result>
int run_alone(const Options& options) {
  check_engine(options);
  EnsembleOptions<Result> how = how_to_run<Result>(options);
  std::optional<files::Progress> preparing(std::in_place, !options.quiet);
  EnsembleJob<Result> job = job_of<Result>(options);
  preparing.reset();
  how.interrupted =
      &catch_interrupts();  // until here a signal ends the program, whatever it computes
  if (job.stored && job.stored->result.complete) {
    if (job.lock)
      remove_checkpoint(job.output);  // left by a process that was killed at its last step
    job.lock.reset();
    return report(options, job, job.stored->result, job.stored->status);
  }
  how.part = job.shard.range(job.loaded.system.run.trajectories);
  if (job.stored) how.before = &job.stored->result;
  std::unique_ptr<EnsembleArchive<Result>> archive;
  OwnStep own_step(options);
  Result result;
  for (;;) {
    archive = archive_of(options, job);
    how.journal = archive.get();
    try {
      result = fly(options, job.loaded.system, how);
    } catch (...) {
      if (archive) say_how_to_go_on(options, job, archive->kept());
      throw;
    }
    if (!result.complete || !own_step.halve(job.loaded, result.energy_error)) break;
    archive.reset();
    if (!job.output.empty()) remove_checkpoint(job.output);
  }
  try {
    refuse_nothing(options, job.loaded.system, result);
  } catch (...) {
    const bool written = archive != nullptr;
    archive.reset();
    if (written) remove_checkpoint(job.output);
    throw;
  }
  try {
    if (archive) archive->finish(result, status_of(result.complete));
  } catch (...) {
    if (archive) say_how_to_go_on(options, job, archive->kept());
    throw;
  }
  archive.reset();  // whatever becomes of the report
  job.lock.reset();
  return report_and_say_how_to_go_on(options, job, result, status_of(result.complete), own_step);
}

/// On several ranks (run_shared.cpp).
template <class Result>
int run_shared(const Options&, Ranks&);

template <class Result>
int run_ensemble(const Options& options) {
  if (Ranks* const ranks = start_ranks()) return run_shared<Result>(options, *ranks);
  return run_alone<Result>(options);
}

}  // namespace carom::cli
