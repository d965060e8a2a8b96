#include "lanes/kernel/kernel.hpp"

namespace carom::lanes {

Kernels baseline_kernels(const LaneTable& table, Turn turn) { return kernels_of(table, turn); }

}  // namespace carom::lanes
