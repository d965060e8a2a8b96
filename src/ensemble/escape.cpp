#include "carom/ensemble/escape.hpp"

#include <omp.h>

#include <algorithm>
#include <exception>
#include <mutex>
#include <optional>
#include <utility>

#include "block_order.hpp"
#include "carom/base/error.hpp"
#include "carom/ensemble/injection.hpp"
#include "carom/ensemble/sampler.hpp"
#include "carom/ensemble/stopwatch.hpp"
#include "carom/events/world.hpp"
#include "ensemble/escape_tally.hpp"
#include "ensemble/lane_runner.hpp"

namespace carom {

namespace {

using Tally = EscapeTally;

// The ends of one trajectory's particles, and how often they touched.
class Ends : public Observer {
 public:
  void clear(int particles) {
    ends_.assign(static_cast<std::size_t>(particles), std::nullopt);
    contacts = 0;
  }
  void contact(const ContactEvent&) override { ++contacts; }
  void end(const EndEvent& event) override { ends_[static_cast<std::size_t>(event.particle)] = event; }
  const std::optional<EndEvent>& of(int particle) const { return ends_[static_cast<std::size_t>(particle)]; }
  std::uint64_t contacts = 0;

 private:
  std::vector<std::optional<EndEvent>> ends_;
};

// Runs trajectories in one thread; the prepared table is kept from one to the next.
class Runner {
 public:
  Runner(const System& system, const Sampler& sampler, const Injector& injector, DecisionOptions decisions)
      : system_(system), sampler_(sampler), injector_(injector), world_(*system.table, system.dynamics, decisions) {
    if (system.run.collisions > 0) world_.limit_hits(system.run.collisions);
  }

  /// Adds the trajectory to the tally; false when interrupted in the middle of it.
  bool run(std::uint64_t trajectory, Tally& tally, std::vector<TrajectoryRecord>* records,
           const std::function<bool()>& interrupted) {
    world_.clear();
    add_starts(world_, sampler_, trajectory);
    if (!system_.injections.empty()) injector_.add(world_, trajectory);
    const int count = world_.size();
    ends_.clear(count);
    const std::size_t first_record = records ? records->size() : 0;
    for (int particle = 0; records && particle < count; ++particle)
      records->push_back(start_of(world_.state(particle)));
    world_.run_until(system_.run.t_max, ends_, interrupted);
    if (interrupted && interrupted()) return false;
    tally.counts.contacts += ends_.contacts;
    for (int particle = 0; particle < count; ++particle) {
      const std::uint64_t index = particle_index(system_, trajectory, static_cast<std::uint64_t>(particle));
      TrajectoryRecord end = end_of(particle);
      end.index = index;
      tally.add(end, world_.last_wall(particle), world_.report(particle));
      if (!records) continue;
      TrajectoryRecord& record = (*records)[first_record + static_cast<std::size_t>(particle)];
      record.index = index;
      record.fate = end.fate;
      record.hole = end.hole;
      record.time = end.time;
      record.hits = end.hits;
    }
    return true;
  }

  const DecisionCounts& decisions() const { return world_.decisions(); }

 private:
  TrajectoryRecord start_of(const State& state) const {
    TrajectoryRecord record;
    geometry::Vector position = state.position;
    if (system_.table->lattice) position = position + system_.table->lattice->translation(state.cell);
    record.x = position.x;
    record.y = position.y;
    record.vx = state.velocity.x;
    record.vy = state.velocity.y;
    return record;
  }

  // A particle that has not ended, or never can, survives until t_max.
  TrajectoryRecord end_of(int particle) const {
    TrajectoryRecord record;
    record.hits = world_.hits(particle);
    record.time = system_.run.t_max;
    const std::optional<EndEvent>& end = ends_.of(particle);
    if (!end) return record;
    record.fate = end->fate;
    record.hole = end->hole;
    if (end->fate != Fate::survived && end->fate != Fate::pinned) record.time = end->time.value();
    return record;
  }

  const System& system_;
  const Sampler& sampler_;
  const Injector& injector_;
  World world_;
  Ends ends_;
};

// What the threads of one run share.
class Ensemble {
 public:
  Ensemble(const System& system, const EscapeOptions& options)
      : system_(system), options_(options), sampler_(system), injector_(system), total_(system) {
    const std::uint64_t threads = static_cast<std::uint64_t>(
        options.threads > 0 ? options.threads : std::max(1, omp_get_max_threads()));
    // Small ensembles get small blocks, so that every thread has work.
    const std::uint64_t share = system.run.trajectories / (threads * 8) + 1;
    block_ = std::max<std::uint64_t>(1, std::min(options.block, share));
    blocks_ = (system.run.trajectories + block_ - 1) / block_;
    threads_ = static_cast<int>(std::max<std::uint64_t>(1, std::min(threads, blocks_)));
    if (options.lanes && LaneRunner::suits(system)) lanes_ = options.lanes;
  }

