// A command that runs an ensemble on several ranks: each flies its share into an archive of its
// own, as --shard does, and the first rank adds them up, as `carom merge` does. A rank that fails
// says why, and ends all.
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/commands/commands.hpp"
#include "cli/commands/run_ensemble.hpp"
#include "cli/signals.hpp"
#include "cli/temporary_folder.hpp"
#include "files/checkpoint/rank_parts.hpp"
#include "files/checkpoint/work_folder.hpp"
#include "files/toml/overrides.hpp"

namespace carom::cli {

namespace {

/// Flies this rank's share into the archive `part`.
template <class Result>
void fly_share(const Options& options, EnsembleJob<Result>& job, Ranks& ranks,
               const std::string& part) {
  const System& system = job.loaded.system;
  EnsembleOptions<Result> how = how_to_run<Result>(options);
  how.interrupted = &catch_interrupts();
  if (job.stored) how.elsewhere = job.stored->result.done;
  how.part =
      shard(static_cast<std::uint64_t>(ranks.rank()) + 1, static_cast<std::uint64_t>(ranks.size()),
            how.elsewhere.missing_from(job.shard.range(system.run.trajectories)));
  typename EnsembleArchive<Result>::Plan plan;
  plan.force = true;
  plan.per_trajectory = job.stored ? job.stored->per_trajectory : options.per_trajectory;
  plan.shard = job.shard;
  plan.warn = warn;
  EnsembleArchive<Result> archive(part, job.loaded,
                                  provenance_of(options, system, threads_of(options)), plan);
  how.journal = &archive;
  // One that cannot begin ends all, and removes the folder of shares: those that come late must not
  // complain of that.
  ranks.meet();
  try {
    Result result = fly(options, system, how);
    const char* const status = status_of(result.complete);
    result.complete = false;  // it is a part of the ensemble
    archive.finish(result, status);
  } catch (...) {
    // Other ranks may have kept more.
    if (!job.output.empty() && !files::parts_of_ranks(job.output).empty())
      warn(fmt::format("the work of the ranks is kept; to continue: carom {} --resume {}",
                       options.command, job.output));
    throw;
  }
}

/// What the first rank makes of all shares; nothing where all ranks are to begin again, with half
/// the step.
template <class Result>
std::optional<int> add_up(const Options& options, EnsembleJob<Result>& job, const Ranks& ranks,
                          const std::string& file, OwnStep& own_step) {
  std::vector<std::string> files;
  if (job.stored) files.push_back(job.output);
  for (int rank = 0; rank < ranks.size(); ++rank) files.push_back(files::part_of_rank(file, rank));
  for (const std::string& part : files)
    if (!files::exists(part))
      throw InputError(Place{part, 0, 0, ""}, "the share of a rank is not there",
                       "-o FILE on a disk that all machines see");
  SumOfParts<Result> sum = files::sum_of_ranks<Result>(job.output, files, job.shard);
  if (sum.result.complete && own_step.halve(job.loaded, sum.result.energy_error)) return {};
  complete_sum(job.loaded.system, sum.result, how_to_complete(options));
  try {
    refuse_nothing(options, job.loaded.system, sum.result);
  } catch (...) {
    if (!job.output.empty()) files::give_up_checkpoint(job.output);
    throw;
  }
  sum.status = status_of(sum.result.complete);
  sum.result.ranks = ranks.size();
  Provenance origin = origin_of(options, job);
  origin.threads = sum.result.threads;
  if (sum.result.lanes) origin.isa = name_of(*sum.result.lanes);
  try {
    if (!job.output.empty()) write_sum(job.output, job.loaded, origin, sum, job.lock);
  } catch (...) {
    say_how_to_go_on(options, job, sum.result.done.size());
    throw;
  }
  job.lock.reset();
  return report_and_say_how_to_go_on(options, job, sum.result, sum.status, own_step);
}

}  // namespace

template <class Result>
int run_shared(const Options& asked, Ranks& ranks) {
  const bool first = ranks.rank() == 0;
  constexpr const char *go = "go", *nothing = "nothing";
  Options options = asked;
  options.quiet = asked.quiet || !first;
  // The first rank reads everything, and claims the archive.
  EnsembleJob<Result> job;
  const std::string word = word_of_first(&ranks, [&] {
    check_engine(options);
    how_to_run<Result>(options);
    const files::Progress preparing(!options.quiet);
    job = job_of<Result>(options, Sharing::first);
    if (!job.stored && !job.output.empty()) files::give_up_checkpoint(job.output);
    return job.stored && job.stored->result.complete ? nothing : go;
  });
  if (first && word == nothing) {
    job.lock.reset();
    return report(options, job, job.stored->result, job.stored->status);
  }
  if (word != go) return word == nothing ? done : bad_input;
  try {
    speak();
    // Without an archive the shares are in a folder of the first rank.
    std::optional<TemporaryFolder> temporary;
    if (first && job.output.empty()) {
      temporary.emplace();
      std::filesystem::create_directory(files::folder_of(temporary->file("sum")));
    }
    const std::string file = ranks.tell(temporary ? temporary->file("sum") : job.output);
    if (!first) job = job_of<Result>(options, Sharing::other);
    OwnStep own_step(options);
    constexpr const char* again = "again";
    for (;;) {
      fly_share(options, job, ranks, files::part_of_rank(file, ranks.rank()));
      ranks.meet();
      std::string status = again;
      if (first)
        if (const auto exit = add_up(options, job, ranks, file, own_step))
          status = std::to_string(*exit);
      if (status = ranks.tell(status); status != again) return std::stoi(status);
      if (!first) files::halve_step(job.loaded);
    }
  } catch (...) {
    ranks.give_up();
    throw;
  }
}

int ensemble(const Options& options) {
  int status = bad_input;
  for_kind(options.command, [&]<class Result>(std::type_identity<Result>) {
    status = run_ensemble<Result>(options);
  });
  return status;
}

#define CAROM_MAKE(Result) template int run_shared<Result>(const Options&, Ranks&);
CAROM_FOR_ENSEMBLES(CAROM_MAKE)
#undef CAROM_MAKE

}  // namespace carom::cli
