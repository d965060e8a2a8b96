// Intervals for shares that were counted, and errors by replicates of quasi-random starts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

namespace carom {

struct Interval {
  double low = 0.0, high = 1.0;
};
/// 95 % interval of Wilson (1927) for k successes of n; all of [0, 1] for n = 0.
Interval wilson_interval(std::uint64_t successes, std::uint64_t trials);

/// Independent sequences of quasi-random starts: trajectory i belongs to number i modulo this.
/// Their spread tells the errors (docs/physics/quasi-random.md), which are the larger the fewer
/// they are: an interval of 95 % is wider by 9 % than one of a known error.
inline constexpr std::size_t replicates = 16;
/// The 0.975 quantile of Student's distribution with replicates - 1 degrees of freedom.
inline constexpr double replicates_quantile = 2.131449545559323;
static_assert(replicates == 16, "another number of replicates has another quantile");

/// Successes of trials.
struct Portion {
  std::uint64_t successes = 0, trials = 0;
};
/// 95 % interval for the share of all parts together. The parts, one a replicate, are independent
/// and alike; the trials of a part are not independent. All of [0, 1] where a part is empty.
Interval replicate_interval(std::span<const Portion> parts);
/// The least variance of a number of successes that the spread of replicates can tell.
double least_variance(double successes, double trials);

/// Standard error of a number by the jackknife: `without(r)` is the number without replicate r.
double jackknife_error(const std::function<double(std::size_t)>& without);

}  // namespace carom
