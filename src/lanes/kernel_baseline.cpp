#include "lanes/kernel.hpp"

namespace carom::lanes {

Advance baseline_kernel(const LaneTable& table) { return kernel_of(table); }
int baseline_width() { return width; }

}  // namespace carom::lanes
