// Diffusion of an ensemble of independent trajectories.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "carom/analysis/mean_square_displacement.hpp"
#include "carom/ensemble/system.hpp"
#include "carom/events/decisions.hpp"
#include "carom/geometry/corridors.hpp"
#include "carom/lanes/instruction_set.hpp"

namespace carom {

/// What the table says about diffusion before anything has moved.
struct Horizon {
  enum class Kind {
    finite,      ///< no straight flight is free for ever, or flights are bent
    infinite,    ///< free corridors: the MSD grows faster than t, D does not exist
    bounded,     ///< the table is closed: the MSD ends at a constant
    open_plane,  ///< particles leave for good: the MSD ends as t^2
    unknown      ///< not decided for these walls, or forces act
  } kind = Kind::unknown;
  geometry::Corridors corridors;  ///< of a lattice, also where a field bends all flights
  double flight_tail = 0.0;       ///< limit of t P(no hit until t) at speed 1; 0 without corridors
  std::optional<double> machta_zwanzig;  ///< their estimate of D: triangular lattice of one disc, finite horizon
};
Horizon horizon_of(const System&);
/// Why there is no D, as a phrase; "" where there is one.
std::string no_diffusion(const Horizon&);

/// How to run, without influence on the result.
struct DiffusionOptions {
  int threads = 0;             ///< 0: as many as OpenMP gives
  std::uint64_t block = 1024;  ///< trajectories a block; the result does not depend on it
  DecisionOptions decisions;
  /// Instruction set of the lanes that independent particles under forces are stepped in; empty: one by one.
  std::optional<InstructionSet> lanes = widest_instruction_set();
  const std::atomic<bool>* interrupted = nullptr;
  /// Called now and then from one thread at a time with the trajectories done so far.
  std::function<void(std::uint64_t done, std::uint64_t hits)> progress;
};

/// What a diffusion run adds up.
struct DiffusionResult {
  DisplacementSums sums;
  /// Particles of all trajectories by how they ended before the last report time.
  std::uint64_t trajectories = 0, survived = 0, pinned = 0, escaped = 0, singular = 0, unbounded = 0,
                capped = 0, lost = 0;
  std::uint64_t collisions = 0;
  double energy_change = 0.0;  ///< with forces: the largest of a trajectory from its start to its end
  std::uint64_t digest = 0;
  DecisionCounts decisions;
  std::optional<InstructionSet> lanes;  ///< that were used; empty: one by one
  bool complete = true;
  double seconds = 0, cpu_seconds = 0;
  int threads = 1;
  std::vector<std::string> reports;  ///< first few states that were lost
};

/// Runs trajectories until the last report time and sums their displacements in the plane: whole cells
/// are subtracted as integers. A particle that ends earlier counts at the times before.
DiffusionResult run_diffusion(const System&, const DiffusionOptions& = {});

}  // namespace carom
