// What several analyses need.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace carom::results {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
/// The .975 quantile of the normal distribution.
constexpr double normal_quantile = 1.959963984540054;
/// Of a variance, which rounding may make negative.
inline double root(double square) { return std::sqrt(std::max(0.0, square)); }

}  // namespace carom::results
