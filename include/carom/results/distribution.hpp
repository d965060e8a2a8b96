// Distributions of positive numbers, counted in bins, with errors by groups of trajectories.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "carom/results/binary_bins.hpp"
#include "carom/results/estimate.hpp"

namespace carom {

/// Numbers in bins, eight to a factor of two. Those of a limit or more are only counted as longer.
struct BinnedCounts {
  BinaryBins<3> bins;
  std::uint64_t longer = 0;
  void add(double number, double limit) {
    if (number < limit)
      bins.add(number);
    else
      ++longer;
  }
  void operator+=(const BinnedCounts& other) {
    bins.merge(other.bins);
    longer += other.longer;
  }
};

/// from <= number < to.
struct DistributionBin {
  double from = 0.0, to = 0.0;
  std::uint64_t count = 0;
  Estimate density;  ///< share of all, per unit of the number
  Estimate longer;   ///< share of those that are `from` or more
};

/// Between two numbers, a factor of four apart, of which the larger one is exceeded by at least 100
/// and the smaller one is 16 means or more.
struct DistributionTail {
  double from = 0.0, to = 0.0;
  Estimate exponent;  ///< a of (share of larger ones) ~ number^-a
  /// `to` times the share of larger ones; over the mean and times `to` again where there is a mean.
  Estimate amplitude;
};

struct Distribution {
  std::uint64_t all = 0, longer = 0;
  std::vector<DistributionBin> bins;  ///< the first one begins at 0
  std::optional<DistributionTail> tail;
};

}  // namespace carom
