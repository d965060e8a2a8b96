#include "lanes/kernel.hpp"

namespace carom::lanes {

Advance avx2_kernel(const LaneTable& table) { return kernel_of(table); }
int avx2_width() { return width; }

}  // namespace carom::lanes
