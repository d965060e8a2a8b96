#include "carom/ensemble/escape.hpp"

#include <omp.h>

#include <algorithm>
#include <exception>
#include <mutex>
#include <optional>
#include <utility>

#include "block_order.hpp"
#include "carom/ensemble/stopwatch.hpp"
#include "ensemble/block_list.hpp"
#include "ensemble/escape_runner.hpp"
#include "ensemble/lane_runner.hpp"
#include "ensemble/periodic.hpp"

namespace carom {

namespace {

// What the threads of one run share.
class Ensemble {
 public:
  Ensemble(const System& system, const EscapeOptions& options)
      : system_(system),
        options_(options),
        part_{options.part.first, std::min(options.part.last, system.run.trajectories)},
        sampler_(system),
        injector_(system),
        blocks_(gaps(), block_size()) {
    total_.counts = SurvivalCounts(system.run.times, system.table->holes.size());
    if (options.before) total_.add(*options.before);
    trajectories_ = total_.done.size();
    hits_ = total_.counts.collisions;
    threads_ = static_cast<int>(std::max<std::uint64_t>(1, std::min(wanted_threads(), blocks_.size())));
    if (options.lanes && LaneRunner::suits(system)) lanes_ = options.lanes;
  }

  EscapeResult run() {
    if (options_.journal) options_.journal->save(snapshot());
    BlockOrder order(options_.records, 16 * static_cast<std::uint64_t>(threads_));
    {
      std::optional<Periodic> saver;
      if (options_.journal) saver.emplace(options_.save_every, [this] { save(); });
#pragma omp parallel num_threads(threads_)
      work(order);
    }
    if (error_) std::rethrow_exception(error_);
    if (options_.records) order.flush();
    return snapshot();
  }

 private:
  std::vector<TrajectoryRange> gaps() const {
    return (options_.before ? options_.before->done : TrajectoryRanges()).missing_from(part_);
  }
  std::uint64_t wanted_threads() const {
    return static_cast<std::uint64_t>(options_.threads > 0 ? options_.threads : std::max(1, omp_get_max_threads()));
  }
  // Small ensembles get small blocks, so that every thread has work.
  std::uint64_t block_size() const {
    std::uint64_t left = 0;
    for (const TrajectoryRange& gap : gaps()) left += gap.last - gap.first;
    return std::max<std::uint64_t>(1, std::min(options_.block, left / (wanted_threads() * 8) + 1));
  }

  bool stopped() const {
    return failed_.load(std::memory_order_relaxed) ||
           (options_.interrupted && options_.interrupted->load(std::memory_order_relaxed));
  }
  void fail() {
    const std::lock_guard lock(error_mutex_);
    if (!error_) error_ = std::current_exception();
    failed_ = true;
  }

  // The sum of all blocks that are done.
  EscapeResult snapshot() {
    const std::lock_guard lock(mutex_);
    if (options_.journal) options_.journal->mark();
    EscapeResult result = total_;
    result.seconds += watch_.seconds();
    result.cpu_seconds += watch_.cpu_seconds();
    result.threads = threads_;
    result.lanes = lanes_;
    result.complete = result.done.missing_from(part_).empty();
    return result;
  }
  void save() noexcept {
    try {
      options_.journal->save(snapshot());
    } catch (...) {
      fail();
    }
  }

  // One thread's share. No exception may leave it: it runs inside an OpenMP region.
  void work(BlockOrder& order) noexcept {
    try {
      if (lanes_)
        work_in_lanes(order);
      else
        work_one_by_one(order);
    } catch (...) {
      fail();
    }
    if (stopped()) order.close();
  }

  bool wants_records() const {
    return options_.records || (options_.journal && options_.journal->wants_records());
  }

  void deliver(TrajectoryRange block, EscapeTally&& tally, std::vector<TrajectoryRecord>&& records,
               const DecisionCounts& decisions, const LaneEffort& effort = {}) {
    const std::lock_guard lock(mutex_);
    EscapeResult part;
    part.counts = std::move(tally.counts);
    part.digest = tally.digest;
    part.reports = std::move(tally.reports);
    part.decisions = decisions;
    part.effort = effort;
    part.done.add(block);
    total_.add(part);
    if (options_.journal) options_.journal->block(block, std::move(records));
  }

