// One external potential, or one kind of interaction: a value and its force.
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <span>

#include "carom/forces/force_field.hpp"
#include "carom/forces/hessian.hpp"
#include "forces/force_bound.hpp"

namespace carom::forces {

struct LatticeField;

/// The share of its height below which a potential is cut off.
inline constexpr double tail_share = 1e-16;

class Potential {
 public:
  virtual ~Potential() = default;
  /// Adds -grad V to `force`, returns V.
  virtual double add_force(const Particle&, geometry::Vector x, geometry::Vector& force) const = 0;
  /// The same forces on many particles alike, to the bit: columns of `count` numbers.
  virtual void add_forces(const Particle& p, int count, const double* x, const double* y,
                          double* force_x, double* force_y) const {
    for (int i = 0; i < count; ++i) {
      geometry::Vector force{force_x[i], force_y[i]};
      add_force(p, {x[i], y[i]}, force);
      force_x[i] = force.x;
      force_y[i] = force.y;
    }
  }
  /// Adds the second derivatives of V.
  virtual void add_hessian(const Particle&, geometry::Vector x, Hessian&) const = 0;
  /// How large the force can be near a place.
  virtual ForceBound bound(const Particle&, const Neighbourhood&) const = 0;
  /// Distance from a centre beyond which |V| is below `tail`; infinity if there is none.
  virtual double reach() const { return std::numeric_limits<double>::infinity(); }
  virtual double tail() const { return 0.0; }
  /// The table that add_force sums, for callers that sum it for many points at once; null if there
  /// is none.
  virtual const LatticeField* lattice_field() const { return nullptr; }
};

class Interaction {
 public:
  virtual ~Interaction() = default;
  /// Adds the force on a to `force`, returns W.
  virtual double add_force(const Particle& a, const Particle& b, geometry::Vector separation,
                           geometry::Vector& force) const = 0;
  /// Adds the second derivatives of W by the separation.
  virtual void add_hessian(const Particle& a, const Particle& b, geometry::Vector separation,
                           Hessian&) const = 0;
  /// The same forces for all pairs at once; half done where `interrupt`, if there is one, says so.
  virtual void add_forces(std::span<const Particle>, std::span<const geometry::Vector> x,
                          const geometry::Lattice*, std::span<geometry::Vector> force,
                          base::Interrupt* interrupt) const = 0;
  /// How large the force of a pair can be whose separation is displaced by at most `rho` from one
  /// of that length.
  virtual ForceBound bound(const Particle& a, const Particle& b, double distance,
                           double rho) const = 0;
  /// The sum of W over all pairs.
  virtual double energy(std::span<const Particle>, std::span<const geometry::Vector> x,
                        const geometry::Lattice*, base::Interrupt* interrupt = nullptr) const = 0;
  virtual double reach() const { return std::numeric_limits<double>::infinity(); }
  virtual double tail() const { return 0.0; }
};

std::unique_ptr<const Potential> make_potential(const PotentialSpec&,
                                                const std::optional<geometry::Lattice>&);
std::unique_ptr<const Interaction> make_interaction(const InteractionSpec&);

/// The t at which exp(-t) = tail_share, rounded up.
inline constexpr double tail_exponent = 36.85;

}  // namespace carom::forces
