// carom merge: parts of an ensemble become one archive.
#include <fmt/format.h>

#include <utility>

#include "carom/base/error.hpp"
#include "cli/commands/commands.hpp"
#include "cli/commands/run_ensemble.hpp"
#include "cli/common.hpp"

namespace carom::cli {

namespace {

// Trajectories that all parts lack are missing in the sum.
void say_what_is_missing(const TrajectoryRanges& done, const System& system) {
  const auto gaps = done.missing_from({0, system.run.trajectories});
  std::uint64_t missing = 0;
  for (const TrajectoryRange& gap : gaps) missing += gap.last - gap.first;
  if (missing > 0)
    warn(fmt::format("{} of {} trajectories are missing, the first of them {}", grouped(missing),
                     grouped(system.run.trajectories), gaps.front().first));
}

template <class Result>
int merge_parts(const Options& options, const std::string& output,
                const std::vector<std::string>& files, ArchiveLock lock) {
  SumOfParts<Result> sum = sum_of<Result>(files);
  sum.merged.clear();
  for (const EnsemblePart& part : sum.parts) sum.merged.push_back(part.file);
  const LoadedSystem loaded = system_of(sum);
  Provenance origin = provenance_of(options, loaded.system, sum.result.threads);
  if (sum.result.lanes) origin.isa = name_of(*sum.result.lanes);
  write_sum(output, loaded, origin, sum, lock);
  lock.reset();
  say_what_is_missing(sum.result.done, loaded.system);
  return report(options, loaded.system, sum.result,
                context_of(options, sum.status, output, sum.shard), true);
}

}  // namespace

int merge(const Options& options) {
  std::vector<std::string> files = options.files;
  std::string output = options.output;
  if (output.empty() && !files.empty()) {
    output = files.front();
    files.erase(files.begin());
  }
  if (files.empty())
    throw InputError(Place{"command line", 0, 0, "merge"}, "there is nothing to merge",
                     "OUT.h5 PART.h5 PART.h5 …");
  ArchiveLock lock = lock_output(output);
  refuse_existing(output, options.force);
  const std::string kind = kind_of_ensemble(files.front());
  if (kind == kind_of(DiffusionResult()))
    return merge_parts<DiffusionResult>(options, output, files, std::move(lock));
  if (kind == kind_of(LyapunovResult()))
    return merge_parts<LyapunovResult>(options, output, files, std::move(lock));
  return merge_parts<EscapeResult>(options, output, files, std::move(lock));
}

}  // namespace carom::cli
