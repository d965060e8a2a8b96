#include "lanes/kernel/kernel.hpp"

namespace carom::lanes {

Kernels avx2_kernels(const LaneTable& table, Turn turn) { return kernels_of(table, turn); }

}  // namespace carom::lanes
