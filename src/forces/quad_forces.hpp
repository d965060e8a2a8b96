// Forces in 34 digits, by the formulas that the documentation gives: an oracle for ForceField.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "carom/forces/force_spec.hpp"
#include "carom/forces/typed_expression.hpp"
#include "carom/geometry/lattice.hpp"
#include "carom/geometry/vector.hpp"
#include "carom/motion/state.hpp"
#include "forces/quad.hpp"

namespace carom::forces {

/// Potentials are summed from all centres; those of a lattice from all copies except for tails
/// below 1e-34 of their height. Not finite where a formula has no slope, as r has none at 0.
class QuadForces {
 public:
  using Vector = geometry::BasicVector<Quad>;

  QuadForces(const ForceSpec&, const std::vector<Particle>&,
             const std::optional<geometry::Lattice>&);

  /// Force over mass of each particle; positions anywhere in the plane. Returns the number of
  /// terms: formulas that were evaluated.
  int accelerations(std::span<const Vector> position, std::span<Vector> acceleration) const;

 private:
  struct Source {
    TypedExpression formula;  ///< of x, y
    std::vector<geometry::Vector> centers;
    double Particle::*factor;  ///< of the potential; null: 1
    double reach;              ///< on the lattice
  };
  struct PairLaw {
    TypedExpression formula;  ///< of r
    bool charged;
  };

  Vector gradient(const Source&, const Vector& x, int& terms) const;
  Vector nearest(const Vector& d) const;

  std::vector<Particle> particles_;
  std::optional<geometry::Lattice> lattice_;
  std::vector<Source> sources_;
  std::optional<PairLaw> pairs_;
};

}  // namespace carom::forces
