// carom escape: survival probability and escape rate of an ensemble.
#include "carom/ensemble/escape.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <optional>

#include "carom/base/error.hpp"
#include "cli/commands.hpp"
#include "cli/certified_sample.hpp"
#include "cli/common.hpp"
#include "cli/escape_job.hpp"
#include "cli/escape_report.hpp"
#include "cli/mpi_ranks.hpp"
#include "io/progress.hpp"

namespace carom::cli {

namespace {

void warn(const std::string& text) { fmt::print(stderr, "carom: {}\n", text); }

// The archive that the ensemble goes into, or null.
std::unique_ptr<EscapeArchive> archive_of(const Options& options, const EscapeJob& job) {
  if (job.output.empty()) return nullptr;
  const EscapeArchive::Plan plan{options.force, options.per_trajectory, job.shard, warn};
  const Provenance origin = provenance_of(options, job.loaded.system, threads_of(options));
  if (job.stored) return std::make_unique<EscapeArchive>(job.output, job.loaded, origin, *job.stored, plan);
  return std::make_unique<EscapeArchive>(job.output, job.loaded, origin, plan);
}

int report(const Options& options, const EscapeJob& job, const EscapeResult& result, const std::string& status) {
  for (const auto& [index, text] : result.reports) warn(text);
  const EscapeContext context{status, job.output, job.shard};
  print(options.json ? escape_json(job.loaded.system, result, context).text() + "\n"
                     : escape_text(job.loaded.system, result, context));
  if (result.counts.lost > 0) return lost;
  return result.complete ? done : stopped;
}

void say_how_to_go_on(const EscapeJob& job, std::uint64_t kept) {
  if (job.output.empty() || kept == 0) return;
  warn(fmt::format("{} trajectories are kept; this goes on with them: carom escape --resume {}", grouped(kept), job.output));
}

EscapeOptions how_to_run(const Options& options) {
  EscapeOptions how;
  how.threads = threads_of(options);
  how.lanes = instruction_set_of(options);
  if (!options.block.empty()) how.block = whole_number(options.block, "--block", 1);
  if (!options.checkpoint.empty()) how.save_every = seconds_between_checkpoints(options.checkpoint);
  how.interrupted = &catch_interrupts();
  return how;
}

// Options that another one gives a meaning.
void refuse_options_without_a_use(const Options& options) {
  const auto refuse = [](const std::string& given, const char* option, const char* other) {
    if (!given.empty()) throw InputError(Place{"command line", 0, 0, option}, fmt::format("it means nothing without {}", other), other);
  };
  if (options.certify_sample.empty()) refuse(options.digits, "--digits", "--certify-sample");
  if (!options.splitting.empty()) return;
  refuse(options.population, "--population", "--splitting");
  refuse(options.repetitions, "--repetitions", "--splitting");
  refuse(options.kick, "--kick", "--splitting");
  refuse(options.lookback, "--lookback", "--splitting");
}

// Any rank but the first: what it does is reported there.
int escape_as_hand(const Options& options, Ranks& ranks) {
  const std::optional<LoadedSystem> loaded = called_job(ranks);
  if (!loaded) return done;
  EscapeOptions how = how_to_run(options);
  how.ranks = &ranks;
  run_escape(loaded->system, how);
  return *how.interrupted ? stopped : done;
}

}  // namespace

int escape(const Options& options) {
  refuse_parts_of_others(options);
  refuse_options_without_a_use(options);
  if (!options.splitting.empty()) return splitting(options);
  if (!options.certify_sample.empty()) return certified_sample(options);
  const std::unique_ptr<Ranks> ranks = start_ranks();
  if (ranks && ranks->rank() > 0) return escape_as_hand(options, *ranks);
  JobCall call(ranks.get());
  check_engine(options);
  EscapeOptions how = how_to_run(options);
  const EscapeJob job = job_of(options);
  if (job.stored && job.stored->result.complete) return report(options, job, job.stored->result, job.stored->status);
  const System& system = job.loaded.system;
  how.part = job.shard.range(system.run.trajectories);
  if (job.stored) how.before = &job.stored->result;
  const std::unique_ptr<EscapeArchive> archive = archive_of(options, job);
  how.journal = archive.get();
  how.ranks = ranks.get();
  EscapeResult result;
  try {
    Progress progress(!options.quiet);
    const double all = static_cast<double>(how.part.last - how.part.first);
    if (progress.enabled())
      how.progress = [&](std::uint64_t trajectories, std::uint64_t hits) {
        if (progress.due())
          progress.show(static_cast<double>(trajectories) / all,
                        with_prefix(static_cast<double>(hits) / progress.seconds()) + "hits/s");
      };
    call.make(&job);  // the others count on what comes next
    result = run_escape(system, how);
    if (archive) archive->finish(result, result.complete ? "completed" : "interrupted");
  } catch (const InputError&) {
    if (archive) say_how_to_go_on(job, archive->kept());
    throw;
  }
  if (!result.complete) say_how_to_go_on(job, result.done.size());
  return report(options, job, result, result.complete ? "completed" : "interrupted");
}

}  // namespace carom::cli
