// Rows that C++ makes while Python takes them, a block at a time.
#pragma once

#include <pybind11/pybind11.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "arrays.hpp"

namespace carom::python {

/// A thread makes rows and waits while too many of them have not been taken; the interpreter takes
/// them. Only next() and close() are called by the interpreter, and nothing else touches it.
template <class Row>
class Stream {
 public:
  /// What makes the rows: it calls push(), and ends when that returns false.
  using Work = std::function<void(Stream&)>;

  Stream(std::size_t block, Work work)
      : block_(block), thread_([this, work = std::move(work)] { run(work); }) {}
  Stream(const Stream&) = delete;
  ~Stream() { close(); }

  /// Adds rows at(0) … at(many - 1); one call at a time. False: no more are wanted.
  template <class At>
  bool push(std::size_t many, At at) {
    for (std::size_t i = 0; i < many;) {
      if (making_.capacity() < block_) making_.reserve(block_);
      for (; i < many && making_.size() < block_; ++i) making_.push_back(at(i));
      if (making_.size() == block_) hand_over();
    }
    return !stopped_.load(std::memory_order_relaxed);
  }
  const std::atomic<bool>& stopped() const { return stopped_; }

  /// The next block, all of the same length but for the last one; None: there are no more. Throws
  /// what the work has thrown, after the blocks before it. Ctrl-C ends the work.
  pybind11::object next() {
    using namespace std::chrono_literals;
    std::vector<Row> rows;
    for (bool there = false; !there;) {
      {
        const pybind11::gil_scoped_release release;
        std::unique_lock lock(mutex_);
        there = taker_.wait_for(lock, 50ms, [&] { return over_ || !ready_.empty(); });
        if (there && !ready_.empty()) {
          rows = std::move(ready_.front());
          ready_.pop_front();
          maker_.notify_one();
        }
      }
      if (PyErr_CheckSignals() != 0) {
        close();
        throw pybind11::error_already_set();
      }
    }
    if (!rows.empty()) return array_of(std::move(rows));
    if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
    return pybind11::none();
  }

  /// Ends the work, and waits for that.
  void close() {
    if (!thread_.joinable()) return;
    const pybind11::gil_scoped_release release;
    {
      const std::lock_guard lock(mutex_);
      stopped_ = true;
    }
    maker_.notify_one();
    thread_.join();
    ready_.clear();
  }

 private:
  static constexpr std::size_t most_waiting = 4;  ///< blocks

  void run(const Work& work) {
    std::exception_ptr failure;
    try {
      work(*this);
    } catch (...) {
      failure = std::current_exception();
    }
    if (!making_.empty()) hand_over();
    const std::lock_guard lock(mutex_);
    failure_ = failure;
    over_ = true;
    taker_.notify_one();
  }

  void hand_over() {
    std::unique_lock lock(mutex_);
    maker_.wait(lock, [&] { return stopped_ || ready_.size() < most_waiting; });
    if (!stopped_) ready_.push_back(std::move(making_));
    making_.clear();
    taker_.notify_one();
  }

  const std::size_t block_;
  std::mutex mutex_;
  std::condition_variable maker_, taker_;
  std::vector<Row> making_;             ///< the work's own
  std::deque<std::vector<Row>> ready_;  ///< full blocks, and the last one
  bool over_ = false;
  std::atomic<bool> stopped_{false};
  std::exception_ptr failure_;
  std::thread thread_;  ///< last: it uses all the others
};

}  // namespace carom::python
