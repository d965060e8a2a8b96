// Blocks of trajectories on threads: for ensembles whose parts can be merged in any order.
#pragma once

#include <omp.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>

#include "carom/starts/sampler.hpp"

namespace carom::engines {

struct BlockPlan {
  std::uint64_t trajectories = 0, block = 1, blocks = 0;
  int threads = 1;

  /// `threads` = 0: as many as OpenMP gives. Small ensembles get small blocks, so that every thread
  /// has work.
  BlockPlan(std::uint64_t all, int wanted_threads, std::uint64_t largest_block)
      : trajectories(all) {
    const auto wanted = static_cast<std::uint64_t>(
        wanted_threads > 0 ? wanted_threads : std::max(1, omp_get_max_threads()));
    block = std::max<std::uint64_t>(1, std::min(largest_block, all / (wanted * 8) + 1));
    blocks = (all + block - 1) / block;
    threads = static_cast<int>(std::max<std::uint64_t>(1, std::min(wanted, blocks)));
  }
};

/// Runs every block once. `make()` gives a thread its worker; `worker.run(block, first, end,
/// stopped)` does trajectories first … end - 1 and returns false if it was stopped on the way;
/// `finish(worker)` is called at a thread's end, one thread at a time. Rethrows what any of them
/// throws, after all threads are done. Returns whether all blocks were finished.
bool run_blocks(const BlockPlan& plan, const std::atomic<bool>* interrupted, auto make,
                auto finish) {
  std::atomic<std::uint64_t> next{0}, finished{0};
  std::atomic<bool> failed{false};
  std::mutex mutex;
  std::exception_ptr error;
  const std::function<bool()> stopped = [&] {
    return failed.load(std::memory_order_relaxed) ||
           (interrupted && interrupted->load(std::memory_order_relaxed));
  };
  // No exception may leave an OpenMP region.
  const auto work = [&]() noexcept {
    try {
      auto worker = make();
      try {
        while (!stopped()) {
          const std::uint64_t block = next.fetch_add(1);
          if (block >= plan.blocks) break;
          const std::uint64_t first = block * plan.block;
          if (!worker.run(block, first, std::min(plan.trajectories, first + plan.block), stopped))
            break;
          finished.fetch_add(1);
        }
      } catch (const SamplingStopped&) {  // its block was not finished
      }
      const std::lock_guard lock(mutex);
      finish(worker);
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!error) error = std::current_exception();
      failed = true;
    }
  };
#pragma omp parallel num_threads(plan.threads)
  work();
  if (error) std::rethrow_exception(error);
  return finished.load() == plan.blocks;
}

}  // namespace carom::engines
