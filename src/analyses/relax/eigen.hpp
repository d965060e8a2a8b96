// Eigenvalues of what a Landscape gives, by GSL.
#pragma once

#include <memory>
#include <vector>

#include "analyses/relax/landscape.hpp"
#include "carom/analyses/relax.hpp"

namespace carom::analyses {

/// Of a symmetric matrix: values in rising order, vectors in the rows of `vectors`.
struct Eigen {
  std::vector<double> values;
  Matrix vectors{0};
};
Eigen eigen_of(const Matrix&);

/// Small oscillations about a place without slopes.
std::vector<NormalMode> normal_modes(const Landscape&, const Sites&, const Shape&);

template <class T, void (*release)(T*)>
struct GslRelease {
  void operator()(T* p) const { release(p); }
};
template <class T, void (*release)(T*)>
using GslPointer = std::unique_ptr<T, GslRelease<T, release>>;

}  // namespace carom::analyses
