#include "analyses/relax/eigen.hpp"

#include <gsl/gsl_complex_math.h>
#include <gsl/gsl_eigen.h>
#include <gsl/gsl_matrix.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "carom/base/error.hpp"

namespace carom::analyses {

namespace {

using MatrixPointer = GslPointer<gsl_matrix, gsl_matrix_free>;

MatrixPointer copy_of(const Matrix& m) {
  MatrixPointer copy(gsl_matrix_alloc(m.n, m.n));
  std::copy(m.a.begin(), m.a.end(), copy->data);
  return copy;
}

/// Rest and steady motion: a frequency or growth below what rounding makes of zero is zero.
NormalMode mode_of(double growth, double frequency, double zero) {
  return {std::fabs(frequency) > zero ? std::fabs(frequency) : 0.0,
          std::fabs(growth) > zero ? growth : 0.0};
}

void sort(std::vector<NormalMode>& modes) {
  std::sort(modes.begin(), modes.end(), [](const NormalMode& a, const NormalMode& b) {
    return std::tuple(-a.frequency, a.growth) < std::tuple(-b.frequency, b.growth);
  });
}

// At a minimum, with S S = D and a = S q: (a, p)' = (S p, -S a + G p). That matrix is
// antisymmetric, so that i times it is Hermitian, whose eigenvalues are found whatever degeneracies
// there are; they come in pairs of both signs.
std::vector<NormalMode> stable_modes_in_field(const Eigen& d, const Matrix& g, double zero) {
  const std::size_t n = g.n;
  Matrix root(n);
  for (std::size_t k = 0; k < n; ++k) {
    const double size = std::sqrt(std::fmax(d.values[k], 0.0));
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) root(i, j) += size * d.vectors(k, i) * d.vectors(k, j);
  }
  const GslPointer<gsl_matrix_complex, gsl_matrix_complex_free> matrix(
      gsl_matrix_complex_calloc(2 * n, 2 * n));
  const auto set = [&](std::size_t i, std::size_t j, double value) {
    gsl_matrix_complex_set(matrix.get(), i, j, gsl_complex_rect(0.0, value));
  };
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) {
      set(i, n + j, root(i, j));
      set(n + i, j, -root(i, j));
      set(n + i, n + j, g(i, j));
    }
  const GslPointer<gsl_vector, gsl_vector_free> values(gsl_vector_alloc(2 * n));
  const GslPointer<gsl_eigen_herm_workspace, gsl_eigen_herm_free> space(
      gsl_eigen_herm_alloc(2 * n));
  if (gsl_eigen_herm(matrix.get(), values.get(), space.get()) != 0)
    throw InternalError("the eigenvalues of a minimum in a field did not converge");
  std::sort(values->data, values->data + 2 * n);
  std::vector<NormalMode> modes;
  for (std::size_t i = n; i < 2 * n; ++i) modes.push_back(mode_of(0.0, values->data[i], zero));
  sort(modes);
  return modes;
}

// With q' = p: the real matrix of (q, p)' = (p, -D q + G p), D and G by square roots of masses. Its
// eigenvalues come in pairs s, s* and, as time can be reversed with the field, s, -s*.
std::vector<NormalMode> modes_in_field(const Matrix& d, const Matrix& g, double rounding) {
  const std::size_t n = d.n;
  Matrix all(2 * n);
  double norm = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    all(i, n + i) = 1.0;
    for (std::size_t j = 0; j < n; ++j) {
      all(n + i, j) = -d(i, j);
      all(n + i, n + j) = g(i, j);
      norm = std::max({norm, std::fabs(d(i, j)), std::fabs(g(i, j))});
    }
  }
  // A double zero (a symmetry: rest and drift) is a Jordan block, which an error splits by its
  // root.
  const double zero = std::sqrt(rounding + 0x1p-52 * static_cast<double>(2 * n) * norm);
  if (const Eigen curvature = eigen_of(d); curvature.values.front() >= -rounding)
    return stable_modes_in_field(curvature, g, zero);
  const MatrixPointer matrix = copy_of(all);
  const GslPointer<gsl_eigen_nonsymm_workspace, gsl_eigen_nonsymm_free> space(
      gsl_eigen_nonsymm_alloc(2 * n));
  gsl_eigen_nonsymm_params(0, 1, space.get());  // balanced
  const GslPointer<gsl_vector_complex, gsl_vector_complex_free> values(
      gsl_vector_complex_alloc(2 * n));
  if (gsl_eigen_nonsymm(matrix.get(), values.get(), space.get()) != 0)
    throw InternalError("the eigenvalues of a saddle in a field did not converge");
  // Of each pair of equal size and opposite sign one is a mode.
  std::vector<NormalMode> both;
  for (std::size_t i = 0; i < 2 * n; ++i)
    both.push_back(mode_of(values->data[2 * i], values->data[2 * i + 1], zero));
  sort(both);
  std::vector<NormalMode> modes;
  for (std::size_t i = 0; i < both.size(); i += 2) modes.push_back(both[i]);
  for (NormalMode& m : modes) m.growth = std::fabs(m.growth);
  sort(modes);
  return modes;
}

}  // namespace

Eigen eigen_of(const Matrix& m) {
  Eigen eigen;
  eigen.vectors = Matrix(m.n);
  if (m.n == 0) return eigen;
  const MatrixPointer matrix = copy_of(m), vectors(gsl_matrix_alloc(m.n, m.n));
  const GslPointer<gsl_vector, gsl_vector_free> values(gsl_vector_alloc(m.n));
  const GslPointer<gsl_eigen_symmv_workspace, gsl_eigen_symmv_free> space(
      gsl_eigen_symmv_alloc(m.n));
  if (gsl_eigen_symmv(matrix.get(), values.get(), vectors.get(), space.get()) != 0 ||
      gsl_eigen_symmv_sort(values.get(), vectors.get(), GSL_EIGEN_SORT_VAL_ASC) != 0)
    throw InternalError("the eigenvalues of a symmetric matrix did not converge");
  for (std::size_t k = 0; k < m.n; ++k) {
    eigen.values.push_back(gsl_vector_get(values.get(), k));
    for (std::size_t i = 0; i < m.n; ++i) eigen.vectors(k, i) = gsl_matrix_get(vectors.get(), i, k);
  }
  return eigen;
}

std::vector<NormalMode> normal_modes(const Landscape& landscape, const Sites& sites,
                                     const Shape& shape) {
  const std::vector<double> masses = landscape.masses(sites);
  const std::size_t n = masses.size();
  if (n == 0) return {};
  Matrix d(n), g(n);
  const Matrix magnetic = landscape.gyroscopic(sites);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) {
      const double scale = 1.0 / std::sqrt(masses[i] * masses[j]);
      d(i, j) = scale * shape.curvature(i, j);
      g(i, j) = scale * magnetic(i, j);
    }
  const double rounding = shape.curvature_error / *std::min_element(masses.begin(), masses.end());
  if (landscape.in_field()) return modes_in_field(d, g, rounding);
  std::vector<NormalMode> modes;
  for (const double square : eigen_of(d).values) {
    const bool rests = std::fabs(square) <= rounding;
    const double size = rests ? 0.0 : std::sqrt(std::fabs(square));
    modes.push_back(square > 0.0 ? NormalMode{size, 0.0} : NormalMode{0.0, size});
  }
  sort(modes);
  return modes;
}

}  // namespace carom::analyses
