#include "lanes/kernel/ellipse_kernels.hpp"

namespace carom::lanes {

Kernels baseline_ellipse_kernels(const LaneTable& table, Turn turn) {
  return ellipse_kernels_of(table, turn);
}

}  // namespace carom::lanes