  void work_one_by_one(BlockOrder& order) {
    EscapeRunner runner(system_, sampler_, injector_, options_.decisions);
    DecisionCounts before;
    while (!stopped()) {
      const std::uint64_t number = next_block_.fetch_add(1);
      if (number >= blocks_.size()) break;
      if (options_.records) order.await_turn(number);
      EscapeTally tally(system_);
      std::vector<TrajectoryRecord> records;
      if (!run_block(blocks_[number], runner, tally, wants_records() ? &records : nullptr)) break;
      if (options_.records) order.deliver(number, records);
      const DecisionCounts now = runner.decisions();
      deliver(blocks_[number], std::move(tally), std::move(records), now - std::exchange(before, now));
    }
  }

  // The lanes go from block to block without a pause; where records are wanted in order, one block after the
  // other: a thread that waits for its turn must not keep others waiting.
  void work_in_lanes(BlockOrder& order) {
    LaneRunner runner(system_, sampler_, *lanes_, options_.decisions);
    DecisionCounts before;
    LaneEffort effort_before;
    const bool in_order = static_cast<bool>(options_.records);
    std::uint64_t number = 0;
    bool pause = false, more = true;
    const auto next = [&](LaneRunner::Block& block) {
      if (pause || stopped()) return false;
      number = next_block_.fetch_add(1);
      more = number < blocks_.size();
      if (!more) return false;
      if (in_order) order.await_turn(number);
      block = {blocks_[number].first, blocks_[number].last};
      pause = in_order;
      return true;
    };
    const auto done = [&](LaneRunner::Done&& ready) {
      if (in_order) order.deliver(number, ready.records);
      const DecisionCounts now = runner.decisions();
      const LaneEffort effort = runner.effort();
      deliver({ready.block.first, ready.block.end}, std::move(ready.tally), std::move(ready.records),
              now - std::exchange(before, now), effort - std::exchange(effort_before, effort));
    };
    const auto ended = [&](std::uint64_t hits) {
      if (options_.progress) report_progress(hits);
    };
    while (more && !stopped()) {
      pause = false;
      runner.run(next, done, wants_records(), ended, [this] { return stopped(); });
      if (!in_order) break;
    }
  }

  bool run_block(TrajectoryRange block, EscapeRunner& runner, EscapeTally& tally,
                 std::vector<TrajectoryRecord>* records) {
    const std::function<bool()> interrupted = [this] { return stopped(); };
    for (std::uint64_t trajectory = block.first; trajectory < block.last; ++trajectory) {
      const std::uint64_t before = tally.counts.collisions;
      if (stopped() || !runner.run(trajectory, tally, records, interrupted)) return false;
      if (options_.progress) report_progress(tally.counts.collisions - before);
    }
    return true;
  }

  void report_progress(std::uint64_t hits) {
    const std::uint64_t done = trajectories_.fetch_add(1, std::memory_order_relaxed) + 1;
    const std::uint64_t all_hits = hits_.fetch_add(hits, std::memory_order_relaxed) + hits;
    std::unique_lock lock(progress_mutex_, std::try_to_lock);
    if (lock) options_.progress(done, all_hits);
  }

  const System& system_;
  const EscapeOptions& options_;
  const TrajectoryRange part_;
  const Sampler sampler_;
  const Injector injector_;
  const BlockList blocks_;
  const Stopwatch watch_;
  int threads_ = 1;
  std::optional<InstructionSet> lanes_;
  std::atomic<std::uint64_t> next_block_{0}, trajectories_{0}, hits_{0};
  std::atomic<bool> failed_{false};
  std::mutex mutex_, error_mutex_, progress_mutex_;
  EscapeResult total_;
  std::exception_ptr error_;
};

}  // namespace

bool EscapeResult::add(const EscapeResult& other) {
  if (!done.add(other.done)) return false;
  counts.merge(other.counts);
  digest += other.digest;
  decisions += other.decisions;
  effort += other.effort;
  seconds += other.seconds;
  cpu_seconds += other.cpu_seconds;
  if (other.reports.empty()) return true;
  reports.insert(reports.end(), other.reports.begin(), other.reports.end());
  std::sort(reports.begin(), reports.end());
  if (reports.size() > EscapeTally::most_reports) reports.resize(EscapeTally::most_reports);
  return true;
}

EscapeResult run_escape(const System& system, const EscapeOptions& options) {
  return Ensemble(system, options).run();
}

}  // namespace carom
