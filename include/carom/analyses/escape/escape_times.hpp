// Times of escape in fine bins.
#pragma once

#include "carom/results/binary_bins.hpp"

namespace carom {

/// Numbers of escapes in bins of time, 64 bins to a factor of two.
using EscapeTimes = BinaryBins<6>;

}  // namespace carom