  EscapeResult run() {
    const Stopwatch watch;
    BlockOrder order(options_.records, 16 * static_cast<std::uint64_t>(threads_));
#pragma omp parallel num_threads(threads_)
    work(order);
    if (error_) std::rethrow_exception(error_);
    if (options_.records) order.flush();
    EscapeResult result;
    result.seconds = watch.seconds();
    result.cpu_seconds = watch.cpu_seconds();
    result.threads = threads_;
    result.complete = finished_blocks_ == blocks_;
    result.lanes = lanes_;
    result.decisions = decisions_;
    result.digest = total_.digest;
    result.counts = std::move(total_.counts);
    for (auto& [index, text] : total_.reports) result.reports.push_back(std::move(text));
    return result;
  }

 private:
  bool stopped() const {
    return failed_.load(std::memory_order_relaxed) ||
           (options_.interrupted && options_.interrupted->load(std::memory_order_relaxed));
  }

  // One thread's share. No exception may leave it: it runs inside an OpenMP region.
  void work(BlockOrder& order) noexcept {
    try {
      if (lanes_) {
        work_in_lanes(order);
        if (stopped()) order.close();
        return;
      }
      Runner runner(system_, sampler_, injector_, options_.decisions);
      Tally mine(system_);
      std::uint64_t blocks = 0;
      while (!stopped()) {
        const std::uint64_t block = next_block_.fetch_add(1);
        if (block >= blocks_) break;
        if (options_.records) order.await_turn(block);
        Tally tally(system_);
        std::vector<TrajectoryRecord> records;
        if (!run_block(block, runner, tally, options_.records ? &records : nullptr)) break;
        if (options_.records) order.deliver(block, std::move(records));
        mine.merge(tally);
        ++blocks;
      }
      const std::lock_guard lock(mutex_);
      total_.merge(mine);
      decisions_ += runner.decisions();
      finished_blocks_ += blocks;
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!error_) error_ = std::current_exception();
      failed_ = true;
    }
    if (stopped()) order.close();
  }

  // Without records the lanes go from block to block without a pause; with them, one block after the other.
  void work_in_lanes(BlockOrder& order) {
    LaneRunner runner(system_, sampler_, *lanes_, options_.decisions);
    Tally mine(system_);
    const bool records = static_cast<bool>(options_.records);
    std::uint64_t block = 0, blocks = 0;
    bool pause = false, more = true;
    const auto next = [&](LaneRunner::Block& b) {
      if (pause || stopped()) return false;
      block = next_block_.fetch_add(1);
      more = block < blocks_;
      if (!more) return false;
      if (records) order.await_turn(block);
      b = {block * block_, std::min(system_.run.trajectories, (block + 1) * block_)};
      pause = records;
      return true;
    };
    const auto done = [&](LaneRunner::Done&& ready) {
      if (records) order.deliver(block, std::move(ready.records));
      mine.merge(ready.tally);
      ++blocks;
    };
    const auto ended = [&](std::uint64_t hits) {
      if (options_.progress) report_progress(hits);
    };
    while (more && !stopped()) {
      pause = false;
      runner.run(next, done, records, ended, [this] { return stopped(); });
      if (!records) break;
    }
    const std::lock_guard lock(mutex_);
    total_.merge(mine);
    decisions_ += runner.decisions();
    finished_blocks_ += blocks;
  }

  bool run_block(std::uint64_t block, Runner& runner, Tally& tally, std::vector<TrajectoryRecord>* records) {
    const std::function<bool()> interrupted = [this] { return stopped(); };
    const std::uint64_t end = std::min(system_.run.trajectories, (block + 1) * block_);
    for (std::uint64_t trajectory = block * block_; trajectory < end; ++trajectory) {
      const std::uint64_t before = tally.counts.collisions;
      if (stopped() || !runner.run(trajectory, tally, records, interrupted)) return false;
      if (options_.progress) report_progress(tally.counts.collisions - before);
    }
    return true;
  }

  void report_progress(std::uint64_t hits) {
    const std::uint64_t done = done_.fetch_add(1, std::memory_order_relaxed) + 1;
    const std::uint64_t all_hits = hits_.fetch_add(hits, std::memory_order_relaxed) + hits;
    std::unique_lock lock(progress_mutex_, std::try_to_lock);
    if (lock) options_.progress(done, all_hits);
  }

  const System& system_;
  const EscapeOptions& options_;
  const Sampler sampler_;
  const Injector injector_;
  std::uint64_t block_ = 1, blocks_ = 0;
  int threads_ = 1;
  std::atomic<std::uint64_t> next_block_{0}, done_{0}, hits_{0};
  std::atomic<bool> failed_{false};
  std::mutex mutex_, progress_mutex_;
  Tally total_;
  DecisionCounts decisions_;
  std::uint64_t finished_blocks_ = 0;
  std::optional<InstructionSet> lanes_;
  std::exception_ptr error_;
};

}  // namespace

EscapeResult run_escape(const System& system, const EscapeOptions& options) {
  return Ensemble(system, options).run();
}

}  // namespace carom
