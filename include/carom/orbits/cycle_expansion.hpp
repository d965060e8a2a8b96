// Escape rate and Lyapunov exponent of an open hyperbolic billiard from its periodic orbits.
#pragma once

#include <cstddef>
#include <vector>

#include "carom/orbits/periodic_orbit.hpp"

namespace carom {

/// The first zero of an expansion that is cut after a number of hits; NaN: it has none.
struct CycleOrder {
  std::size_t hits = 0;
  double spectral = 0.0;   ///< of the spectral determinant
  double dynamical = 0.0;  ///< of the dynamical zeta function
  double lambda = 0.0;     ///< the Lyapunov exponent, of the spectral determinant
};

struct CycleExpansion {
  std::vector<CycleOrder> orders;  ///< from 2 hits to the most
  double escape_rate = 0.0;        ///< per time: of the last order's spectral determinant
  double error = 0.0;              ///< how far the last order moved it: its error is smaller
  double lambda = 0.0;             ///< per time: of the orbits that never leave, by natural measure
  double lambda_error = 0.0;       ///< how far the last order moved it
};

/// Cycle expansion (P. Cvitanović et al., ChaosBook, chapters 22 and 23). `orbits` are all prime
/// orbits up to `most_hits` hits, each once except for its copies, and all hyperbolic. With the
/// period T and the tangent map M of each, and r its repeats,
///   F(gamma) = exp(- sum over orbits and r of  e^(r gamma T) z^(r hits) / (r |det(1 - M^r)|))
/// as a power series in z up to z^most_hits, at z = 1; the dynamical zeta function has |Lambda|^r
/// in place of the determinant. The escape rate is the least gamma > 0 at which it is 0.
/// With |Lambda|^(r beta) in the weights the zero moves with beta, and the Lyapunov exponent is
/// -d gamma / d beta at beta = 0 (docs/physics/periodic-orbits.md).
CycleExpansion expand_cycles(const std::vector<PeriodicOrbit>& orbits, std::size_t most_hits);

}  // namespace carom
