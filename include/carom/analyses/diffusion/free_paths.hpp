// Lengths of free flights: their distribution between hits and from the start.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "carom/analyses/diffusion/mean_square_displacement.hpp"
#include "carom/base/exact_sum.hpp"
#include "carom/results/distribution.hpp"

namespace carom {

/// What a particle's flights were.
struct FlightsOfParticle {
  std::vector<double> between;   ///< lengths of flights that began at a hit
  std::vector<double> at_start;  ///< length of the flight from the start; empty: not known
  std::uint64_t hits = 0;
  double path = 0.0;  ///< length of all that it flew
};

/// Numbers of flights by length, apart for each group of trajectories (as DisplacementSums). A
/// flight of `limit` or more is only counted as longer.
class FreePathSums {
 public:
  static constexpr std::size_t groups = DisplacementSums::groups;
  using Bins = BinaryBins<3>;  ///< eight to a factor of two
  using Flights = BinnedCounts;
  struct Sum {
    Flights between, at_start;
    std::uint64_t hits = 0;
    ExactSum path;
    void operator+=(const Sum&);
  };

  FreePathSums() = default;
  explicit FreePathSums(double limit) : limit_(limit), sums_(groups) {}

  /// False: nothing was asked for.
  bool counted() const { return !sums_.empty(); }
  double limit() const { return limit_; }
  void add(std::uint64_t trajectory, const FlightsOfParticle&);
  void merge(const FreePathSums& other);
  const Sum& of(std::size_t group) const { return sums_[group]; }
  /// Adds what was kept of one group.
  void merge(std::size_t group, const Sum& other) { sums_[group] += other; }

 private:
  double limit_ = 0.0;
  std::vector<Sum> sums_;
};

/// Of lengths.
using FreePathBin = DistributionBin;
using FreePathTail = DistributionTail;
using FreePathDistribution = Distribution;

template <>
struct Fields<FreePathBin> {
  static constexpr auto list = distribution_fields<FreePathBin>(
      "length", "1/length", "Flights of from <= length < to", "Fraction of all flights, per length",
      "Fraction of the flights of `from` or longer");
};

/// Where free corridors exist, both tails' amplitudes tend to flight_tail.
struct FreePaths {
  double limit = 0.0;
  Estimate mean;  ///< length of all that was flown, over the number of hits; NaN: there are none
  FreePathDistribution between, at_start;
};
/// Errors are the jackknife's over groups of trajectories.
FreePaths free_paths_of(const FreePathSums&);

}  // namespace carom
