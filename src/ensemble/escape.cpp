#include "carom/ensemble/escape.hpp"

#include <optional>
#include <utility>

#include "block_order.hpp"
#include "carom/table/hole_names.hpp"
#include "ensemble/ensemble_run.hpp"
#include "ensemble/escape_runner.hpp"
#include "ensemble/lane_runner.hpp"

namespace carom {

namespace {

EscapeResult nothing(const System& system) {
  EscapeResult result;
  result.counts = SurvivalCounts(system.run.times, hole_names(*system.table).size());
  return result;
}

// What the threads of one run share.
class EscapeEnsemble {
 public:
  EscapeEnsemble(const System& system, const EscapeOptions& options, Post post)
      : system_(system),
        options_(options),
        sampler_(system, options.interrupted),
        injector_(system),
        run_(system, options, nothing(system), post),
        order_(options.records, 16 * static_cast<std::uint64_t>(run_.threads())) {
    if (options.lanes && no_lanes_for_escape(system).empty()) run_.lanes = options.lanes;
  }

  EscapeResult run() {
    EscapeResult result = run_.run([this](Thread& thread) { work(thread); });
    if (options_.records) order_.flush();
    return result;
  }

 private:
  using Thread = EnsembleRun<EscapeResult>::Thread;

  void work(Thread& thread) {
    try {
      if (run_.lanes)
        work_in_lanes(thread);
      else
        work_one_by_one(thread);
    } catch (...) {
      order_.close();  // nobody waits for a block that will not come
      throw;
    }
    if (thread.stopped()) order_.close();
  }

  bool wants_records(const Thread& thread) const { return options_.records || thread.wants_records(); }

  static void deliver(Thread& thread, TrajectoryRange block, EscapeTally&& tally,
                      std::vector<TrajectoryRecord>&& records, const DecisionCounts& decisions,
                      const LaneEffort& effort = {}) {
    EscapeResult part;
    part.counts = std::move(tally.counts);
    part.digest = tally.digest;
    part.steps = tally.steps;
    part.energy_error = tally.energies.error;
    part.counts.energy_change = tally.energies.change;
    part.reports = std::move(tally.reports);
    part.decisions = decisions;
    part.effort = effort;
    part.done.add(block);
    thread.deliver(
        block, [&](EscapeResult& sum) { sum.add(part); }, std::move(records));
  }

  void work_one_by_one(Thread& thread) {
    EscapeRunner runner(system_, sampler_, injector_, options_.decisions);
    DecisionCounts before;
    while (!thread.stopped()) {
      TrajectoryRange block;
      std::uint64_t number = 0;
      if (!thread.claim(block, number)) break;
      if (options_.records) order_.await_turn(number);
      EscapeTally tally(system_);
      std::vector<TrajectoryRecord> records;
      if (!run_block(thread, block, runner, tally, wants_records(thread) ? &records : nullptr)) break;
      if (options_.records) order_.deliver(number, records);
      const DecisionCounts now = runner.decisions();
      deliver(thread, block, std::move(tally), std::move(records), now - std::exchange(before, now));
    }
  }

  // The lanes go from block to block without a pause; where records are wanted in order, one block after the
  // other: a thread that waits for its turn must not keep others waiting.
  void work_in_lanes(Thread& thread) {
    LaneRunner runner(system_, sampler_, *run_.lanes, options_.decisions);
    DecisionCounts before;
    LaneEffort effort_before;
    const bool in_order = static_cast<bool>(options_.records);
    std::uint64_t number = 0;
    bool pause = false, more = true;
    const auto next = [&](LaneRunner::Block& block) {
      if (pause || thread.stopped()) return false;
      TrajectoryRange range;
      more = thread.claim(range, number);
      if (!more) return false;
      if (in_order) order_.await_turn(number);
      block = {range.first, range.last};
      pause = in_order;
      return true;
    };
    const auto done = [&](LaneRunner::Done&& ready) {
      if (in_order) order_.deliver(number, ready.records);
      const DecisionCounts now = runner.decisions();
      const LaneEffort effort = runner.effort();
      deliver(thread, {ready.block.first, ready.block.end}, std::move(ready.tally), std::move(ready.records),
              now - std::exchange(before, now), effort - std::exchange(effort_before, effort));
    };
    const auto ended = [&](std::uint64_t hits) { thread.report(1, hits); };
    while (more && !thread.stopped()) {
      pause = false;
      runner.run(next, done, wants_records(thread), ended, [&] { return thread.stopped(); });
      if (!in_order) break;
    }
  }

  bool run_block(Thread& thread, TrajectoryRange block, EscapeRunner& runner, EscapeTally& tally,
                 std::vector<TrajectoryRecord>* records) {
    const std::function<bool()> interrupted = [&] { return thread.stopped(); };
    for (std::uint64_t trajectory = block.first; trajectory < block.last; ++trajectory) {
      const std::uint64_t before = tally.counts.collisions;
      if (thread.stopped() || !runner.run(trajectory, tally, records, interrupted)) return false;
      thread.report(1, tally.counts.collisions - before);
    }
    return true;
  }

  const System& system_;
  const EscapeOptions& options_;
  const Sampler sampler_;
  const Injector injector_;
  EnsembleRun<EscapeResult> run_;
  BlockOrder order_;
};

}  // namespace

bool EscapeResult::add(const EscapeResult& other) {
  if (!add_common(other)) return false;
  counts.merge(other.counts);
  effort += other.effort;
  return true;
}

std::string no_lanes_for_escape(const System& system) { return EitherLanes::hindrance(system); }

EscapeResult run_escape(const System& system, const EscapeOptions& options) {
  return run_in_crew(options, [&](Post post) {
    check_start(system, options.interrupted);
    return EscapeEnsemble(system, options, post).run();
  });
}

}  // namespace carom
