#include "orbits/newton.hpp"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_linalg.h>
#include <gsl/gsl_matrix.h>
#include <gsl/gsl_permutation.h>
#include <gsl/gsl_vector.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

namespace carom::orbits {

namespace {

struct Free {
  void operator()(gsl_matrix* m) const { gsl_matrix_free(m); }
  void operator()(gsl_vector* v) const { gsl_vector_free(v); }
  void operator()(gsl_permutation* p) const { gsl_permutation_free(p); }
};
using Matrix = std::unique_ptr<gsl_matrix, Free>;
using Column = std::unique_ptr<gsl_vector, Free>;
using Permutation = std::unique_ptr<gsl_permutation, Free>;

Column column(std::size_t n) { return Column(gsl_vector_alloc(n)); }

Matrix matrix_of(std::vector<double> rows, std::size_t n) {
  Matrix m(gsl_matrix_alloc(n, n));
  const gsl_matrix_const_view view = gsl_matrix_const_view_array(rows.data(), n, n);
  gsl_matrix_memcpy(m.get(), &view.matrix);
  return m;
}

double largest(const std::vector<double>& v) {
  double most = 0.0;
  for (const double x : v) most = std::max(most, std::abs(x));
  return most;
}

// What rounding may do to a singular value, and pieces in place of the curve that was written: each
// derivative is a sum of three products of rounded numbers, whose directions err as the equations
// do and whose lengths by 24 u D / l, so the matrix errs by m times that in any norm of it, and
// Golub and Reinsch's decomposition by a further m u of its norm. Curvatures stand on the diagonal
// alone, times 2 at most.
double matrix_error(const Boundary& boundary, const ChainGeometry& g,
                    const std::vector<double>& matrix, std::size_t m) {
  const double relative = 3.0 * (residual_error(boundary, g) + error_of_pieces(boundary, g)) +
                          static_cast<double>(m) * unit_roundoff;
  return static_cast<double>(m) * relative * largest(matrix) +
         2.0 * boundary.table->curve_errors.curvature;
}

// The step of Newton's: of least rank where the equations do not tell, a basic solution.
std::vector<double> newton_step(const std::vector<double>& matrix, const std::vector<double>& sides,
                                double error) {
  const std::size_t m = sides.size();
  Matrix qr = matrix_of(matrix, m);
  Column tau = column(m), right = column(m), step = column(m), rest = column(m), norm = column(m);
  Permutation order(gsl_permutation_alloc(m));
  int sign = 0;
  gsl_linalg_QRPT_decomp(qr.get(), tau.get(), order.get(), &sign, norm.get());
  std::size_t rank = 0;
  while (rank < m && std::abs(gsl_matrix_get(qr.get(), rank, rank)) > error) ++rank;
  for (std::size_t i = 0; i < m; ++i) gsl_vector_set(right.get(), i, -sides[i]);
  std::vector<double> result(m, 0.0);
  if (rank == 0) return result;
  gsl_linalg_QRPT_lssolve2(qr.get(), tau.get(), order.get(), right.get(), rank, step.get(),
                           rest.get());
  for (std::size_t i = 0; i < m; ++i) result[i] = gsl_vector_get(step.get(), i);
  return result;
}

// Singular values, in decreasing order.
std::vector<double> singular_values(const std::vector<double>& matrix, std::size_t m) {
  Matrix a = matrix_of(matrix, m), v(gsl_matrix_alloc(m, m));
  Column values = column(m), work = column(m);
  gsl_linalg_SV_decomp(a.get(), v.get(), values.get(), work.get());
  std::vector<double> result;
  for (std::size_t i = 0; i < m; ++i) result.push_back(gsl_vector_get(values.get(), i));
  return result;
}

bool legal(const Boundary& boundary, const Chain& chain, const ChainGeometry& g) {
  if (!(g.shortest > 0.0)) return false;
  if (boundary.particle.omega == 0.0) return true;
  return std::all_of(chain.begin(), chain.end(), [](const Link& link) {
    return link.half_turn > 0.0 && link.half_turn < std::numbers::pi;
  });
}

// Quadratic convergence needs five or six steps from one digit; the first ones, of limited length,
// may be more.
constexpr int most_steps = 40;

}  // namespace

std::optional<Solution> solve(const Boundary& boundary, Chain chain) {
  const std::size_t m = equations(boundary, chain);
  Solution best;
  double least = HUGE_VAL;
  for (int i = 0; i < most_steps; ++i) {
    ChainGeometry g = geometry_of(boundary, chain);
    if (!legal(boundary, chain, g)) return {};
    const std::vector<double> sides = residual(boundary, g);
    const double size = largest(sides), floor = residual_error(boundary, g);
    if (!std::isfinite(size)) return {};
    // Below what rounding makes of it, it falls no more, or by chance.
    if (least <= floor && size >= 0.5 * least) break;
    const std::vector<double> matrix = derivatives(boundary, g);
    const double error = matrix_error(boundary, g, matrix, m);
    std::vector<double> step = newton_step(matrix, sides, error);
    if (size < least) {
      least = size;
      best.chain = chain;
      best.geometry = std::move(g);
    }
    if (size <= floor + error_of_pieces(boundary, best.geometry)) {
      // Further steps would follow the rounding, or the pieces, along a family.
      const std::vector<double> values = singular_values(matrix, m);
      if (values.back() <= error) break;
    }
    // No hit moves farther than half a chord: beyond, the derivatives say nothing.
    const double longest = largest(step);
    const double factor = std::min(1.0, 0.5 * best.geometry.shortest / longest);
    if (!move(boundary, chain, step, longest > 0.0 ? factor : 0.0)) return {};
  }
  const std::vector<double> matrix = derivatives(boundary, best.geometry);
  const double error = matrix_error(boundary, best.geometry, matrix, m);
  const std::vector<double> values = singular_values(matrix, m);
  double smallest = 0.0;
  for (const double value : values) {
    if (value > error)
      smallest = value;
    else
      ++best.lost_rank;
  }
  // On pieces no member of a family fulfils the equations to rounding.
  const double floor = residual_error(boundary, best.geometry),
               pieces = error_of_pieces(boundary, best.geometry);
  if (smallest == 0.0 || !(least <= (best.lost_rank > 0 ? floor + pieces : floor))) return {};
  // Twice the step that the equations' error would make; its 2-norm bounds each unknown.
  best.error = 2.0 * std::sqrt(static_cast<double>(m)) * (least + floor + pieces) / smallest;
  return best;
}

}  // namespace carom::orbits
