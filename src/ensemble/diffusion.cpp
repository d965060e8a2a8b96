#include "carom/ensemble/diffusion.hpp"

#include <utility>

#include "carom/base/error.hpp"
#include "carom/ensemble/injection.hpp"
#include "carom/ensemble/sampler.hpp"
#include "carom/ensemble/stopwatch.hpp"
#include "ensemble/parallel_blocks.hpp"
#include "ensemble/soft_walker.hpp"

namespace carom {

namespace {

// Each takes 150 kB a thread.
constexpr std::size_t most_times = 2000;

}  // namespace

DiffusionResult run_diffusion(const System& system, const DiffusionOptions& options) {
  const Stopwatch watch;
  if (system.run.times.size() > most_times)
    throw InputError(Place{"", 0, 0, "run.times"},
                     std::to_string(system.run.times.size()) + " times are too many",
                     "at most " + std::to_string(most_times) + " report times");
  refuse_injections(system, "an ensemble that diffuses");
  const Sampler sampler(system);
  const BlockPlan plan(system.run.trajectories, options.threads, options.block);
  std::atomic<std::uint64_t> done{0}, hits{0};
  std::mutex progress_mutex;
  const auto report = [&](std::uint64_t new_hits) {
    const std::uint64_t all = done.fetch_add(1, std::memory_order_relaxed) + 1;
    const std::uint64_t all_hits = hits.fetch_add(new_hits, std::memory_order_relaxed) + new_hits;
    const std::unique_lock lock(progress_mutex, std::try_to_lock);
    if (lock) options.progress(all, all_hits);
  };
  DiffusionTally total(system);
  const std::function<void(std::uint64_t)> tell =
      options.progress ? std::function<void(std::uint64_t)>(report) : nullptr;
  const bool in_lanes = options.lanes && SoftWalker::suits(system);
  const bool complete =
      in_lanes ? run_blocks(
                     plan, options.interrupted,
                     [&] { return SoftWalker(system, sampler, *options.lanes, options.decisions, tell); },
                     [&](SoftWalker& walker) {
                       walker.close();
                       total.merge(walker.tally());
                     })
               : run_blocks(
                     plan, options.interrupted,
                     [&] { return DiffusionWalker(system, sampler, options.decisions, tell); },
                     [&](DiffusionWalker& walker) {
                       walker.close();
                       total.merge(walker.tally);
                     });
  DiffusionResult result = std::move(total.result);
  result.sums = std::move(total.sums);
  result.complete = complete;
  if (in_lanes) result.lanes = options.lanes;
  result.seconds = watch.seconds();
  result.cpu_seconds = watch.cpu_seconds();
  result.threads = plan.threads;
  for (auto& [index, text] : total.reports) result.reports.push_back(std::move(text));
  return result;
}

}  // namespace carom
