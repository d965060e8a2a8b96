// An ensemble on threads: blocks, sums, checkpoints, interruptions. What is flown, and what it adds
// up, is its user's.
#pragma once

#include <omp.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <limits>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "carom/base/error.hpp"
#include "carom/base/stopwatch.hpp"
#include "carom/engines/engine.hpp"
#include "carom/engines/trajectories.hpp"
#include "carom/results/ensemble_result.hpp"
#include "carom/results/trajectory_ranges.hpp"
#include "carom/starts/injection.hpp"
#include "carom/starts/sampler.hpp"
#include "carom/system/system.hpp"
#include "engines/particle_hash.hpp"

namespace carom::engines {

/// Numbers blocks of at most `block` trajectories through several ranges, in order.
class BlockList {
 public:
  BlockList(std::vector<TrajectoryRange> ranges, std::uint64_t block)
      : ranges_(std::move(ranges)), block_(block) {
    for (const TrajectoryRange& range : ranges_) {
      first_.push_back(size_);
      const std::uint64_t trajectories = range.last - range.first;
      size_ += trajectories / block_ + (trajectories % block_ != 0);
    }
  }

  std::uint64_t size() const { return size_; }
  TrajectoryRange operator[](std::uint64_t number) const {
    const auto after = std::upper_bound(first_.begin(), first_.end(), number);
    const auto at = static_cast<std::size_t>(after - first_.begin()) - 1;
    const std::uint64_t from = ranges_[at].first + (number - first_[at]) * block_;
    return {from, std::min(ranges_[at].last, from + block_)};
  }
  std::uint64_t block() const { return block_; }

 private:
  std::vector<TrajectoryRange> ranges_;
  std::vector<std::uint64_t> first_;  // number of each range's first block
  std::uint64_t block_, size_ = 0;
};

/// Calls `action`, which must not throw, again and again, this many seconds apart, until it is
/// stopped.
class Periodic {
 public:
  Periodic(double seconds, std::function<void()> action)
      : pause_(seconds), action_(std::move(action)), thread_([this] { work(); }) {}
  Periodic(const Periodic&) = delete;
  ~Periodic() { stop(); }

  /// Waits for a call that is under way.
  void stop() {
    {
      const std::lock_guard lock(mutex_);
      stopped_ = true;
    }
    wake_.notify_all();
    if (thread_.joinable()) thread_.join();
  }

 private:
  void work() {
    std::unique_lock lock(mutex_);
    while (!wake_.wait_for(lock, pause_, [this] { return stopped_; })) {
      lock.unlock();
      action_();
      lock.lock();
    }
  }

  std::chrono::duration<double> pause_;
  std::function<void()> action_;
  std::mutex mutex_;
  std::condition_variable wake_;
  bool stopped_ = false;
  std::thread thread_;  // last: it uses the others
};

template <class Result>
class EnsembleRun {
 public:
  using Options = EnsembleOptions<Result>;

