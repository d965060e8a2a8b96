// An ensemble on threads and processes: blocks, sums, checkpoints, interruptions. What is flown, and what it
// adds up, is its user's.
#pragma once

#include <omp.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <limits>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "carom/base/error.hpp"
#include "carom/ensemble/parts.hpp"
#include "carom/ensemble/sampler.hpp"
#include "carom/ensemble/stopwatch.hpp"
#include "carom/ensemble/system.hpp"
#include "ensemble/block_list.hpp"
#include "ensemble/crew.hpp"
#include "ensemble/periodic.hpp"
#include "ensemble/result_bytes.hpp"

namespace carom {

/// What this process is in its crew: one of both, or neither.
struct Post {
  Hand* hand = nullptr;
  Muster* muster = nullptr;
};

template <class Result>
class EnsembleRun {
 public:
  using Options = EnsembleOptions<Result>;

  /// A thread's part of it.
  class Thread {
   public:
    explicit Thread(EnsembleRun& run) : run_(run), sum_(run.nothing_) {}
    /// The next block and, in this process, its number; false: there is none.
    bool claim(TrajectoryRange& block, std::uint64_t& number) { return run_.claim(block, number); }
    bool stopped() const { return run_.stopped(); }
    bool wants_records() const { return run_.wants_records(); }
    /// Trajectories that are done: `part` adds them to the sum, including `done`.
    template <class Part>
    void deliver(TrajectoryRange range, Part part, std::vector<TrajectoryRecord>&& records = {}) {
      {
        const std::lock_guard lock(mutex_);
        part(sum_);
        run_.keep(range, std::move(records));
      }
      run_.came_in(range.last - range.first);
    }
    void report(std::uint64_t trajectories, std::uint64_t hits) {
      if (run_.options_.progress) run_.report_progress(trajectories, hits);
    }

   private:
    friend class EnsembleRun;
    EnsembleRun& run_;
    std::mutex mutex_;
    Result sum_;  // since it was last collected
  };
  using Work = std::function<void(Thread&)>;

  /// `nothing`: the sum of no trajectories.
  EnsembleRun(const System& system, const Options& options, Result nothing, Post post)
      : options_(options),
        part_{options.part.first, std::min(options.part.last, system.run.trajectories)},
        blocks_(gaps(), block_size()),
        nothing_(std::move(nothing)),
        total_(nothing_),
        post_(post),
        save_after_(trajectories_between_saves()) {
    // Particles are numbered through.
    constexpr std::uint64_t most_particles = std::uint64_t{1} << 62;
    const std::uint64_t each = std::max<std::uint64_t>(1, system.particles.size());
    if (system.run.trajectories > most_particles / each)
      throw InputError(Place{"", 0, 0, "run.trajectories"}, "more than 2^62 particles cannot be numbered",
                       "fewer trajectories");
    if (options.before && !total_.add(*options.before)) throw InternalError("what was done overlaps itself");
    trajectories_ = total_.done.size();
    const std::uint64_t most = post_.hand ? wanted_threads() : std::min(wanted_threads(), blocks_.size());
    threads_ = static_cast<int>(std::max<std::uint64_t>(1, most));
    for (int i = 0; i < threads_; ++i) sums_.emplace_back(*this);
  }

  int threads() const { return threads_; }
  std::optional<InstructionSet> lanes;  ///< to be told of by the user

  /// Every thread works until there are no blocks left.
  Result run(const Work& work) {
    if (post_.hand) return run_as_hand(work);
    if (options_.journal) options_.journal->save(snapshot());  // a run that cannot be saved is not begun
    {
      std::optional<Periodic> saver;
      if (!saves_by_count()) saver.emplace(options_.save_every, [this] { save(); });
      if (options_.ranks && options_.ranks->size() > 1) lead();
      work_in_threads(work);
      try {
        if (foreman_) foreman_->wait();
      } catch (...) {
        fail();  // what went wrong here comes first
      }
    }
    if (error_) std::rethrow_exception(error_);
    return snapshot();
  }

 private:
  std::vector<TrajectoryRange> gaps() const {
    return (options_.before ? options_.before->done : TrajectoryRanges()).missing_from(part_);
  }
  std::uint64_t wanted_threads() const {
    return static_cast<std::uint64_t>(options_.threads > 0 ? options_.threads
                                                           : std::max(1, omp_get_max_threads()));
  }
  // Small ensembles get small blocks, so that every thread has work.
  std::uint64_t block_size() const {
    std::uint64_t left = 0;
    for (const TrajectoryRange& gap : gaps()) left += gap.last - gap.first;
    const std::uint64_t ranks = options_.ranks ? static_cast<std::uint64_t>(options_.ranks->size()) : 1;
    return std::max<std::uint64_t>(1, std::min(options_.block, left / (wanted_threads() * ranks * 8) + 1));
  }

