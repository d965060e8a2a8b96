// The kernels of every instruction set that was compiled, as plain functions.
#pragma once

#include "carom/lanes/instruction_set.hpp"
#include "lanes/free/lane_pack.hpp"

namespace carom::lanes {

/// How all particles of a run turn.
enum class Turn : signed char {
  counter_clockwise = -1,
  straight = 0,
  clockwise = 1
};  // the sign of omega

struct Kernels {
  Advance on_walls;  ///< for particles that stand on a wall; in straight flights also for others
  Advance anywhere;
  int width;  ///< lanes that are flown together
};
/// Of tables without ellipses, and of tables with some: defined for each instruction set that was
/// compiled (lanes/kernel/).
template <InstructionSet>
Kernels free_kernels(const LaneTable&, Turn);
template <InstructionSet>
Kernels ellipse_kernels(const LaneTable&, Turn);
/// Where products cannot be fused by an instruction: every flight is left to the scalar engine.
Kernels no_kernels();

/// The kernels of an instruction set for this table.
Kernels kernels_for(InstructionSet, const LaneTable&, Turn);

}  // namespace carom::lanes