  /// A thread's part of it.
  class Thread {
   public:
    explicit Thread(EnsembleRun& run) : run_(run), sum_(run.nothing_) {}
    /// The next block; false: there is none.
    bool claim(TrajectoryRange& block) { return run_.claim(block); }
    bool stopped() const { return run_.stopped(); }
    bool wants_records() const { return run_.wants_records(); }
    /// Trajectories that are done: `part` adds them to the sum, including `done`.
    void deliver(TrajectoryRange range, auto part, std::vector<TrajectoryRecord>&& records = {}) {
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
  EnsembleRun(const System& system, const Options& options, Result nothing)
      : options_(options),
        part_{options.part.first, std::min(options.part.last, system.run.trajectories)},
        blocks_(gaps(), block_size()),
        nothing_(std::move(nothing)),
        total_(nothing_),
        save_after_(trajectories_between_saves()) {
    // Particles are numbered through.
    constexpr std::uint64_t most_particles = std::uint64_t{1} << 62;
    const std::uint64_t each = std::max<std::uint64_t>(1, system.particles.size());
    if (system.run.trajectories > most_particles / each)
      throw InputError(Place{"", 0, 0, "run.trajectories"},
                       "more than 2^62 particles cannot be numbered", "fewer trajectories");
    if (options.before && !total_.add(*options.before))
      throw InternalError("what was done overlaps itself");
    trajectories_ = total_.done.size();
    threads_ =
        static_cast<int>(std::max<std::uint64_t>(1, std::min(wanted_threads(), blocks_.size())));
    for (int i = 0; i < threads_; ++i) sums_.emplace_back(*this);
  }

  std::optional<InstructionSet> lanes;  ///< that the report names

  /// Every thread works until there are no blocks left.
  Result run(const Work& work) {
    if (options_.journal)
      options_.journal->save(snapshot());  // a run that cannot be saved is not begun
    {
      std::optional<Periodic> saver;
      if (options_.journal && !saves_by_count())
        saver.emplace(options_.save_every, [this] { save(); });
      work_in_threads(work);
    }
    if (error_) std::rethrow_exception(error_);
    return snapshot();
  }

 private:
  // The trajectories of the part that are neither in `done` nor done elsewhere.
  std::vector<TrajectoryRange> missing_beside(TrajectoryRanges done) const {
    if (!done.add(options_.elsewhere)) throw InternalError("what was done was done elsewhere, too");
    return done.missing_from(part_);
  }
  std::vector<TrajectoryRange> gaps() const {
    return missing_beside(options_.before ? options_.before->done : TrajectoryRanges());
  }
  std::uint64_t wanted_threads() const {
    return static_cast<std::uint64_t>(options_.threads > 0 ? options_.threads
                                                           : std::max(1, omp_get_max_threads()));
  }
  // Small ensembles get small blocks, so that every thread has work.
  std::uint64_t block_size() const {
    std::uint64_t left = 0;
    for (const TrajectoryRange& gap : gaps()) left += gap.last - gap.first;
    return std::max<std::uint64_t>(1, std::min(options_.block, left / (wanted_threads() * 8) + 1));
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

  bool stopped() const {
    return failed_.load(std::memory_order_relaxed) ||
           (options_.interrupted && options_.interrupted->load(std::memory_order_relaxed));
  }
  void fail() {
    const std::lock_guard lock(error_mutex_);
    if (!error_) error_ = std::current_exception();
    failed_ = true;
  }

  // The sum of all that is done. What the threads have done since the last time is added to the
  // total under all their locks; the journal's mark belongs to that moment.
  Result snapshot() {
    std::vector<Result> parts(sums_.size(), nothing_);
    const std::lock_guard lock(total_mutex_);
    {
      std::vector<std::unique_lock<std::mutex>> locks;
      for (Thread& thread : sums_) locks.emplace_back(thread.mutex_);
      const std::lock_guard turn(records_mutex_);
      if (options_.journal) options_.journal->mark();
      for (std::size_t i = 0; i < parts.size(); ++i) std::swap(parts[i], sums_[i].sum_);
    }
    for (const Result& part : parts)
      if (!total_.add(part)) throw InternalError("two threads did the same trajectories");
    Result result = total_;
    result.seconds += watch_.seconds();
    result.cpu_seconds += watch_.cpu_seconds();
    result.threads = threads_;
    result.lanes = lanes;
    result.complete = missing_beside(result.done).empty();
    return result;
  }
  // Checkpoints so many trajectories apart: the thread that delivers the last of these writes one.
  std::uint64_t trajectories_between_saves() const {
    const std::uint64_t most = std::numeric_limits<std::uint64_t>::max() / blocks_.block();
    return options_.journal ? blocks_.block() * std::min(options_.save_every_blocks, most) : 0;
  }
  bool saves_by_count() const { return save_after_ > 0; }
  void came_in(std::uint64_t trajectories) {
    if (!saves_by_count()) return;
    if (unsaved_.fetch_add(trajectories) + trajectories < save_after_) return;
    const std::unique_lock turn(saving_mutex_, std::try_to_lock);
    if (!turn) return;
    unsaved_ = 0;
    save();
  }
  void save() noexcept {
    // Counts may be ahead of records that could not be written.
    if (failed_.load()) return;
    try {
      options_.journal->save(snapshot());
    } catch (...) {
      fail();
    }
  }

  bool wants_records() const { return options_.journal && options_.journal->wants_records(); }
  void keep(TrajectoryRange range, std::vector<TrajectoryRecord>&& records) {
    if (!wants_records()) return;
    const std::lock_guard turn(records_mutex_);
    options_.journal->block(range, std::move(records));
  }

  bool claim(TrajectoryRange& block) {
    const std::uint64_t number = next_block_.fetch_add(1);
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
  const std::uint64_t save_after_;  ///< trajectories; 0: checkpoints are some time apart
};

/// What every ensemble adds up, whatever else its analysis does. One thread's.
template <class Result>
class EnsembleListener : public Listener {
 public:
  using Thread = typename EnsembleRun<Result>::Thread;
  /// The trajectories that come next.
  virtual void claimed(TrajectoryRange) {}

 protected:
  EnsembleListener(const System& system, const Engine& engine, Thread& thread)
      : system_(system), engine_(engine), thread_(thread), hash_(system) {}

  /// The number of a particle, as records, reports and the digest have it.
  std::uint64_t index_of(const Trajectory& t, std::size_t particle) const {
    return particle_index(system_, t.number, particle);
  }
  /// A particle's end: `hash` goes into the digest.
  static void add_end(EnsembleResult& sum, std::uint64_t index, Fate fate,
                      const std::string& report, std::uint64_t hash) {
    sum.digest += hash;
    if (is_failure(fate)) keep_first(sum.reports, index, report);
  }
  /// A trajectory's.
  static void add_end(EnsembleResult& sum, std::uint64_t& contacts, const TrajectoryEnd& end,
                      const EnergyError& error) {
    add_steps(sum, contacts, end);
    sum.energy_error += error;
  }
  static void add_steps(EnsembleResult& sum, std::uint64_t& contacts, const TrajectoryEnd& end) {
    contacts += end.contacts;
    sum.steps += end.steps;
  }
  /// Trajectories that are counted, with the decisions since the last ones.
  void add_done(EnsembleResult& sum, TrajectoryRange range) {
    const DecisionCounts decisions = engine_.decisions();
    sum.decisions += decisions - std::exchange(decisions_, decisions);
    sum.done.add(range);
  }

  const System& system_;
  const Engine& engine_;
  Thread& thread_;
  const ParticleHash hash_;

 private:
  DecisionCounts decisions_;  ///< that were added
};

/// Flies an ensemble whose trajectories are drawn block by block: on each thread an engine, and the
/// listener that `listen(engine, thread)` makes. `starts`: the system that they are drawn from.
///
/// The engine asks `drawn` for one trajectory after the other. When a block is used up, the next is
/// claimed, and the listener hears of it (claimed). It hears where a trajectory begins and ends, in
/// lanes too (InLanes in engine.cpp), and after the last of a block it delivers the block's sums to
/// its thread. At the end the threads' sums are added.
template <class Result, class Listen>
Result fly_blocks(const System& system, const System& starts,
                  const EnsembleOptions<Result>& options, Result nothing, EngineOptions how,
                  Listen listen) {
  check_start(starts, options.interrupted);
  const Sampler sampler(starts, options.interrupted);
  const World world = make_world(system, options.decisions);  // threads share its table
  how.lanes = options.lanes;
  how.like = &world;
  EnsembleRun<Result> run(system, options, std::move(nothing));
  if (why_one_by_one(system, how).empty()) run.lanes = options.lanes;
  return run.run([&](typename EnsembleRun<Result>::Thread& thread) {
    const auto engine = make_engine(system, how);
    auto listener = listen(*engine, thread);
    const std::function<bool()> stopped = [&] { return thread.stopped(); };
    DrawnStarts drawn(sampler, [&](TrajectoryRange& block) {
      if (stopped() || !thread.claim(block)) return false;
      listener.claimed(block);
      return true;
    });
    engine->run(drawn, listener, stopped);
  });
}

}  // namespace carom::engines
