// The kernels of tables without ellipses.
#include "lanes/free/kernels.hpp"
#include "lanes/kernel/kernel.hpp"

namespace carom::lanes {
namespace {

/// Any bounded table or the open plane; `convex`: for particles on its walls.
template <bool larmor, bool convex>
Advance kernel_of(const LaneTable& t) {
  constexpr Kind any{.larmor = larmor, .convex = convex, .segments = true, .circles = true};
  if (t.pieces > LaneTable::fewest) return kernel<reading(any, Reach::all)>;
  if (t.pieces > LaneTable::eight) return kernel<reading(any, Reach::few)>;
  if (!t.circles) return kernel<Kind{.larmor = larmor, .convex = convex, .segments = true}>;
  if constexpr (!larmor) {
    if (convex && t.pieces == 1)
      return kernel<Kind{.convex = convex, .circles = true, .alone = convex, .single = convex}>;
    if (!t.segments) return kernel<Kind{.convex = convex, .circles = true}>;
  }
  return kernel<any>;
}

/// Discs of a lattice.
template <bool larmor>
Advance kernel_of_lattice(const LaneTable& t) {
  constexpr Kind discs{.larmor = larmor, .circles = true, .cells = true};
  if (larmor || t.pieces > LaneTable::eight) return kernel<reading(discs, Reach::all)>;
  if constexpr (!larmor) {
    if (t.pieces > 1) return kernel<discs>;
    if (t.next_discs)
      return kernel<Kind{.circles = true, .cells = true, .single = true, .next_disc = true}>;
    return kernel<Kind{.circles = true, .cells = true, .single = true}>;
  }
}

template <bool larmor>
Kernels kernels_of(const LaneTable& t) {
  if (t.edges > 0) {
    const Advance lattice = kernel_of_lattice<larmor>(t);
    return {lattice, lattice, width};
  }
  const Advance anywhere = kernel_of<larmor, false>(t);
  if (!(larmor ? t.convex : t.by_line)) return {anywhere, anywhere, width};
  return {kernel_of<larmor, true>(t), anywhere, width};
}

}  // namespace

template <>
Kernels free_kernels<InstructionSet::CAROM_INSTRUCTION_SET>(const LaneTable& t, Turn turn) {
  return turn == Turn::straight ? kernels_of<false>(t) : kernels_of<true>(t);
}

}  // namespace carom::lanes
