// Two survival curves of the same starts, flown in two ways: do they differ?
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

namespace carom {

/// How one trajectory ended; infinity: it is still there at the last time.
struct PairedEnd {
  double time = std::numeric_limits<double>::infinity();
  int hole = -1;
  std::uint64_t hits = 0;
};

/// Shares still there at time t, their difference (first less second) and its standard error.
struct PairedPoint {
  double t = 0.0, first = 0.0, second = 0.0, difference = 0.0, error = 0.0;
  std::uint64_t only_first = 0, only_second = 0;  ///< trajectories still there in one of them alone
  /// The smallest true difference that the test would find (95 % over all times together) four
  /// times in five.
  double detectable = 0.0;
};

/// How many pairs differ, both curves, and the test of their difference.
struct PairedResult {
  std::uint64_t pairs = 0;
  std::uint64_t other_hole = 0;  ///< both escaped, through different holes, or only one did
  std::uint64_t other_hits = 0;  ///< the same way out, after another number of hits
  std::uint64_t other_time = 0;  ///< the same in both, but not at the same time
  std::vector<PairedPoint> points;
  /// The largest |difference| over its error, over all times; how often swaps of random pairs give
  /// as much; and what they exceed in 5 % of cases.
  double statistic = 0.0, p_value = 1.0, threshold = 0.0;
  std::uint64_t swaps = 0;
  std::uint64_t different() const { return other_hole + other_hits + other_time; }
};

/// Collects pairs. If neither way is biased, which of a pair's two ends belongs to which way is a
/// toss of a coin: the swap test tosses it again for each pair.
class PairedSurvival {
 public:
  /// `times`: increasing. Ends that differ by at most `tolerance` in time are the same.
  PairedSurvival(std::vector<double> times, double tolerance)
      : times_(std::move(times)), tolerance_(tolerance) {}
  void add(const PairedEnd& first, const PairedEnd& second);
  PairedResult result(std::uint64_t seed, std::uint64_t swaps = 10000) const;

 private:
  /// A pair of which only one is there at times from, from + 1 … to - 1 (indices).
  struct Disagreement {
    std::uint32_t from, to;
    bool first;
  };
  std::vector<double> times_;
  double tolerance_;
  std::vector<std::uint64_t> gone_first_,
      gone_second_;  // by the first report time at which they are gone
  std::vector<Disagreement> disagreements_;
  std::uint64_t pairs_ = 0, other_hole_ = 0, other_hits_ = 0, other_time_ = 0;
};

}  // namespace carom
