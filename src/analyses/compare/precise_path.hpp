// One run of one scheme in 34 digits, among walls.
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "analyses/compare/orbit.hpp"
#include "carom/geometry/lattice.hpp"
#include "carom/geometry/vector.hpp"
#include "carom/integrators/scheme.hpp"
#include "carom/integrators/stepper.hpp"
#include "forces/quad.hpp"

namespace carom::analyses {

using forces::Quad;
using QuadVector = geometry::BasicVector<Quad>;

inline geometry::Vector rounded(const QuadVector& a) { return {a.x.to_double(), a.y.to_double()}; }

/// Particles, each as it is seen from its cell.
struct PrecisePlace {
  Phase<Quad> phase;
  std::vector<geometry::Cell> cells;
};

struct PreciseHit {
  int particle = 0, wall = 0;
  Quad t;
  QuadVector place;                  ///< in the plane
  double speed = 0.0, across = 0.0;  ///< before it; the part across the wall
};

struct PrecisePath {
  std::vector<Phase<Quad>> states;  ///< as Orbit::states
  std::vector<PreciseHit> hits;
  PrecisePlace end;
};

/// The particles and forces of a system, moved by a splitting scheme in 34 digits. The forces are
/// those of the documentation's formulas, the walls those of the table's curves, whose doubles are
/// exact; a hit is found as in doubles (docs/physics/walls-in-steps.md), on the scheme's own step.
class PreciseMotion {
 public:
  /// Refers to the runs.
  PreciseMotion(const Runs&, const Scheme&);
  ~PreciseMotion();

  PrecisePlace start() const;
  /// Follows `from` until t with this many equal steps in each of the parts of that time. Nothing
  /// where other walls are hit than `expected` (particles and walls in their order), where a hit
  /// grazes to rounding, where a particle is found outside, where a force has no value, and where
  /// terms() exceeds `most_terms`.
  std::optional<PrecisePath> follow(const PrecisePlace& from, const Quad& t, int steps_a_part,
                                    std::span<const ComparedHit> expected,
                                    double most_terms = std::numeric_limits<double>::infinity());
  /// Terms of forces that have been evaluated so far: what following costs.
  double terms() const;

 private:
  class Motion;
  std::unique_ptr<Motion> motion_;
};

/// Parts of a run, of the same length: states are compared at the ends of the last ones.
inline constexpr int parts = looks / looks_between_states;

}  // namespace carom::analyses
