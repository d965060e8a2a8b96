// Periodic orbits whose existence is proven, with guaranteed digits.
#pragma once

#include <string>
#include <vector>

#include "carom/certify/certified_orbit.hpp"
#include "carom/certify/exact_system.hpp"
#include "carom/geometry/lattice.hpp"
#include "carom/geometry/vector.hpp"

namespace carom {

/// A hit of an orbit that was found in doubles, and the flight after it.
struct NearHit {
  int wall = 0;
  geometry::Vector position;  ///< in the home cell
  double u = 0.0;             ///< its parameter on the wall
  double half_turn = 0.0;     ///< half the angle that the flight turns by; 0 without field
  geometry::Cell step;        ///< cells that it crosses
};

struct CertifiedPeriodicOrbit {
  bool proven = false;
  std::string reason;  ///< why it is not
  CertifiedNumber period, length, trace;
  CertifiedNumber multiplier;         ///< the larger one; no value unless it is real
  std::vector<CertifiedNumber> x, y;  ///< of each hit
};

/// Proves that the system as it was written has one periodic orbit near these hits, and no other in
/// a box around them: the equations of docs/physics/periodic-orbits.md by an interval Newton step
/// (Krawczyk 1969), and that each flight meets no other wall before. Holes count as walls. The
/// absolute error of all numbers is below 10^-digits.
CertifiedPeriodicOrbit certify_orbit(const ExactSystem&, const std::vector<NearHit>&, int digits);

}  // namespace carom
