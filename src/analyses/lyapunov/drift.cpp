#include "carom/analyses/lyapunov/drift.hpp"

#include <algorithm>
#include <cmath>

#include "carom/base/elementary.hpp"
#include "results/numbers.hpp"

namespace carom {

namespace {

using results::root;

constexpr double log_four = 1.3862943611198906;
constexpr double significant = 2.5, agrees = 2.0;  // errors

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
// 20 ln 4 c/T between T/64 and T/16 and 4 ln 4 c/T between T/16 and T/4. In the window it makes
// c ln(to/from)/(to - from). A rate c/sqrt(t) has the mean 2c/(3 sqrt(t)) from t to 4 t, the
// excesses 4 c/sqrt(T) and (4/3) c/sqrt(T), and makes 2c/(sqrt(to) + sqrt(from)).
std::optional<Drift> drift_of(const DriftSums& sums, const TimeWindow& window,
                              const Estimate& exponent) {
  if (sums.orbits < GrowthSums::enough_blocks || !std::isfinite(exponent.error))
    return std::nullopt;
  const double n = static_cast<double>(sums.orbits);
  const double begins = std::max(window.from, window.to / 64.0);
  const double fast = elementary::log(window.to / begins) / (window.to - begins) * window.to /
                      log_four,
               slow = 2.0 / (1.0 + std::sqrt(begins / window.to));
  const double far = sums.far.value() / n, near = sums.near.value() / n;
  const auto covariance = [&](const ExactSum& sum, double a, double b) {
    return (sum.value() / n - a * b) / (n - 1.0);
  };
  const double far_far = covariance(sums.far_squares, far, far),
               near_near = covariance(sums.near_squares, near, near),
               far_near = covariance(sums.product, far, near);
  const auto drift = [&](const Estimate& excess, double by_fast, double by_slow) {
    const auto times = [&](double factor) {
      return Estimate{factor * excess.value, factor * excess.error};
    };
    const double size = std::fabs(excess.value);
    return Drift{times(by_fast), times(by_slow),
                 size > significant * excess.error && size * by_slow > exponent.error};
  };
  const Drift by_near = drift({near, results::root(near_near)}, fast / 4.0, slow * 0.75);
  if (by_near.seen) return by_near;
  Drift by_far = drift({far, results::root(far_far)}, fast / 20.0, slow * 0.25);
  // What was early may have died out: by 1/t a fifth of it is left later.
  const double lack = (far > 0.0 ? 1.0 : -1.0) * (far / 5.0 - near);
  const double error_of_lack = results::root(far_far / 25.0 + near_near - 0.4 * far_near);
  by_far.seen = by_far.seen && lack <= agrees * error_of_lack;
  return by_far;
}

}  // namespace carom
