#include "carom/ensemble/escape.hpp"

#include <omp.h>

#include <algorithm>
#include <exception>
#include <mutex>
#include <optional>
#include <utility>

#include "block_order.hpp"
#include "carom/base/error.hpp"
#include "carom/ensemble/stopwatch.hpp"
#include "ensemble/block_list.hpp"
#include "ensemble/crew.hpp"
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
    if (options.ranks && options.ranks->rank() > 0) hand_.emplace(*options.ranks);
    total_.counts = SurvivalCounts(system.run.times, system.table->holes.size());
    if (options.before) total_.add(*options.before);
    trajectories_ = total_.done.size();
    hits_ = total_.counts.collisions;
    const std::uint64_t most = hand_ ? wanted_threads() : std::min(wanted_threads(), blocks_.size());
    threads_ = static_cast<int>(std::max<std::uint64_t>(1, most));
    if (options.lanes && LaneRunner::suits(system)) lanes_ = options.lanes;
  }

  EscapeResult run() {
    if (hand_) return hand_->stopped() ? EscapeResult() : run_as_hand();
    save_first();
    BlockOrder order(options_.records, 16 * static_cast<std::uint64_t>(threads_));
    {
      std::optional<Periodic> saver;
      if (options_.journal) saver.emplace(options_.save_every, [this] { save(); });
      if (options_.ranks && options_.ranks->size() > 1) lead();
      work_in_threads(order);
      try {
        if (foreman_) foreman_->wait();
      } catch (...) {
        fail();  // what went wrong here comes first
      }
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
    const std::uint64_t ranks = options_.ranks ? static_cast<std::uint64_t>(options_.ranks->size()) : 1;
    return std::max<std::uint64_t>(1, std::min(options_.block, left / (wanted_threads() * ranks * 8) + 1));
  }

  void work_in_threads(BlockOrder& order) {
#pragma omp parallel num_threads(threads_)
    work(order);
  }

  // As rank 0 of several.
  void lead() {
    const CrewPlan plan{wants_records(), options_.save_every};
    foreman_.emplace(*options_.ranks, plan, Foreman::Calls{[this](std::uint64_t share) { return give(share); }, blocks_.block(),
                                             [this](EscapePart&& part) { take(std::move(part)); }, [this] { return stopped(); }});
  }
  // Many blocks at first, and few in the end, so that nobody waits for a slow rank. The message is to be short.
  std::vector<TrajectoryRange> give(std::uint64_t share) {
    const std::uint64_t most = blocks_.gaps() > 64 ? 64 : 4096;
    const std::uint64_t left = blocks_.size() - std::min(blocks_.size(), next_block_.load());
    const std::uint64_t count = std::max<std::uint64_t>(1, std::min(most, left / share));
    const std::uint64_t first = std::min(blocks_.size(), next_block_.fetch_add(count));
    return blocks_.ranges(first, std::min(blocks_.size(), first + count));
  }
  void take(EscapePart&& part) {
    if (options_.progress) report_progress(part.sum.done.size(), part.sum.counts.collisions);
    const std::lock_guard lock(mutex_);
    if (!total_.add(part.sum)) throw InternalError("two ranks did the same trajectories");
    for (EscapePart::Block& block : part.blocks)
      if (options_.journal) options_.journal->block(block.range, std::move(block.records));
  }

  // As any other rank.
  EscapeResult run_as_hand() {
    BlockOrder order(options_.records, 1);
    // 16 MB of records are told soon.
    const auto heavy = [this] {
      const std::lock_guard lock(mutex_);
      return waiting_records_ * sizeof(TrajectoryRecord) > (std::size_t{16} << 20);
    };
    hand_->start({[this] { return done_since(); }, heavy}, options_.interrupted);
    work_in_threads(order);
    std::string text;
    try {
      if (error_) std::rethrow_exception(error_);
    } catch (const std::exception& error) {
      text = error.what();
    }
    hand_->end(text);
    return EscapeResult();
  }
  EscapePart done_since() {
    const std::lock_guard lock(mutex_);
    EscapePart part;
    part.sum = std::exchange(total_, EscapeResult());
    total_.counts = SurvivalCounts(system_.run.times, system_.table->holes.size());
    part.blocks = std::exchange(waiting_, {});
    waiting_records_ = 0;
    const double now = watch_.cpu_seconds();
    part.sum.cpu_seconds = now - std::exchange(told_cpu_seconds_, now);
    return part;
  }

  bool stopped() const {
    return (hand_ && hand_->stopped()) || (foreman_ && foreman_->failed()) || failed_.load(std::memory_order_relaxed) ||
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
    result.ranks = options_.ranks ? options_.ranks->size() : 1;
    result.complete = result.done.missing_from(part_).empty();
    return result;
  }
  // Before the first block: a run that cannot be saved is not begun.
  void save_first() {
    if (!options_.journal) return;
    try {
      options_.journal->save(snapshot());
    } catch (...) {
      if (options_.ranks) Foreman::dismiss(*options_.ranks);
      throw;
    }
  }
  void save() noexcept {
    // Counts may be ahead of records that could not be written.
    if (failed_.load() || (foreman_ && foreman_->failed())) return;
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
    if (hand_) return hand_->plan().records;
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
    if (hand_ && hand_->plan().records) {
      waiting_records_ += records.size();
      waiting_.push_back({block, std::move(records)});
    } else if (!hand_ && options_.journal) {
      options_.journal->block(block, std::move(records));
    }
  }

  // The next block and, in this process, its number.
  bool claim(TrajectoryRange& block, std::uint64_t& number) {
    if (hand_) return hand_->next(block);
    number = next_block_.fetch_add(1);
    if (number >= blocks_.size()) return false;
    block = blocks_[number];
    return true;
  }

  void work_one_by_one(BlockOrder& order) {
    EscapeRunner runner(system_, sampler_, injector_, options_.decisions);
    DecisionCounts before;
    while (!stopped()) {
      TrajectoryRange block;
      std::uint64_t number = 0;
      if (!claim(block, number)) break;
      if (options_.records) order.await_turn(number);
      EscapeTally tally(system_);
      std::vector<TrajectoryRecord> records;
      if (!run_block(block, runner, tally, wants_records() ? &records : nullptr)) break;
      if (options_.records) order.deliver(number, records);
      const DecisionCounts now = runner.decisions();
      deliver(block, std::move(tally), std::move(records), now - std::exchange(before, now));
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
      TrajectoryRange range;
      more = claim(range, number);
      if (!more) return false;
      if (in_order) order.await_turn(number);
      block = {range.first, range.last};
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
      if (options_.progress) report_progress(1, hits);
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
      if (options_.progress) report_progress(1, tally.counts.collisions - before);
    }
    return true;
  }

  void report_progress(std::uint64_t trajectories, std::uint64_t hits) {
    const std::uint64_t done = trajectories_.fetch_add(trajectories, std::memory_order_relaxed) + trajectories;
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
  EscapeResult total_;  // of a hand: since it last told
  std::exception_ptr error_;
  std::vector<EscapePart::Block> waiting_;
  std::size_t waiting_records_ = 0;
  double told_cpu_seconds_ = 0.0;
  // Last: their threads use what stands above.
  std::optional<Hand> hand_;
  std::optional<Foreman> foreman_;
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
