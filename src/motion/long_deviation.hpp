// The size at which deviations are made short again.
#pragma once

namespace carom::motion {

/// One hit may stretch by 2^53 and more where it grazes: this is far from the largest double, and
/// is taken out of deviations that are longer.
inline constexpr double long_deviation = 0x1p200;
inline constexpr double log_of_long_deviation = 200 * 0.6931471805599453;

}  // namespace carom::motion
