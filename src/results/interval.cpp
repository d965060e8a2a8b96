#include "carom/results/interval.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "carom/base/error.hpp"
#include "results/numbers.hpp"

namespace carom {

namespace {

using results::normal_quantile;

// n trials, of which k succeed and `missed` do not; any numbers, not whole ones alone.
Interval wilson(double k, double missed, double n, double quantile) {
  const double z2 = quantile * quantile;
  const double middle = (k + z2 / 2) / (n + z2);
  const double half = quantile / (n + z2) * std::sqrt(k * (missed / n) + z2 / 4);
  // The ends are exact where nothing, or everything, succeeded.
  return {k == 0.0 ? 0.0 : std::max(0.0, middle - half),
          missed == 0.0 ? 1.0 : std::min(1.0, middle + half)};
}

}  // namespace

Interval wilson_interval(std::uint64_t successes, std::uint64_t trials) {
  if (trials == 0) return {};
  return wilson(static_cast<double>(successes), static_cast<double>(trials - successes),
                static_cast<double>(trials), normal_quantile);
}

// Numbers are whole. Where a part should have k + f successes and has k or k + 1, its variance is
// f (1 - f) <= 1/4, which 16 such numbers tell badly: no less is taken, except for few successes,
// where that of independent trials is less.
double least_variance(double successes, double trials) {
  return std::min(replicates / 4.0, successes * ((trials - successes) / trials));
}

// Wilson's interval for as many independent trials as would have the variance that was found.
Interval replicate_interval(std::span<const Portion> parts) {
  if (parts.size() != replicates) throw InternalError("another number of replicates");
  double k = 0.0, n = 0.0;
  for (const auto& [successes, trials] : parts) {
    if (trials == 0) return {};
    k += static_cast<double>(successes);
    n += static_cast<double>(trials);
  }
  const double share = k / n, independent = k * ((n - k) / n), r = static_cast<double>(replicates);
  double squares = 0.0;
  for (const auto& [successes, trials] : parts) {
    const double off = static_cast<double>(successes) - share * static_cast<double>(trials);
    squares += off * off;
  }
  const double variance = std::max(least_variance(k, n), squares * r / (r - 1.0));
  const double times = independent > 0.0 ? independent / variance : 1.0;
  return wilson(k * times, (n - k) * times, n * times, replicates_quantile);
}

double jackknife_error(const std::function<double(std::size_t)>& without) {
  std::array<double, replicates> numbers{};
  double mean = 0.0, squares = 0.0;
  constexpr double r = replicates;
  for (std::size_t i = 0; i < replicates; ++i) mean += (numbers[i] = without(i)) / r;
  for (const double number : numbers) squares += (number - mean) * (number - mean);
  return std::sqrt(squares * (r - 1.0) / r);
}

}  // namespace carom
