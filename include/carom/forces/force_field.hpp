// Everything that acts on particles besides walls and the magnetic field.
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "carom/forces/force_spec.hpp"
#include "carom/geometry/lattice.hpp"
#include "carom/geometry/vector.hpp"
#include "carom/motion/state.hpp"

namespace carom::base {
class Interrupt;
}  // namespace carom::base

namespace carom::forces {
struct Neighbourhood;
struct ForceBound;
class Interaction;
class Potential;
}  // namespace carom::forces

namespace carom {

struct Hessian;

/// A disc outside which a potential is below its stated bound.
struct Support {
  geometry::Vector center;
  double radius = 0.0;
};

/// External potentials, superposed, and the interaction of pairs. Immutable: threads share it.
class ForceField {
 public:
  ForceField();
  ~ForceField();

  /// Nothing acts (hard discs do not act: they meet).
  bool empty() const { return !external() && !interacts(); }
  bool external() const { return !potentials_.empty(); }
  bool interacts() const { return interaction_ != nullptr; }

  /// Adds -grad V at x to `force` and returns V. On a lattice x lies in the cell, or near it.
  double add_external(const Particle&, geometry::Vector x, geometry::Vector& force) const;
  /// Adds the force on particle a to `force` and returns W; b feels the opposite, exactly.
  /// `separation` = x_a - x_b.
  double add_pair(const Particle& a, const Particle& b, geometry::Vector separation,
                  geometry::Vector& force) const;

  /// Adds the second derivatives of V at x, and those of W by the separation (forces/hessian.hpp).
  /// NaN where there are none, as at a Coulomb centre.
  void add_external_hessian(const Particle&, geometry::Vector x, Hessian&) const;
  void add_pair_hessian(const Particle& a, const Particle& b, geometry::Vector separation,
                        Hessian&) const;

  /// Adds the forces of all pairs. On a lattice a pair feels its nearest copies. Where `interrupt`
  /// says so, it stops half done.
  void add_pairs(std::span<const Particle> particles, std::span<const geometry::Vector> x,
                 const geometry::Lattice* lattice, std::span<geometry::Vector> force,
                 base::Interrupt* interrupt = nullptr) const;

  /// How large the external force can be near a place, and that of a pair whose separation is
  /// displaced by at most `rho` from one of that length: docs/physics/resolution.md.
  forces::ForceBound external_bound(const Particle&, const forces::Neighbourhood&) const;
  forces::ForceBound pair_bound(const Particle& a, const Particle& b, double distance,
                                double rho) const;
  /// Energy of all pairs, which feel each other as in add_pairs. Where `interrupt` says so, it
  /// stops half done.
  double pair_energy(std::span<const Particle> particles, std::span<const geometry::Vector> x,
                     const geometry::Lattice* lattice, base::Interrupt* interrupt = nullptr) const;

  /// The potential energy of all.
  double potential_energy(std::span<const Particle> particles, std::span<const geometry::Vector> x,
                          const geometry::Lattice* lattice) const;

  /// What it was built from.
  const ForceSpec& spec() const { return spec_; }
  const std::vector<std::unique_ptr<const forces::Potential>>& potentials() const {
    return potentials_;
  }
  /// Does some external potential reach everywhere?
  bool everywhere() const { return everywhere_; }
  /// Are all external potentials harmonic? The centre of mass of particles that turn alike then
  /// moves as one particle (Kohn 1961).
  bool harmonic() const { return harmonic_; }
  /// Are they the same in all directions about one point, about `middle` if there are any?
  bool isotropic() const { return isotropic_; }
  const std::optional<geometry::Vector>& middle() const { return middle_; }
  /// Is some external potential a typed formula, whose bounds take long?
  bool typed() const { return typed_; }
  /// Otherwise: discs, in the cell of a lattice, outside which each potential is below
  /// tail_bound().
  const std::vector<Support>& supports() const { return supports_; }
  /// Beyond it |W| is below tail_bound(); infinity for Coulomb forces and typed ones.
  double pair_range() const { return pair_range_; }
  /// Largest energy that any one potential has outside its support: 1e-16 of its height or depth.
  double tail_bound() const { return tail_bound_; }
  /// Radii of hard discs, one a particle; empty without them.
  const std::vector<double>& disc_radii() const { return disc_radii_; }

  /// Throws InputError at the place of the fault. `particles`: whose charges decide whether a
  /// Coulomb force attracts. `lattice`: the table's, if it has one.
  static std::shared_ptr<const ForceField> build(const ForceSpec&,
                                                 const std::vector<Particle>& particles,
                                                 const std::optional<geometry::Lattice>& lattice);

 private:
  ForceSpec spec_;
  std::vector<std::unique_ptr<const forces::Potential>> potentials_;
  std::unique_ptr<const forces::Interaction> interaction_;
  std::vector<Support> supports_;
  bool everywhere_ = false, typed_ = false, harmonic_ = true, isotropic_ = true;
  std::optional<geometry::Vector> middle_;
  double pair_range_ = std::numeric_limits<double>::infinity();
  double tail_bound_ = 0.0;
  std::vector<double> disc_radii_;
};

}  // namespace carom
