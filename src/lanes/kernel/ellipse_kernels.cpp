// The kernels of tables with ellipses.
#include "lanes/free/kernels.hpp"
#include "lanes/kernel/kernel.hpp"

namespace carom::lanes {
namespace {

template <bool larmor>
Kernels kernels_of(const LaneTable& t) {
  constexpr Kind any{.larmor = larmor, .segments = true, .circles = true, .ellipses = true};
  const Advance mixed = kernel<reading(any, Reach::all)>;
  if (t.convex && t.pieces == 1)
    return {kernel<Kind{
                .larmor = larmor, .convex = true, .ellipses = true, .alone = true, .single = true}>,
            mixed, width};
  const bool pure = !t.segments && !t.circles && t.pieces <= LaneTable::eight;
  if constexpr (larmor) {
    const Advance anywhere =
        pure && !t.convex ? kernel<Kind{.larmor = true, .ellipses = true}> : mixed;
    return {anywhere, anywhere, width};
  } else {  // along the joints of a convex table
    return {pure && t.convex ? kernel<Kind{.convex = true, .ellipses = true}> : mixed, mixed,
            width};
  }
}

}  // namespace

template <>
Kernels ellipse_kernels<InstructionSet::CAROM_INSTRUCTION_SET>(const LaneTable& t, Turn turn) {
  return turn == Turn::straight ? kernels_of<false>(t) : kernels_of<true>(t);
}

}  // namespace carom::lanes
