// Tangent maps of flights and reflections across an orbit.
#pragma once

#include <cstddef>
#include <vector>

#include "orbits/boundary.hpp"
#include "orbits/chain.hpp"

namespace carom::orbits {

/// A map of deviations across the orbit: (distance to its left, angle to its left).
struct AcrossMap {
  double a = 1.0, b = 0.0, c = 0.0, d = 1.0;

  double trace() const { return a + d; }
  /// This map after the other one.
  friend AcrossMap operator*(const AcrossMap& m, const AcrossMap& o) {
    return {m.a * o.a + m.b * o.c, m.a * o.b + m.b * o.d, m.c * o.a + m.d * o.c,
            m.c * o.b + m.d * o.d};
  }
};

/// A flight, and the reflection at its end.
struct FlightAcross {
  AcrossMap flown, reflected;
  bool beyond_half_turn = false;  ///< the flight turns by more than pi
};
std::vector<FlightAcross> flights_across(const Boundary&, const Chain&, const ChainGeometry&);

double duration_of(const Boundary&, const Link&, const ChainFlight&);

/// The tangent map of the first `flights` flights, each with the reflection after it. `sizes`, if
/// set, becomes the product of the factors' absolute values, which bounds what rounding may do.
AcrossMap tangent_map(const Boundary&, const Chain&, const ChainGeometry&, std::size_t flights,
                      AcrossMap* sizes = nullptr);

/// The eigenvalue of largest size of a map of determinant 1 with that trace; NaN where they are
/// complex.
double leading_multiplier(double trace);

}  // namespace carom::orbits
