// Second derivatives of energies.
#pragma once

namespace carom {

/// The matrix of second derivatives of an energy by x and y (energy/length^2), which is symmetric.
/// For a pair: by the separation x_a - x_b. With it, forces change by dF = -H dx.
struct Hessian {
  double xx = 0.0, xy = 0.0, yy = 0.0;
};

}  // namespace carom