  // No exception may leave an OpenMP region.
  void work_in_threads(const Work& work) {
    std::atomic<std::size_t> next{0};
    const auto one = [&]() noexcept {
      try {
        work(sums_[next.fetch_add(1)]);
      } catch (const SamplingStopped&) {  // what it delivered counts
      } catch (...) {
        fail();
      }
    };
#pragma omp parallel num_threads(threads_)
    one();
  }

  // As rank 0 of several.
  void lead() {
    const CrewPlan plan{wants_records(), options_.save_every, save_after_};
    foreman_.emplace(*options_.ranks, plan,
                     Foreman::Calls{[this](std::uint64_t share) { return give(share); }, blocks_.block(),
                                    [this](BytesIn& in) { take(in); }, [this] { return stopped(); },
                                    [this] { return failed_.load(); }});
    post_.muster->over();
  }
  // Many blocks at first, and few in the end, so that nobody waits for a slow rank. The message is to be
  // short.
  std::vector<TrajectoryRange> give(std::uint64_t share) {
    const std::uint64_t most = blocks_.gaps() > 64 ? 64 : 4096;
    const std::uint64_t left = blocks_.size() - std::min(blocks_.size(), next_block_.load());
    const std::uint64_t count = std::max<std::uint64_t>(1, std::min(most, left / share));
    const std::uint64_t first = std::min(blocks_.size(), next_block_.fetch_add(count));
    return blocks_.ranges(first, std::min(blocks_.size(), first + count));
  }
  void take(BytesIn& in) {
    Result sum = nothing_;
    std::vector<RecordBlock> records;
    read_bytes(in, sum);
    read_bytes(in, records);
    if (options_.progress) report_progress(sum.done.size(), collisions_of(sum));
    {
      const std::lock_guard lock(total_mutex_);
      if (!total_.add(sum)) throw InternalError("two ranks did the same trajectories");
      const std::lock_guard turn(records_mutex_);
      for (RecordBlock& block : records)
        if (options_.journal) options_.journal->block(block.range, std::move(block.records));
    }
    came_in(sum.done.size());
  }

  // As any other rank.
  Result run_as_hand(const Work& work) {
    // 16 MB of records are told soon.
    const auto heavy = [this] {
      if (saves_by_count() && unsaved_.load() >= save_after_) return true;
      const std::lock_guard lock(records_mutex_);
      return waiting_records_ * sizeof(TrajectoryRecord) > (std::size_t{16} << 20);
    };
    post_.hand->start({[this](BytesOut& out) { write_done_since(out); }, heavy}, options_.interrupted);
    work_in_threads(work);
    std::string text;
    try {
      if (error_) std::rethrow_exception(error_);
    } catch (const std::exception& error) {
      text = text_of(error);
    } catch (...) {
      text = "a process of this run ended early";
    }
    post_.hand->end(text);
    if (error_) std::rethrow_exception(error_);
    return Result();
  }
  void write_done_since(BytesOut& out) {
    std::vector<RecordBlock> records;
    collect([&] {
      unsaved_ = 0;
      records = std::exchange(waiting_, {});
      waiting_records_ = 0;
    });
    Result sum = std::exchange(total_, nothing_);
    const double now = watch_.cpu_seconds();
    sum.cpu_seconds = now - std::exchange(told_cpu_seconds_, now);
    write_bytes(out, sum);
    write_bytes(out, records);
  }

  bool stopped() const {
    return (post_.hand && post_.hand->stopped()) || (foreman_ && foreman_->ended()) ||
           failed_.load(std::memory_order_relaxed) ||
           (options_.interrupted && options_.interrupted->load(std::memory_order_relaxed));
  }
  void fail() {
    const std::lock_guard lock(error_mutex_);
    if (!error_) error_ = std::current_exception();
    failed_ = true;
  }

  // What the threads have done since the last time is added to the total; `mark` belongs to that moment. One
  // call at a time; meanwhile only other processes add to the total.
  template <class Mark>
  void collect(Mark mark) {
    std::vector<Result> parts(sums_.size(), nothing_);
    const std::lock_guard lock(total_mutex_);
    {
      std::vector<std::unique_lock<std::mutex>> locks;
      for (Thread& thread : sums_) locks.emplace_back(thread.mutex_);
      const std::lock_guard turn(records_mutex_);
      mark();
      for (std::size_t i = 0; i < parts.size(); ++i) std::swap(parts[i], sums_[i].sum_);
    }
    for (const Result& part : parts)
      if (!total_.add(part)) throw InternalError("two threads did the same trajectories");
  }

