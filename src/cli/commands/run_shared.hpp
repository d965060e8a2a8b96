// A command that runs an ensemble on several ranks: each flies its share into an archive of its
// own, as --shard does, and the first rank adds them up.
//
// (1) Every rank ends, whatever fails, and none with status 0 where one has failed.
// (2) What went wrong is said once, by the first rank.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <exception>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "carom/starts/sampler.hpp"
#include "cli/commands/run_ensemble.hpp"
#include "cli/temporary_folder.hpp"
#include "files/checkpoint/rank_parts.hpp"
#include "files/checkpoint/work_folder.hpp"

namespace carom::cli {

/// The end of one rank's share.
struct ShareEnd {
  std::uint64_t kept = 0;             ///< trajectories on the disk
  bool stopped = false;               ///< by a signal, before a start was found
  std::string error;                  ///< "": none
  std::vector<std::string> warnings;  ///< that have not been said yet
  std::exception_ptr exception;       ///< of this process
};
/// Calls `work`, and keeps what it throws.
ShareEnd share_end_of(const std::function<void(ShareEnd&)>& work);
/// The first rank gets all ends, the others none. Says what the others warn of.
std::vector<ShareEnd> gather_ends(Ranks&, const ShareEnd& mine);
/// Throws what ended one of them, if anything did.
void throw_first_error(const std::vector<ShareEnd>&);
/// The archive `part` of each rank becomes its part of FILE where the first rank has it.
void send_parts(Ranks&, const std::string& part, const std::string& first_file);

// Flies this rank's share into the archive `part`.
template <class Result>
void fly_share(const Options& options, EnsembleJob<Result>& job, const Ranks& ranks,
               const std::string& part, const std::atomic<bool>& stopped, ShareEnd& end) {
  const System& system = job.loaded.system;
  EnsembleOptions<Result> how = how_to_run<Result>(options);
  how.interrupted = &stopped;
  if (job.stored) how.elsewhere = job.stored->result.done;
  how.part =
      shard(static_cast<std::uint64_t>(ranks.rank()) + 1, static_cast<std::uint64_t>(ranks.size()),
            how.elsewhere.missing_from(job.shard.range(system.run.trajectories)));
  typename EnsembleArchive<Result>::Plan plan;
  plan.force = true;
  plan.per_trajectory = job.stored ? job.stored->per_trajectory : options.per_trajectory;
  plan.shard = job.shard;
  plan.warn = warn;
  if (ranks.rank() > 0)
    plan.warn = [&end](const std::string& text) { end.warnings.push_back(text); };
  EnsembleArchive<Result> archive(part, job.loaded,
                                  provenance_of(options, system, threads_of(options)), plan);
  how.journal = &archive;
  try {
    Result result = fly(options, system, how);
    const char* const status = status_of(result.complete);
    result.complete = false;  // it is a part of the ensemble
    archive.finish(result, status);
    end.kept = result.done.size();
  } catch (...) {
    end.kept = archive.kept();
    throw;
  }
}

// The first rank adds up what there is.
template <class Result>
int add_up(const Options& options, EnsembleJob<Result>& job, const Ranks& ranks,
           const std::string& file, const std::vector<ShareEnd>& ends) {
  std::uint64_t kept = job.stored ? job.stored->result.done.size() : 0;
  for (const ShareEnd& end : ends) kept += end.kept;
  std::optional<SumOfParts<Result>> sum;
  try {
    throw_first_error(ends);
    std::vector<std::string> files;
    if (job.stored) files.push_back(job.output);
    for (int rank = 0; rank < ranks.size(); ++rank)
      files.push_back(files::part_of_rank(file, rank));
    sum = files::sum_of_ranks<Result>(job.output, files, job.shard);
    complete_sum(options, job.loaded.system, sum->result);
    try {
      refuse_nothing(options, job.loaded.system, sum->result);
    } catch (...) {
      kept = 0;  // there is nothing to go on with
      if (!job.output.empty()) files::give_up_checkpoint(job.output);
      throw;
    }
    sum->status = status_of(sum->result.complete);
    sum->result.ranks = ranks.size();
    Provenance origin = origin_of(options, job);
    origin.threads = sum->result.threads;
    if (sum->result.lanes) origin.isa = name_of(*sum->result.lanes);
    if (!job.output.empty()) write_sum(job.output, job.loaded, origin, *sum, job.lock);
  } catch (...) {
    say_how_to_go_on(options, job, kept);
    throw;
  }
  job.lock.reset();
  return report_and_say_how_to_go_on(options, job, sum->result, sum->status);
}

template <class Result>
int run_shared(const Options& options, Ranks& ranks) {
  const bool first = ranks.rank() == 0;
  constexpr const char *go = "go", *nothing = "nothing";
  // The first rank reads everything, and claims the archive.
  EnsembleJob<Result> job;
  const ShareEnd ready = share_end_of([&](ShareEnd&) {
    if (!first) return;
    check_engine(options);
    how_to_run<Result>(options);
    const files::Progress preparing(!options.quiet);
    job = job_of<Result>(options, Sharing::first);
    if (!job.stored && !job.output.empty()) files::give_up_checkpoint(job.output);
  });
  const bool complete = job.stored && job.stored->result.complete;
  const std::string word = ranks.tell(ready.exception ? "failed" : complete ? nothing : go);
  if (ready.exception) std::rethrow_exception(ready.exception);
  if (first && complete) {
    job.lock.reset();
    return report(options, job, job.stored->result, job.stored->status);
  }
  if (word != go) return word == nothing ? done : bad_input;

  const std::atomic<bool>& interrupted = catch_interrupts();
  std::optional<TemporaryFolder> temporary;
  std::string file;
  ShareEnd mine;
  {
    Meeting meeting(ranks, interrupted);
    mine = share_end_of([&](ShareEnd& end) {
      meeting.begin();
      if (!first) job = job_of<Result>(options, Sharing::other);
      if (job.output.empty()) temporary.emplace();
      file = temporary ? temporary->file("sum") : job.output;
      if (temporary) std::filesystem::create_directory(files::folder_of(file));
      fly_share(options, job, ranks, files::part_of_rank(file, ranks.rank()), meeting.stopped(),
                end);
    });
    meeting.end(mine.exception != nullptr);
  }
  const std::vector<ShareEnd> ends = gather_ends(ranks, mine);
  const bool failed =
      share_end_of([&](ShareEnd&) { throw_first_error(ends); }).exception != nullptr;
  if (ranks.tell(failed ? "failed" : go) == go && temporary)
    send_parts(ranks, files::part_of_rank(file, ranks.rank()), file);

  int status = bad_input;
  const ShareEnd last = share_end_of([&](ShareEnd&) {
    if (first) status = add_up(options, job, ranks, file, ends);
  });
  if (last.stopped) status = stopped;
  status = std::stoi(ranks.tell(fmt::format("{}", status)));
  if (last.exception) std::rethrow_exception(last.exception);
  return status;
}

template <class Result>
int run_ensemble(const Options& options) {
  if (Ranks* const ranks = start_ranks()) return run_shared<Result>(options, *ranks);
  return run_alone<Result>(options);
}

}  // namespace carom::cli
