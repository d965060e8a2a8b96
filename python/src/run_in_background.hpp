// Long computations beside the interpreter: in a thread of their own, while this one looks for
// Ctrl-C and tells how far they are.
#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <mutex>
#include <thread>

namespace carom::python {

/// What the computation tells, and is told.
struct Course {
  std::atomic<bool> stop{false};
  std::atomic<double> share{0.0};      ///< of the work that is done
  std::atomic<std::uint64_t> done{0};  ///< trajectories, orbits or hits
};

/// Runs `work` without the interpreter's lock. `progress`, unless None, is called with the share
/// of the work and the number done, some times a second. Ctrl-C or an error in `progress` stop the
/// work: what it has done is kept, and the error is returned to be raised (null: none). Errors of
/// the work itself are thrown.
template <class Work>
std::exception_ptr run_in_background(Course& course, const pybind11::object& progress, Work work) {
  using namespace std::chrono_literals;
  std::mutex mutex;
  std::condition_variable changed;
  bool over = false;
  std::exception_ptr failure, interruption;
  pybind11::gil_scoped_release release;
  std::thread thread([&] {
    try {
      work();
    } catch (...) {
      failure = std::current_exception();
    }
    const std::lock_guard lock(mutex);
    over = true;
    changed.notify_one();
  });
  for (auto wait = 1ms;; wait = wait < 50ms ? 2 * wait : 50ms) {
    std::unique_lock lock(mutex);
    if (changed.wait_for(lock, wait, [&] { return over; })) break;
    lock.unlock();
    const pybind11::gil_scoped_acquire acquire;
    if (interruption) continue;
    try {
      if (PyErr_CheckSignals() != 0) throw pybind11::error_already_set();
      if (!progress.is_none()) progress(course.share.load(), course.done.load());
    } catch (...) {
      interruption = std::current_exception();
      course.stop = true;
    }
  }
  thread.join();
  if (failure && !interruption) std::rethrow_exception(failure);
  return interruption;
}

/// What ended a computation early, as Python's exception; None: nothing.
inline pybind11::object error_of(const std::exception_ptr& interruption) {
  try {
    if (interruption) std::rethrow_exception(interruption);
  } catch (pybind11::error_already_set& error) {
    return error.value();
  }
  return pybind11::none();
}

}  // namespace carom::python
