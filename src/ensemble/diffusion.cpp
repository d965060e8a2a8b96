#include "carom/ensemble/diffusion.hpp"

#include <algorithm>

#include "carom/base/error.hpp"
#include "carom/ensemble/injection.hpp"
#include "carom/ensemble/sampler.hpp"
#include "ensemble/lane_walker.hpp"
#include "ensemble/soft_walker.hpp"

namespace carom {

namespace {

// Each takes 150 kB a thread.
constexpr std::size_t most_times = 2000;

DiffusionResult nothing(const System& system) {
  DiffusionResult result;
  result.sums = DisplacementSums(system.run.times);
  return result;
}

template <class Walker>
void run_blocks_of(EnsembleRun<DiffusionResult>::Thread& thread, Walker walker) {
  TrajectoryRange block;
  std::uint64_t number = 0;
  while (!thread.stopped() && thread.claim(block, number) && walker.run(block)) {
  }
}

void refuse_impossible(const System& system) {
  if (system.run.times.size() > most_times)
    throw InputError(Place{"", 0, 0, "run.times"},
                     std::to_string(system.run.times.size()) + " times are too many",
                     "at most " + std::to_string(most_times) + " report times");
  if (const auto& window = system.run.window) {
    const TimeWindow asked{window->first, window->second};
    if (std::count_if(system.run.times.begin(), system.run.times.end(), [&](double t) { return asked.holds(t); }) < 2)
      throw InputError(Place{"", 0, 0, "run.window"}, "it holds fewer than two report times > 0",
                       "a window of two report times at least; four give the exponent, too");
  }
  refuse_injections(system, "an ensemble that diffuses");
}

}  // namespace

bool DiffusionResult::add(const DiffusionResult& other) {
  if (!add_common(other)) return false;
  sums.merge(other.sums);
  trajectories += other.trajectories;
  survived += other.survived;
  pinned += other.pinned;
  escaped += other.escaped;
  singular += other.singular;
  unbounded += other.unbounded;
  capped += other.capped;
  unresolved += other.unresolved;
  lost += other.lost;
  collisions += other.collisions;
  energy_change = std::max(energy_change, other.energy_change);
  return true;
}

// Under forces a pack is of one kind of particles after the other, so these may differ.
std::string no_lanes_for_diffusion(const System& system) {
  return EitherLanes::is_free(system) ? EitherLanes::hindrance(system) : SoftLanes::hindrance(*system.table, system.dynamics);
}

DiffusionResult run_diffusion(const System& system, const DiffusionOptions& options) {
  return run_in_crew(options, [&](Post post) {
    refuse_impossible(system);
    check_start(system, options.interrupted);
    const Sampler sampler(system, options.interrupted);
    EnsembleRun<DiffusionResult> run(system, options, nothing(system), post);
    const bool free = EitherLanes::is_free(system);
    if (options.lanes && no_lanes_for_diffusion(system).empty()) run.lanes = options.lanes;
    return run.run([&](auto& thread) {
      const DiffusionTally tally(thread, system);
      std::uint64_t number = 0;
      if (run.lanes && free)
        LaneWalker(system, sampler, *run.lanes, options.decisions, tally).run([&](TrajectoryRange& block) {
          return thread.claim(block, number);
        });
      else if (run.lanes)
        run_blocks_of(thread, SoftWalker(system, sampler, *run.lanes, options.decisions, tally));
      else
        run_blocks_of(thread, DiffusionWalker(system, sampler, options.decisions, tally));
    });
  });
}

}  // namespace carom
