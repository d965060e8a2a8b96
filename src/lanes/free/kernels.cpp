#include "lanes/free/kernels.hpp"

#include "carom/base/fused_product.hpp"
#include "lanes/free/tangent_pack.hpp"

namespace carom::lanes {

namespace {

template <InstructionSet set>
Kernels kernels_of(const LaneTable& table, Turn turn) {
  return table.ellipses.any ? ellipse_kernels<set>(table, turn) : free_kernels<set>(table, turn);
}

void leave_all(const LaneTable&, LanePack& pack) {
  pack.calls = 0;
  for (int i = 0; i < pack.used; ++i) {
    pack.born[i] += 1.0;
    if (!(pack.active[i] > 0.0)) continue;
    pack.lane[pack.calls] = i;
    pack.call[pack.calls++] = Call::undecided;
  }
  pack.sweep += 1.0;
}

}  // namespace

Kernels no_kernels() { return {leave_all, leave_all, 1}; }

Kernels kernels_for(InstructionSet set, const LaneTable& table, Turn turn) {
  if (!detail::fuses) return no_kernels();
#if defined(CAROM_WIDE_LANES)
  if (set == InstructionSet::avx512) return kernels_of<InstructionSet::avx512>(table, turn);
  if (set == InstructionSet::avx2) return kernels_of<InstructionSet::avx2>(table, turn);
#endif
  (void)set;
  return kernels_of<InstructionSet::baseline>(table, turn);
}

TangentKernels tangent_kernels_for(InstructionSet set, const LaneTable& table, Turn turn) {
#if defined(CAROM_WIDE_LANES)
  if (set == InstructionSet::avx512) return tangent_kernels<InstructionSet::avx512>(table, turn);
  if (set == InstructionSet::avx2) return tangent_kernels<InstructionSet::avx2>(table, turn);
#endif
  (void)set;
  return tangent_kernels<InstructionSet::baseline>(table, turn);
}

}  // namespace carom::lanes
