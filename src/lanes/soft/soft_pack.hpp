// Particles under forces, one a lane, one array a quantity; and the kernel that takes a step with
// all of them.
#pragma once

#include <cstddef>

#include "carom/lanes/instruction_set.hpp"
#include "events/step/barrier.hpp"
#include "forces/lattice_sum.hpp"
#include "integrators/larmor_drift.hpp"

namespace carom::lanes {

struct SoftPack {
  static constexpr int lanes = 64;

  alignas(64) double x[lanes] = {};
  double y[lanes] = {}, vx[lanes] = {}, vy[lanes] = {};
  double ax[lanes] = {}, ay[lanes] = {};  ///< accelerations at x, y, if `fresh`
  bool fresh = false;
  int count = 0;  ///< lanes in use, a multiple of eight
  double from_x[lanes] = {}, from_y[lanes] = {}, from_vx[lanes] = {},
         from_vy[lanes] = {};  ///< at the step's start
  double fastest[lanes] = {};  ///< the largest v^2 where a step began
  /// Lanes that the caller must look at after a step. `undecided`: it may meet a wall, or leads too
  /// far, or beyond all bounds. Else it has left the cell.
  int calls = 0;
  int lane[lanes] = {};
  bool undecided[lanes] = {};  ///< by lane
  bool resolved[lanes] = {};   ///< its last step ended here and resolves the forces about it
};

/// A motion of a step: the numbers of integrators/stages.hpp for the step's length.
struct SoftStage {
  enum class Kind { drift, kick, straight, turn } kind = Kind::kick;
  double duration = 0.0;
  integrators::LarmorDrift<double> drift;
};

/// What acts on the particles, and where they are put back into the cell of a lattice.
struct SoftForces {
  static constexpr int most = 8, most_edges = 6;

  int potentials = 0;
  const forces::LatticeField* lattice[most] = {};  ///< null: added by `other`
  /// Adds the force of a potential to the pack's accelerations.
  void (*other)(const SoftForces&, int potential, SoftPack&) = nullptr;
  const void* context = nullptr;  ///< for `other`
  double inverse_mass = 1.0;
  bool unit_mass = true;
  /// exp of numbers, which are a multiple of eight.
  void (*exp)(double*, std::size_t) = nullptr;

  const events::Barrier<double>* barriers = nullptr;
  int walls = 0;             ///< how many barriers there are
  double longest_way = 0.0;  ///< as Group::Surroundings

  int edges = 0;  ///< 0: there is no lattice
  double across_x[most_edges] = {}, across_y[most_edges] = {}, centre_x = 0.0, centre_y = 0.0;
};

struct SoftKernel {
  /// Accelerations at the positions.
  void (*evaluate)(const SoftForces&, SoftPack&) = nullptr;
  /// One step, by its stages.
  void (*step)(const SoftForces&, const SoftStage*, int stages, SoftPack&) = nullptr;
  /// Which lanes call after a step that took three times `third`.
  void (*find_calls)(const SoftForces&, double third, SoftPack&) = nullptr;
  int width = 0;
};

/// Defined for each instruction set that was compiled (lanes/kernel/soft_kernel.cpp).
template <InstructionSet>
SoftKernel soft_kernel();

}  // namespace carom::lanes
