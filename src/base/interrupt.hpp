// Long computations that listen: how often they ask whether they are to stop.
#pragma once

#include <functional>

namespace carom::base {

/// Counts work, and asks once in some milliseconds of it. It belongs to one thread.
class Interrupt {
 public:
  /// `asked` must live as long; empty or null: nothing stops it.
  explicit Interrupt(const std::function<bool()>* asked = nullptr)
      : asked_(asked && *asked ? asked : nullptr) {}

  /// Adds work, in nanoseconds roughly. True: stop; what has been computed since this was false is
  /// worth nothing.
  bool after(double work) {
    work_ += work;
    return work_ < between_questions ? stopped_ : ask();
  }
  bool stopped() const { return stopped_; }
  /// What was asked elsewhere says so.
  void stop() { stopped_ = true; }

 private:
  static constexpr double between_questions = 1e7;
  bool ask() {
    work_ = 0.0;
    stopped_ = stopped_ || (asked_ && (*asked_)());
    return stopped_;
  }

  const std::function<bool()>* asked_;
  double work_ = 0.0;
  bool stopped_ = false;
};

}  // namespace carom::base
