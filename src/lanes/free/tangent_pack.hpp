// Deviations across the orbits of lanes, one array a quantity, indexed by lane; and the kernels
// that carry them over the flight and the hit of a sweep: motion::FreeTangent::hit, lane by lane.
#pragma once

#include "carom/lanes/instruction_set.hpp"
#include "lanes/free/kernels.hpp"

namespace carom::lanes {

/// WallForm of each piece.
struct TangentTable {
  double center_x[LaneTable::most] = {}, center_y[LaneTable::most] = {}, xx[LaneTable::most] = {},
         xy[LaneTable::most] = {}, yy[LaneTable::most] = {}, determinant[LaneTable::most] = {},
         normal_x[LaneTable::most] = {}, normal_y[LaneTable::most] = {};
  double lattice_x[2] = {}, lattice_y[2] = {};
  int pieces = 0;
};

struct TangentPack {
  static constexpr int lanes = LanePack::lanes;

  alignas(LanePack::alignment) double place[2][lanes] = {};
  double rate[2][lanes] = {};
  double shrunk[2][lanes] = {};
  double hits[lanes] = {};  ///< that they are carried over
  // After the last of these.
  double high[lanes] = {}, low[lanes] = {}, x[lanes] = {}, y[lanes] = {}, vx[lanes] = {},
         vy[lanes] = {}, first[lanes] = {}, second[lanes] = {};
  // Constants of the particle.
  double square[lanes] = {}, inverse_square[lanes] = {}, omega[lanes] = {}, unit[lanes] = {};
  double mark[lanes] = {};  ///< time at which its lengths are asked for next
};

struct TangentKernels {
  /// A bit for each lane that has hit a wall after its mark.
  unsigned long long (*due)(const LanePack&, const TangentPack&) = nullptr;
  void (*carry)(const TangentTable&, const LanePack&, TangentPack&) = nullptr;
};
/// Defined for each instruction set that was compiled (lanes/kernel/).
template <InstructionSet>
TangentKernels tangent_kernels(const LaneTable&, Turn);
/// Those of an instruction set for this table.
TangentKernels tangent_kernels_for(InstructionSet, const LaneTable&, Turn);

}  // namespace carom::lanes
