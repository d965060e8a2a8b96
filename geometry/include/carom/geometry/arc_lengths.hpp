// Arc lengths of many places on many curves.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "carom/geometry/curve_frame.hpp"

namespace carom::geometry {

/// arc_length_at of places `u`, each on the curve of this number in `frames`, lengths in the units
/// of the frames. The same bits, and less time on circles, whose angles are computed together.
std::vector<double> arc_lengths_at(std::span<const CurveFrame> frames,
                                   std::span<const std::int32_t> curve, std::span<const double> u);

}  // namespace carom::geometry
