// Distributions of positive numbers, counted in bins, with errors by groups of trajectories.
#pragma once

#include <cstdint>
#include <optional>
#include <tuple>
#include <vector>

#include "carom/base/fields.hpp"
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

/// The columns of bins of type B. `unit`: of the number; `per`: of the density; `counted`: what is
/// in a bin; `density`: of what it is; `longer`: whose share is that.
template <class B>
constexpr auto distribution_fields(const char* unit, const char* per, const char* counted,
                                   const char* density, const char* longer) {
  return std::tuple{field("from", unit, "Start of the bin", &B::from),
                    field("to", unit, "End of the bin", &B::to),
                    field("count", "1", counted, &B::count),
                    field_as<double>(
                        "density", per, density, [](auto& b) -> auto& { return b.density.value; }),
                    field_as<double>(
                        "density_stderr", per, "Its standard error",
                        [](auto& b) -> auto& { return b.density.error; }),
                    field_as<double>(
                        "longer", "1", longer, [](auto& b) -> auto& { return b.longer.value; }),
                    field_as<double>(
                        "longer_stderr", "1", "Its standard error",
                        [](auto& b) -> auto& { return b.longer.error; })};
}

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
