#include "carom/analysis/drift.hpp"

#include <algorithm>
#include <cmath>

#include "carom/base/elementary.hpp"

namespace carom {

namespace {

constexpr double log_four = 1.3862943611198906;
constexpr double significant = 3.0, agrees = 2.0;  // errors

double root(double square) { return std::sqrt(std::max(0.0, square)); }

}  // namespace

void DriftSums::add(const Lengths& lengths, double end) {
  const double late = (lengths[3] - lengths[2]) / (0.75 * end);
  const double before = (lengths[2] - lengths[1]) / (0.1875 * end) - late;
  const double early = (lengths[1] - lengths[0]) / (0.046875 * end) - late;
  ++orbits;
  far.add(early), near.add(before);
  far_squares.add(early * early), near_squares.add(before * before);
  product.add(early * before);
}

void DriftSums::merge(const DriftSums& other) {
  orbits += other.orbits;
  far.merge(other.far), near.merge(other.near);
  far_squares.merge(other.far_squares), near_squares.merge(other.near_squares);
  product.merge(other.product);
}

// A rate c/t has the mean c ln 4/(3 t) from t to 4 t. Its excess over the mean from T/4 on is
// 20 ln 4 c/T between T/64 and T/16 and 4 ln 4 c/T between T/16 and T/4: two estimates of c. In the
// window it makes c ln(to/from)/(to - from).
std::optional<Drift> drift_of(const DriftSums& sums, const TimeWindow& window,
                              const Estimate& exponent) {
  if (sums.orbits < GrowthSums::enough_blocks || !std::isfinite(exponent.error))
    return std::nullopt;
  const double n = static_cast<double>(sums.orbits);
  const double begins = std::max(window.from, window.to / 64.0);
  const double in_window =
      elementary::log(window.to / begins) / (window.to - window.from) * window.to / log_four;
  const double of_far = in_window / 20.0, of_near = in_window / 4.0;
  const double far = sums.far.value() / n, near = sums.near.value() / n;
  const auto covariance = [&](const ExactSum& sum, double a, double b) {
    return (sum.value() / n - a * b) / (n - 1.0);
  };
  const double far_far = of_far * of_far * covariance(sums.far_squares, far, far),
               near_near = of_near * of_near * covariance(sums.near_squares, near, near),
               far_near = of_far * of_near * covariance(sums.product, far, near);
  const Estimate by_far{of_far * far, root(far_far)}, by_near{of_near * near, root(near_near)};
  const auto matters = [&](const Estimate& bias) {
    return std::fabs(bias.value) > std::max(significant * bias.error, exponent.error);
  };
  if (matters(by_near)) return Drift{by_near, true};
  // What was early may be gone: it must not be more than is left later, by 1/t.
  const double excess =
      by_far.value > 0.0 ? by_far.value - by_near.value : by_near.value - by_far.value;
  const bool goes_on = excess <= agrees * root(far_far + near_near - 2.0 * far_near);
  return Drift{by_far, matters(by_far) && goes_on};
}

}  // namespace carom
