#include "lanes/free/kernels.hpp"

#include "carom/base/fused_product.hpp"

namespace carom::lanes {

Kernels kernels_for(InstructionSet set, const LaneTable& table, Turn turn) {
  if (!detail::fuses) return no_kernels();
  const bool curved = table.ellipses.any;
#if defined(CAROM_WIDE_LANES)
  if (set == InstructionSet::avx512)
    return (curved ? avx512_ellipse_kernels : avx512_kernels)(table, turn);
  if (set == InstructionSet::avx2)
    return (curved ? avx2_ellipse_kernels : avx2_kernels)(table, turn);
#endif
  (void)set;
  return (curved ? baseline_ellipse_kernels : baseline_kernels)(table, turn);
}

}  // namespace carom::lanes
