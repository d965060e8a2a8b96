// The kernels of every instruction set that was compiled, as plain functions.
#pragma once

#include "lanes/lane_pack.hpp"

namespace carom::lanes {

Advance baseline_kernel(const LaneTable&);
Advance avx2_kernel(const LaneTable&);
Advance avx512_kernel(const LaneTable&);
int baseline_width();
int avx2_width();
int avx512_width();

}  // namespace carom::lanes
