// carom merge: parts of an ensemble become one archive.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "carom/base/error.hpp"
#include "carom/files/ensembles.hpp"
#include "cli/commands/commands.hpp"
#include "cli/commands/run_ensemble.hpp"
#include "cli/commands/sweep.hpp"
#include "cli/common.hpp"
#include "files/checkpoint/sweep_archive.hpp"
#include "files/checkpoint/work_folder.hpp"

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
  for (const EnsemblePart& part : sum.parts) sum.merged.push_back(part.file);
  const LoadedSystem loaded = system_of(sum);
  Provenance origin = provenance_of(options, loaded.system, sum.result.threads);
  if (sum.result.lanes) origin.isa = name_of(*sum.result.lanes);
  complete_sum(loaded.system, sum.result, how_to_complete(options));
  refuse_nothing(options, loaded.system, sum.result);
  write_sum(output, loaded, origin, sum, lock);
  lock.reset();
  say_what_is_missing(sum.result.done, loaded.system);
  return report(options, loaded.system, sum.result,
                context_of(options, sum.status, named_archive(options, output), sum.shard), true);
}

// Parts of a sweep: value after value. The highest exit status of them.
template <class Result>
int merge_values(const Options& options, const std::string& output,
                 const std::vector<std::vector<std::string>>& parts, SweepResult& merged) {
  Options one = options;
  one.command = merged.plan.command;
  merged.status = "completed";
  int worst = done;
  for (std::size_t i = 0; i < merged.plan.systems.size(); ++i) {
    auto value = std::make_shared<ValueOfSweep>();
    value->take = [&](const files::Json& report, const std::string& doubts) {
      merged.rows.emplace_back(i, report, doubts);
    };
    one.of_sweep = value;
    const std::string sum = files::part_of_sweep(output, i);
    if (!parts[i].empty())
      worst = std::max(worst, merge_parts<Result>(one, sum, parts[i], nullptr));
    if (!is_complete(sum)) merged.status = "incomplete";
  }
  return worst;
}

int merge_sweeps(const Options& options, const std::string& output,
                 const std::vector<std::string>& files) {
  SweepResult merged;
  std::vector<std::vector<std::string>> parts;  // of each value
  for (const std::string& file : files) {
    files::StoredSweep stored = files::read_sweep(file);
    files::SweepPlan& plan = stored.plan;
    std::erase_if(plan.options, [](const auto& option) { return option.first == "shard"; });
    if (file != files.front()) refuse_another(merged.plan, plan, file);
    parts.resize(plan.systems.size());
    for (const std::size_t i : stored.computed) parts[i].push_back(files::value_of_sweep(file, i));
    merged.plan = std::move(plan);
  }
  files::give_up_checkpoint(output);
  files::keep_plan(output, merged.plan);
  int worst = done;
  try {
    for_kind(merged.plan.command, [&]<class Result>(std::type_identity<Result>) {
      worst = merge_values<Result>(options, output, parts, merged);
    });
    if (const auto error = why_nothing(merged)) throw *error;
    end_sweep(options, merged, output, {});
  } catch (...) {
    files::remove_sweep(output);
    throw;
  }
  return worst;
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
  ArchiveLock lock = lock_output(options, output);
  refuse_existing(output, options.force);
  if (files::is_sweep_archive(files.front())) return merge_sweeps(options, output, files);
  int status = done;
  for_kind(kind_of_ensemble(files.front()), [&]<class Result>(std::type_identity<Result>) {
    status = merge_parts<Result>(options, output, files, std::move(lock));
  });
  return status;
}

}  // namespace carom::cli
