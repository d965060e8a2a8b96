#include "lanes/kernel.hpp"

namespace carom::lanes {

Advance avx512_kernel(const LaneTable& table) { return kernel_of(table); }
int avx512_width() { return width; }

}  // namespace carom::lanes