  // The sum of all that is done.
  Result snapshot() {
    collect([this] {
      if (options_.journal) options_.journal->mark();
    });
    const std::lock_guard lock(total_mutex_);
    Result result = total_;
    result.seconds += watch_.seconds();
    result.cpu_seconds += watch_.cpu_seconds();
    result.threads = threads_;
    result.lanes = lanes;
    result.ranks = options_.ranks ? options_.ranks->size() : 1;
    result.complete = result.done.missing_from(part_).empty();
    return result;
  }
  // Checkpoints that are so many trajectories apart are written by whoever brings the last of them.
  std::uint64_t trajectories_between_saves() const {
    if (post_.hand) return post_.hand->plan().trajectories;
    const std::uint64_t most = std::numeric_limits<std::uint64_t>::max() / blocks_.block();
    return options_.journal ? blocks_.block() * std::min(options_.save_every_blocks, most) : 0;
  }
  bool saves_by_count() const { return save_after_ > 0; }
  void came_in(std::uint64_t trajectories) {
    if (!saves_by_count()) return;
    if (unsaved_.fetch_add(trajectories) + trajectories < save_after_ || post_.hand) return;
    const std::unique_lock turn(saving_mutex_, std::try_to_lock);
    if (!turn) return;
    unsaved_ = 0;
    save();
  }
  void save() noexcept {
    // Counts may be ahead of records that could not be written.
    if (failed_.load() || (foreman_ && foreman_->ended())) return;
    try {
      if (options_.journal)
        options_.journal->save(snapshot());
      else
        collect([] {});
    } catch (...) {
      fail();
    }
  }

  bool wants_records() const {
    if (post_.hand) return post_.hand->plan().records;
    return options_.journal && options_.journal->wants_records();
  }
  void keep(TrajectoryRange range, std::vector<TrajectoryRecord>&& records) {
    if (!wants_records()) return;
    const std::lock_guard turn(records_mutex_);
    if (!post_.hand) return options_.journal->block(range, std::move(records));
    waiting_records_ += records.size();
    waiting_.push_back({range, std::move(records)});
  }

  bool claim(TrajectoryRange& block, std::uint64_t& number) {
    if (post_.hand) return post_.hand->next(block);
    number = next_block_.fetch_add(1);
    if (number >= blocks_.size()) return false;
    block = blocks_[number];
    return true;
  }

  void report_progress(std::uint64_t trajectories, std::uint64_t hits) {
    const std::uint64_t done =
        trajectories_.fetch_add(trajectories, std::memory_order_relaxed) + trajectories;
    const std::uint64_t all_hits = hits_.fetch_add(hits, std::memory_order_relaxed) + hits;
    std::unique_lock lock(progress_mutex_, std::try_to_lock);
    if (lock) options_.progress(done, all_hits);
  }

  const Options& options_;
  const TrajectoryRange part_;
  const BlockList blocks_;
  const Stopwatch watch_;
  const Result nothing_;
  int threads_ = 1;
  std::atomic<std::uint64_t> next_block_{0}, trajectories_{0}, hits_{0}, unsaved_{0};
  std::atomic<bool> failed_{false};
  // Taken in this order: the total, the threads' own, records.
  std::mutex total_mutex_, records_mutex_, error_mutex_, progress_mutex_, saving_mutex_;
  Result total_;
  std::deque<Thread> sums_;
  std::exception_ptr error_;
  std::vector<RecordBlock> waiting_;
  std::size_t waiting_records_ = 0;
  double told_cpu_seconds_ = 0.0;
  Post post_;
  const std::uint64_t save_after_;  ///< trajectories; 0: checkpoints are some time apart
  std::optional<Foreman> foreman_;  // last: its thread uses what stands above
};

/// Sees to it that all processes end. `body(post)` makes an EnsembleRun and returns its result.
template <class Result, class Body>
Result run_in_crew(const EnsembleOptions<Result>& options, Body body) {
  if (!options.ranks || options.ranks->rank() == 0) {
    Muster muster(options.ranks);
    return body(Post{nullptr, &muster});
  }
  Hand hand(*options.ranks);
  try {
    return body(Post{&hand, nullptr});
  } catch (const std::exception& error) {
    hand.end(text_of(error));
    throw;
  }
}

}  // namespace carom
