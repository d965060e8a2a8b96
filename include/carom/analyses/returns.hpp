// Return times to a wall: how long orbits stay away from it, in time and in hits.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "carom/results/distribution.hpp"
#include "carom/results/ensemble_result.hpp"
#include "carom/results/fate_counts.hpp"
#include "carom/system/system.hpp"

namespace carom {

/// Excursions from the wall that begin in the first half of the run, so that each is seen for at
/// least half of it. Apart for each group of trajectories (index modulo the number of groups).
class ReturnSums {
 public:
  static constexpr std::size_t groups = 128;
  struct Sum {
    /// Times from one hit of the wall to the next; those of half the run or more are only longer.
    BinnedCounts times;
    /// Hits from one to the next, the last one counted; `longer` has not come back.
    BinnedCounts hits;
    std::uint64_t particles = 0;  ///< that were followed to the end
    std::uint64_t hits_in_half = 0;
    /// Fewest hits that one was away that has not come back; 2^64 - 1: all have.
    std::uint64_t fewest_away = std::numeric_limits<std::uint64_t>::max();
    void operator+=(const Sum&);
    std::uint64_t excursions() const { return times.bins.total() + times.longer; }
  };

  ReturnSums() : sums_(groups) {}
  const Sum& of(std::size_t group) const { return sums_[group]; }
  void add(std::size_t group, const Sum& sum) { sums_[group] += sum; }
  void merge(const ReturnSums& other) {
    for (std::size_t g = 0; g < groups; ++g) add(g, other.of(g));
  }

 private:
  std::vector<Sum> sums_;
};

struct ReturnTimeBin : DistributionBin {};
struct ReturnHitsBin : DistributionBin {};
template <>
struct Fields<ReturnTimeBin> {
  static constexpr auto list = distribution_fields<ReturnTimeBin>(
      "time", "1/time", "Returns after from <= t < to", "Fraction of all excursions, per time",
      "Fraction of the excursions that last `from` or longer");
};
template <>
struct Fields<ReturnHitsBin> {
  static constexpr auto list = distribution_fields<ReturnHitsBin>(
      "1", "1", "Returns with from <= n < to hits, the last one included",
      "Fraction of all excursions, per hit", "Fraction of the excursions of `from` hits or more");
};

struct Returns {
  double half = 0.0;  ///< half of the run
  std::uint64_t excursions = 0;
  Estimate mean_time, mean_hits;  ///< NaN: there were no hits
  Distribution times, hits;
};
/// Mean times and hits are those of all excursions, by their number in half of the run: none is cut
/// off. Errors are the jackknife's over groups of trajectories.
Returns returns_of(const ReturnSums&, double half);

/// By Kac's lemma (M. Kac, Bull. Amer. Math. Soc. 53 (1947), 1002): free particles of one speed v
/// whose starts have the flow's measure, or that of the map, in whose place it is drawn, come to a
/// wall of length l once in pi A / (l v), and once in L / l hits of a perimeter L, on an average
/// over all of them. Empty for others.
struct ExpectedReturns {
  double time = 0.0, hits = 0.0;
};
std::optional<ExpectedReturns> expected_returns(const System&);

struct ReturnsResult : EnsembleResult, EndCounts {
  ReturnSums sums;

  /// Adds another part of the same ensemble, in any order the same. False, and no change, where a
  /// trajectory is in both.
  bool add(const ReturnsResult& other);
};

/// Follows orbits of a table without holes until t_max, and times their returns to the wall of
/// System::section. Starts from all walls are replaced by uniform ones, as with exponents. Throws
/// InputError where it names none, and where orbits may leave.
ReturnsResult run_returns(const System&, const EnsembleOptions<ReturnsResult>& = {});

}  // namespace carom
