// The kernels of tables with ellipses, compiled beside the others: included once by each
// ellipse_kernel_*.cpp.
#pragma once

#include "lanes/kernel/kernel.hpp"

namespace carom::lanes {
namespace {

template <int turn>
Kernels ellipse_kernels_of(const LaneTable& t) {
  // None but ellipses; or anything.
  const bool pure = !t.segments && !t.circles && t.pieces <= LaneTable::eight;
  const Advance mixed = kernel<Kind<turn, false, true, true, Reach::all, false, true>>;
  if (t.convex && t.pieces == 1)
    return {kernel<Kind<turn, true, false, false, Reach::eight, false, true, true>>, mixed, width};
  if constexpr (turn == 0) {  // along the joints of a convex table
    return {
        pure && t.convex ? kernel<Kind<0, true, false, false, Reach::eight, false, true>> : mixed,
        mixed, width};
  } else {
    const Advance anywhere =
        pure && !t.convex ? kernel<Kind<turn, false, false, false, Reach::eight, false, true>>
                          : mixed;
    return {anywhere, anywhere, width};
  }
}

Kernels ellipse_kernels_of(const LaneTable& t, Turn turn) {
  switch (turn) {
    case Turn::clockwise:
      return ellipse_kernels_of<1>(t);
    case Turn::counter_clockwise:
      return ellipse_kernels_of<-1>(t);
    case Turn::straight:
      break;
  }
  return ellipse_kernels_of<0>(t);
}

}  // namespace
}  // namespace carom::lanes
