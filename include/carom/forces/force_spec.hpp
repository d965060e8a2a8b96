// Forces as the system file describes them: plain data.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "carom/base/error.hpp"
#include "carom/geometry/vector.hpp"

namespace carom {

class TypedExpression;

/// An external potential ([[potential]]). r is the distance from a centre, m the particle's mass, q
/// its charge. Which numbers belong to which kind:
///   fermi         V = height / (1 + exp((r - radius)/softness))      (Bill2d, section 4.4)
///   harmonic      V = m (omega_x^2 x^2 + omega_y^2 y^2)/2
///   gaussian      V = height exp(-r^2/(2 width^2))
///   quartic       V = strength r^4
///   power         V = strength r^exponent
///   coulomb       V = q charge / r
///   henon_heiles  V = (x^2 + y^2)/2 + x^2 y - y^3/3
///   linear        V = -force . x
///   soft_circle   V = height / (1 + exp((radius - r)/softness)): a wall that gives way
///   soft_stadium  the same, r being the distance from the segment |x| <= half_length, y = 0
///   expression    V(x, y) as typed
struct PotentialSpec {
  enum class Kind {
    fermi,
    harmonic,
    gaussian,
    quartic,
    power,
    coulomb,
    henon_heiles,
    linear,
    soft_circle,
    soft_stadium,
    expression
  } kind = Kind::harmonic;
  Place place;
  double height = 1.0, radius = 1.0, softness = 0.1, width = 1.0;
  double omega_x = 1.0, omega_y = 1.0;
  double strength = 1.0, exponent = 2.0, charge = 1.0, half_length = 1.0;
  geometry::Vector force;
  std::vector<geometry::Vector> centers = {{0.0, 0.0}};
  bool lattice = false;  ///< repeated on the table's lattice
  std::shared_ptr<const TypedExpression> expression;
};

/// An interaction of pairs ([interaction]). r is their distance (Bill2d, section 2.2).
///   coulomb        W = strength q_1 q_2 / r
///   yukawa         W = strength q_1 q_2 exp(-r/range) / r
///   lennard_jones  W = 4 depth ((diameter/r)^12 - (diameter/r)^6)
///   soft_sphere    W = strength (diameter/r)^exponent, a whole exponent
///   hard_discs     no potential: contacts at the sum of the radii
///   expression     W(r) as typed
struct InteractionSpec {
  enum class Kind {
    coulomb,
    yukawa,
    lennard_jones,
    soft_sphere,
    hard_discs,
    expression
  } kind = Kind::coulomb;
  Place place;
  double strength = 1.0, range = 1.0, depth = 1.0, diameter = 1.0;
  int exponent = 12;
  std::vector<double> radii;  ///< hard discs: one a particle
  std::shared_ptr<const TypedExpression> expression;
};

/// The forces of a system, as its file gives them.
struct ForceSpec {
  std::vector<PotentialSpec> potentials;
  std::optional<InteractionSpec> interaction;
};

}  // namespace carom
