// A line of progress on standard error, for people only.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>

namespace carom::files {

/// Rewrites one line a few times a second while standard error is a terminal. Where nothing is
/// shown for some seconds, as while a system is prepared, the line tells how long it has taken.
class Progress {
 public:
  /// `done`: the share of the work that others have done before.
  explicit Progress(bool wanted, double done = 0.0);
  Progress(const Progress&) = delete;
  ~Progress();

  bool enabled() const { return enabled_; }
  /// `share` of the work done in [0, 1]; `rate` is shown beside it, e.g. "12.3 M hits/s".
  void show(double share, const std::string& rate);
  /// The same where it is time to: `done` of `all` that are called `name`, as "starts".
  void count(std::uint64_t done, std::uint64_t all, const char* name);
  /// Is it time to show again? Cheap enough to ask often.
  bool due() const;
  double seconds() const;

 private:
  using Clock = std::chrono::steady_clock;
  void tell_time();

  bool enabled_, shown_ = false, ended_ = false;
  double done_;
  Clock::time_point start_, last_;
  std::string line_ = "\rpreparing";
  std::mutex mutex_;  ///< of the line, of when and whether it was shown, and of the end
  std::condition_variable end_;
  std::thread clock_;  ///< last: it uses the members above
};

/// How long the rest will take after `seconds` took the work from the share `from` to `share`.
/// Negative: unknown.
double seconds_left(double seconds, double from, double share);

/// "950", "12.3 k", "4.56 M", "7.89 G": three digits and a prefix, with a blank for a unit to
/// follow.
std::string with_prefix(double value);
/// "4 s", "3 min 20 s", "2 h 5 min".
std::string as_duration(double seconds);

}  // namespace carom::files
