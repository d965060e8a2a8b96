// Diffusion of an ensemble of independent trajectories.
#pragma once

#include <optional>
#include <string>

#include "carom/analyses/diffusion/free_paths.hpp"
#include "carom/analyses/diffusion/mean_square_displacement.hpp"
#include "carom/geometry/corridors.hpp"
#include "carom/results/ensemble_result.hpp"
#include "carom/results/fate_counts.hpp"
#include "carom/system/system.hpp"

namespace carom {

/// What the table says about diffusion before anything has moved; of one hard disc, the table that
/// its centre sees.
struct Horizon {
  enum class Kind {
    finite,      ///< no straight flight is free for ever, or flights are bent
    infinite,    ///< free corridors: the MSD grows faster than t, D does not exist
    bounded,     ///< the table is closed: the MSD tends to a constant
    open_plane,  ///< particles leave for good: the MSD ends as t^2
    unknown      ///< not decided for these walls, or forces act, or hard discs meet each other
  } kind = Kind::unknown;
  geometry::Corridors corridors;  ///< of a lattice, also where a field bends all flights
  double flight_tail = 0.0;       ///< limit of t P(no hit until t) at speed 1; 0 without corridors
  std::optional<double>
      machta_zwanzig;  ///< their estimate of D: triangular lattice of one disc, finite horizon
};
/// From the lattice and the walls alone; exact signs decide whether a corridor is free.
Horizon horizon_of(const System&);
/// Why there is no D, as a phrase; "" where there is one.
std::string no_diffusion(const Horizon&);

/// What a diffusion run adds up; of an interrupted one, whole trajectories. The fates are those
/// before the last report time.
struct DiffusionResult : EnsembleResult, EndCounts {
  DisplacementSums sums;
  FreePathSums free_paths;  ///< with RunPlan::free_paths
  double energy_change =
      0.0;  ///< with forces: the largest of a trajectory from its start to its end

  /// Adds another part of the same ensemble. In any order the sum is the same, bit for bit. False,
  /// and no change, where a trajectory is in both.
  bool add(const DiffusionResult& other);
};

using DiffusionJournal = EnsembleJournal<DiffusionResult>;
/// `lanes`: those that independent particles fly or are stepped in.
using DiffusionOptions = EnsembleOptions<DiffusionResult>;

/// Runs trajectories until the last report time and sums their displacements in the plane: whole
/// cells are subtracted as integers. A particle that ends earlier counts at the times before.
DiffusionResult run_diffusion(const System&, const DiffusionOptions& = {});

}  // namespace carom
