// Blocks that threads finish in any order, written in the order of their numbers.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <utility>
#include <vector>

namespace carom::engines {

/// Calls a sink with the records of blocks 0, 1, 2, …, one call at a time.
/// (1) The sink gets every block once, in order. Only finish() leaves out blocks that never came.
/// (2) Once the sink has thrown it is not called again: the block at which it threw, and those that
///     wait behind it, are dropped. The thread whose call threw passes the error on.
/// (3) No thread waits for a block that will not come: a Writer that ends, also by an error, ends
///     all waiting.
/// (4) At most `window` blocks, and one for each thread, are in memory.
template <class Record>
class OrderedOutput {
 public:
  using Block = std::vector<Record>;
  using Sink = std::function<void(const Block&)>;

  /// Without a sink (an empty function) blocks are dropped, and no thread waits.
  OrderedOutput(const Sink& sink, std::uint64_t window) : sink_(sink), window_(window) {}
  OrderedOutput(const OrderedOutput&) = delete;

  bool is_wanted() const { return bool(sink_); }

  /// A thread holds one as long as it makes blocks.
  class Writer {
   public:
    explicit Writer(OrderedOutput& output) : output_(output) {}
    Writer(const Writer&) = delete;
    ~Writer() { output_.close(); }

    bool is_wanted() const { return output_.is_wanted(); }
    /// Waits until `number` is less than `window` blocks ahead, or until a thread has ended.
    void await_turn(std::uint64_t number) { output_.await_turn(number); }
    /// False: the output has failed, and the block is dropped.
    bool deliver(std::uint64_t number, Block block) {
      return output_.deliver(number, std::move(block));
    }

   private:
    OrderedOutput& output_;
  };

  /// After all threads have ended: writes what waits behind blocks that never came.
  void finish() {
    const std::lock_guard lock(mutex_);
    while (!waiting_.empty()) write_first();
  }

 private:
  void await_turn(std::uint64_t number) {
    if (!is_wanted()) return;
    std::unique_lock lock(mutex_);
    turn_.wait(lock, [&] { return closed_ || number < next_ + window_; });
  }

  bool deliver(std::uint64_t number, Block block) {
    if (!is_wanted()) return true;
    const std::lock_guard lock(mutex_);
    if (failed_) return false;
    waiting_.emplace(number, std::move(block));
    while (!waiting_.empty() && waiting_.begin()->first == next_) write_first();
    turn_.notify_all();
    return true;
  }

  void write_first() {  // with the mutex held
    try {
      sink_(waiting_.begin()->second);
    } catch (...) {
      failed_ = closed_ = true;
      waiting_.clear();
      turn_.notify_all();
      throw;
    }
    next_ = waiting_.begin()->first + 1;
    waiting_.erase(waiting_.begin());
  }

  void close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    turn_.notify_all();
  }

  const Sink& sink_;
  const std::uint64_t window_;
  std::mutex mutex_;
  std::condition_variable turn_;
  std::map<std::uint64_t, Block> waiting_;  ///< by number
  std::uint64_t next_ = 0;                  ///< the block that the sink gets next
  bool closed_ = false;                     ///< no thread waits any longer
  bool failed_ = false;                     ///< the sink has thrown
};

}  // namespace carom::engines
