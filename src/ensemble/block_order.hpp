// Brings blocks that threads finish in any order back into the order of their indices.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <vector>

#include "carom/ensemble/escape.hpp"

namespace carom::ensemble {

/// Holds at most `window` blocks: a thread that is further ahead waits for the slowest block.
template <class Record>
class OrderedBlocks {
 public:
  using Sink = std::function<void(const std::vector<Record>&)>;

  OrderedBlocks(const Sink& sink, std::uint64_t window) : sink_(sink), window_(window) {}

  /// Waits until `block` is less than `window` blocks ahead, or until closed.
  void await_turn(std::uint64_t block) {
    std::unique_lock lock(mutex_);
    turn_.wait(lock, [&] { return closed_ || block < next_ + window_; });
  }

  void deliver(std::uint64_t block, std::vector<Record> records) {
    const std::lock_guard lock(mutex_);
    pending_.emplace(block, std::move(records));
    while (!pending_.empty() && pending_.begin()->first == next_) {
      sink_(pending_.begin()->second);
      pending_.erase(pending_.begin());
      ++next_;
    }
    turn_.notify_all();
  }

  /// Lets every waiting thread go: a block that is missing will never come.
  void close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    turn_.notify_all();
  }

  /// After an interruption: what waited for blocks that never came, still in order.
  void flush() {
    const std::lock_guard lock(mutex_);
    for (const auto& [block, records] : pending_) sink_(records);
    pending_.clear();
  }

 private:
  const Sink& sink_;
  const std::uint64_t window_;
  std::mutex mutex_;
  std::condition_variable turn_;
  std::map<std::uint64_t, std::vector<Record>> pending_;
  std::uint64_t next_ = 0;
  bool closed_ = false;
};

using BlockOrder = OrderedBlocks<TrajectoryRecord>;

}  // namespace carom::ensemble
