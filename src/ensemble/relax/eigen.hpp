// Eigenvalues of what a Landscape gives, by GSL.
#pragma once

#include <vector>

#include "carom/ensemble/relax.hpp"
#include "ensemble/relax/landscape.hpp"

namespace carom::ensemble {

/// Of a symmetric matrix: values in rising order, vectors in the rows of `vectors`.
struct Eigen {
  std::vector<double> values;
  Matrix vectors{0};
};
Eigen eigen_of(const Matrix&);

/// Small oscillations about a place without slopes.
std::vector<NormalMode> normal_modes(const Landscape&, const Sites&, const Shape&);

}  // namespace carom::ensemble
