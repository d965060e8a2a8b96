// A thread that does something every so often while others compute.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace carom::engines {

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

}  // namespace carom::engines
