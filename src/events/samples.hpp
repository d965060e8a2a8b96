// The times at which a world is sampled.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "base/interrupt.hpp"
#include "events/bodies.hpp"

namespace carom::events {

class Groups;

/// Tells an observer the state of every body at each of these times. It changes nothing of them.
class Samples {
 public:
  Samples(const Bodies& bodies, const Groups& groups, base::Interrupt& interrupt)
      : bodies_(bodies), groups_(groups), interrupt_(interrupt) {}

  /// Increasing times.
  void at(std::vector<double> times);
  /// k * interval, k = 0, 1, 2, …
  void every(double interval);
  /// Begins with the first time again.
  void restart() { next_ = 0; }
  bool any() const { return any_; }

  /// The samples that are due before `until`, or (`inclusive`) at it. All of an instant, or nothing
  /// if interrupted.
  void emit(Time until, bool inclusive, Observer& observer);

 private:
  const Bodies& bodies_;
  const Groups& groups_;
  base::Interrupt& interrupt_;
  std::vector<double> times_;
  double interval_ = 0.0;
  std::uint64_t next_ = 0;
  bool any_ = false;
  std::vector<std::pair<int, State>> seen_;  ///< of the sample under way
};

}  // namespace carom::events
