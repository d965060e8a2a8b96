// Lyapunov exponents of an ensemble, and which of its orbits are chaotic.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "carom/analyses/lyapunov/convergence.hpp"
#include "carom/analyses/lyapunov/drift.hpp"
#include "carom/analyses/lyapunov/growth.hpp"
#include "carom/analyses/lyapunov/repeller.hpp"
#include "carom/analyses/lyapunov/spectrum.hpp"
#include "carom/base/error.hpp"
#include "carom/results/ensemble_result.hpp"
#include "carom/results/fate_counts.hpp"
#include "carom/system/system.hpp"

namespace carom {

/// What a run adds up; of an interrupted one, whole trajectories. The fates are those before the
/// end of the window.
struct LyapunovResult : EnsembleResult, EndCounts {
  using RecordFields = ExponentFields;
  /// Of the particles that were followed to the end of the window.
  GrowthSums growth;
  SpectrumSums spectrum;        ///< with RunPlan::spectrum
  ConvergenceSums convergence;  ///< of the same; without times in archives of older versions
  DriftSums drift;              ///< of the same particles; empty in archives of older versions
  DriftSums entropy_drift;      ///< with RunPlan::spectrum
  /// Where most orbits leave before the end of the window: of those that never would.
  std::optional<RepellerExponent> repeller;
  /// Why there is no `repeller` although it was looked for; not kept in archives.
  std::optional<InputError> no_repeller;

  /// Adds another part of the same ensemble. In any order the sum is the same, bit for bit. False,
  /// and no change, where a trajectory is in both.
  bool add(const LyapunovResult& other);
};

using LyapunovJournal = EnsembleJournal<LyapunovResult>;
using LyapunovOptions = EnsembleOptions<LyapunovResult>;

/// Are all particles one orbit, because they interact or their spectrum is asked for?
bool interacts(const System&);
/// The exponent at growing times, of a result.
std::vector<ExponentAt> convergence_of(const LyapunovResult&);
/// How many of the 4 N exponents vanish for certain, and by which conservation laws: those of
/// energy, of the motion of the centre of mass, and of angular momentum (docs/physics/lyapunov.md).
struct VanishingExponents {
  std::size_t count = 0;
  std::vector<std::string> laws;
};
VanishingExponents vanishing_exponents(const System&);
/// How many of them are positive, of a spectrum; else 0.
std::size_t growing_exponents(const System&);
/// Why the deviations of all orbits grow linearly, except for orbits that no random start meets, as
/// a phrase: walls that are straight, or enough conserved quantities. "": it is not known.
std::string why_all_are_regular(const System&);
/// What the sums of a run say of its system.
LyapunovEstimate estimate_of(const System&, const LyapunovResult&);
/// Particles whose spectrum is computed: the work grows as the cube of their number.
inline constexpr std::size_t most_particles_of_spectrum = 128;
/// Times between which the growth is taken: run.window, or the last four fifths of the run.
TimeWindow growth_window(const System&);

/// Of a whole ensemble that leaves through holes or into the open plane, so that fewer than half of
/// the orbits stay to the end of the window: adds `repeller`. A run does it at its end; where parts
/// of one are added up it is to be called after the last.
void add_repeller(const System&, LyapunovResult&, const SplittingOptions& = {});
/// What is wrong with a whole ensemble of which nothing could be measured; empty: nothing.
std::optional<InputError> why_nothing(const System&, const LyapunovResult&);

/// Starts that are those of the map are drawn from the flow's measure (start_measure.hpp), and do
/// not count where they meet no wall.
/// Follows two deviations along each trajectory until the end of the window, or with
/// RunPlan::spectrum a frame of 4 N: exactly where particles are free or discs, and under forces by
/// the derivative of the scheme's steps. Throws InputError for adaptive schemes, where particles
/// enter later, and for the spectrum of too many particles.
LyapunovResult run_lyapunov(const System&, const LyapunovOptions& = {});

}  // namespace carom
