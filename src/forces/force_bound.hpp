// How large a force can be near a place, complex places included: what says how fast it changes.
//
// A displacement (dx, dy) of C^2 has the size max(|dx + i dy|, |dx - i dy|), which is the length of
// a real one. With p = x + i y and q = x - i y the square of a distance is p q, and a central
// potential V(pq) has a force of size 2 |V'| max(|p|, |q|). docs/physics/resolution.md derives the
// bounds.
#pragma once

#include "carom/geometry/vector.hpp"

namespace carom::forces {

/// All places within complex displacements of size `rho` of a real box.
struct Neighbourhood {
  geometry::Vector low, high;
  double rho = 0.0;
};

/// Bounds over a neighbourhood; infinite where there is none.
struct ForceBound {
  double force = 0.0;  ///< of the size of -grad V, on every analytic piece that reaches into it
  double jump = 0.0;  ///< of what the force changes by where two pieces meet (kinks, tips); 0 where
                      ///< it is analytic
  ForceBound& operator+=(const ForceBound& o) {
    force += o.force;
    jump += o.jump;
    return *this;
  }
};

}  // namespace carom::forces
