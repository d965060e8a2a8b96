#include "ensemble/relax/search.hpp"

#include <gsl/gsl_blas.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_multimin.h>
#include <gsl/gsl_multiroots.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "ensemble/relax/eigen.hpp"
#include "ensemble/relax/gsl_pointer.hpp"
#include "ensemble/relax/walls.hpp"

namespace carom::ensemble {

using geometry::Vector;

namespace {

using VectorPointer = GslPointer<gsl_vector, gsl_vector_free>;

double largest(const std::vector<double>& v) {
  double size = 0.0;
  for (const double x : v) size = std::fmax(size, std::fabs(x));
  return size;
}

/// Displacements from `base`, as GSL sees them.
struct Problem {
  const Landscape& landscape;
  const Sites& base;
};
Sites at(const Problem& p, const gsl_vector* x) { return p.landscape.displaced(p.base, x->data); }

double energy_at(const gsl_vector* x, void* problem) {
  const auto& p = *static_cast<const Problem*>(problem);
  return p.landscape.energy(at(p, x));
}
void slope_at(const gsl_vector* x, void* problem, gsl_vector* slope) {
  const auto& p = *static_cast<const Problem*>(problem);
  const std::vector<double> g = p.landscape.slope(at(p, x));
  std::copy(g.begin(), g.end(), slope->data);
}
void both_at(const gsl_vector* x, void* problem, double* energy, gsl_vector* slope) {
  *energy = energy_at(x, problem);
  slope_at(x, problem, slope);
}
int slopes_at(const gsl_vector* x, void* problem, gsl_vector* slope) {
  slope_at(x, problem, slope);
  return GSL_SUCCESS;
}
int curvature_at(const gsl_vector* x, void* problem, gsl_matrix* curvature) {
  const auto& p = *static_cast<const Problem*>(problem);
  const Shape shape = p.landscape.shape(at(p, x));
  std::copy(shape.curvature.a.begin(), shape.curvature.a.end(), curvature->data);
  return GSL_SUCCESS;
}
int slopes_and_curvature_at(const gsl_vector* x, void* problem, gsl_vector* slope,
                            gsl_matrix* curvature) {
  slope_at(x, problem, slope);
  return curvature_at(x, problem, curvature);
}

/// How far the particles are from each other and from where they began: what a step is small
/// against.
double extent(const Sites& sites, const Sites& start) {
  double size = 0.0;
  for (std::size_t i = 0; i < sites.size(); ++i) {
    for (const Vector d : {sites[i].position - sites[0].position,
                           sites[i].position - start[i].position, sites[i].position})
      size = std::fmax(size, std::fmax(std::fabs(d.x), std::fabs(d.y)));
  }
  return size;
}

/// The length of what a turn about the middle moves, of several particles; of one, its way so far.
double radius(const Sites& sites, const Sites& start) {
  Vector middle{};
  for (const Site& s : sites) middle = middle + s.position;
  middle =
      sites.size() == 1 ? start[0].position : (1.0 / static_cast<double>(sites.size())) * middle;
  double square = 0.0;
  for (const Site& s : sites) square += dot(s.position - middle, s.position - middle);
  return std::sqrt(square);
}

/// Where a slope g is left, a turn of all by an angle has the curvature x g/x^2 instead of none
/// (J g = H J x). Twice its bound.
double curvature_of_turns(const Shape& shape, double radius) {
  double square = 0.0;
  for (const double g : shape.slope) square += g * g;
  return square == 0.0 ? 0.0 : 2.0 * std::sqrt(square) / radius;
}

/// Newton's step along all directions that have a curvature.
std::vector<double> newton_step(const Shape& shape, double radius) {
  const Eigen eigen = eigen_of(shape.curvature);
  std::vector<double> step(shape.slope.size(), 0.0);
  const double none = std::fmax(shape.curvature_error, curvature_of_turns(shape, radius));
  for (std::size_t k = 0; k < step.size(); ++k) {
    if (std::fabs(eigen.values[k]) <= none) continue;
    double along = 0.0;
    for (std::size_t i = 0; i < step.size(); ++i) along += eigen.vectors(k, i) * shape.slope[i];
    for (std::size_t i = 0; i < step.size(); ++i)
      step[i] -= along / eigen.values[k] * eigen.vectors(k, i);
  }
  return step;
}

constexpr int most_newton_steps = 60;
/// A slope that falls for ever looks like a line search that has to begin anew, again and again.
constexpr int most_renewals = 3;

/// Steps until they do not become smaller any more. Newton's method doubles the digits: what is
/// left after a step below the root of the rounding unit, in units of the configuration, is
/// rounding.
std::optional<Rest> refined(const Landscape& landscape, Sites sites, const Sites& start,
                            const Stopped& stopped) {
  double last = std::numeric_limits<double>::infinity();
  for (int i = 0; i < most_newton_steps; ++i) {
    if (stopped()) return {};
    Shape shape = landscape.shape(sites);
    const double around = radius(sites, start);
    const std::vector<double> step = newton_step(shape, around);
    const double length = largest(step);
    if (!std::isfinite(length)) return {};
    // Below the root of rounding the next step, about its square, is rounding alone: from there on
    // steps that no longer halve say that rounding is reached. A larger bound would only look
    // sooner.
    const bool small = length <= 0x1p-26 * extent(sites, start);
    const bool all = curvature_of_turns(shape, around) <= shape.curvature_error;
    if (length == 0.0 && !all) return {};
    if (small && all && (length == 0.0 || !(length < 0.5 * last)))
      return Rest{std::move(sites), std::move(shape), length};
    last = length;
    sites = landscape.displaced(sites, step.data());
  }
  return {};
}

/// Moves away along the steepest descent of a saddle, far enough for the minimiser to see a slope;
/// false where there is none.
bool leave_saddle(const Landscape& landscape, Sites& sites, const Shape& shape,
                  const Sites& start) {
  const Eigen eigen = eigen_of(shape.curvature);
  if (eigen.values.empty() || !(eigen.values[0] < -shape.curvature_error)) return false;
  std::vector<double> step(eigen.values.size());
  for (std::size_t i = 0; i < step.size(); ++i)
    step[i] = 0x1p-10 * radius(sites, start) * eigen.vectors(0, i);
  sites = landscape.displaced(sites, step.data());
  return true;
}

/// Runs the minimiser until slopes are small, or a particle leaves the table, which is then on its
/// wall. False where the energy has no value or falls for ever.
enum class Ended { low, at_wall, nowhere };
Ended minimise(const Landscape& landscape, const World& world, Sites& sites,
               const Stopped& stopped) {
  const std::size_t n = freedom(sites);
  if (n == 0) return Ended::low;
  const Sites base = sites;
  Problem problem{landscape, base};
  gsl_multimin_function_fdf function{energy_at, slope_at, both_at, n, &problem};
  const VectorPointer x(gsl_vector_calloc(n));
  const GslPointer<gsl_multimin_fdfminimizer, gsl_multimin_fdfminimizer_free> minimiser(
      gsl_multimin_fdfminimizer_alloc(gsl_multimin_fdfminimizer_vector_bfgs2, n));
  // The first trial step is a hundredth of what is there; 0.1: GSL's advice for its line search.
  double size = 0.0;
  for (const Site& p : base)
    size = std::fmax(size, std::fmax(std::fabs(p.position.x), std::fabs(p.position.y)));
  const double first = largest(landscape.slope(base));
  if (first == 0.0) return Ended::low;
  if (!std::isfinite(first)) return Ended::nowhere;
  gsl_multimin_fdfminimizer_set(minimiser.get(), &function, x.get(),
                                0.01 * (size > 0.0 ? size : 1.0), 0.1);
  const bool walls = !landscape.frames().empty();
  const std::size_t most = 1000 + 100 * n;
  for (std::size_t i = 0; i < most; ++i) {
    if (stopped()) return Ended::nowhere;
    const int status = gsl_multimin_fdfminimizer_iterate(minimiser.get());
    if (!std::isfinite(minimiser->f)) return Ended::nowhere;
    Sites now = at(problem, minimiser->x);
    const bool out =
        walls && (keep_inside(landscape, world, sites, now) | turn_corners(landscape, now));
    sites = std::move(now);
    if (out) return Ended::at_wall;
    // Soft directions come last: Newton's method goes on from where 1e-10 of the first slope is
    // left.
    if (status != GSL_SUCCESS || gsl_blas_dnrm2(minimiser->gradient) <= 0x1p-33 * first)
      return Ended::low;
  }
  return Ended::nowhere;
}

bool inside(const World& world, const Sites& sites) {
  return std::all_of(sites.begin(), sites.end(),
                     [&](const Site& p) { return p.wall >= 0 || world.contains(p.position); });
}

}  // namespace

std::optional<Rest> downhill(const Landscape& landscape, const World& world, Sites sites,
                             const Stopped& stopped) {
  const Sites start = sites;
  // Each particle may come to a wall and leave it some times.
  const std::size_t most = 20 + 10 * sites.size();
  double lowest = std::numeric_limits<double>::infinity();
  int renewed = 0;
  for (std::size_t i = 0; i < most; ++i) {
    const Ended ended = minimise(landscape, world, sites, stopped);
    if (ended == Ended::nowhere) return {};
    if (ended == Ended::at_wall) continue;
    std::optional<Rest> rest = refined(landscape, sites, start, stopped);
    if (!rest) {
      // The line search may come to its end far from a minimum; from there it begins anew.
      const double energy = landscape.energy(sites);
      if (stopped() || !(energy < lowest) || ++renewed > most_renewals) return {};
      lowest = energy;
      continue;
    }
    if (keep_inside(landscape, world, sites, rest->sites) | turn_corners(landscape, rest->sites)) {
      sites = rest->sites;
      continue;
    }
    sites = rest->sites;
    if (leave_saddle(landscape, sites, rest->shape, start)) continue;
    if (!release_one(landscape, sites)) return rest;
  }
  return {};
}

std::optional<Rest> level(const Landscape& landscape, const World& world, Sites sites,
                          const Stopped& stopped) {
  const Sites start = sites;
  const std::size_t n = freedom(sites);
  Problem problem{landscape, start};
  gsl_multiroot_function_fdf function{slopes_at, curvature_at, slopes_and_curvature_at, n,
                                      &problem};
  const VectorPointer x(gsl_vector_calloc(n));
  const GslPointer<gsl_multiroot_fdfsolver, gsl_multiroot_fdfsolver_free> solver(
      gsl_multiroot_fdfsolver_alloc(gsl_multiroot_fdfsolver_hybridsj, n));
  const double first = largest(landscape.slope(start));
  if (!std::isfinite(first)) return {};
  gsl_multiroot_fdfsolver_set(solver.get(), &function, x.get());
  for (std::size_t i = 0; i < 1000 + 100 * n && first > 0.0; ++i) {
    if (stopped()) return {};
    const int status = gsl_multiroot_fdfsolver_iterate(solver.get());
    if (status != GSL_SUCCESS || gsl_blas_dnrm2(solver->f) <= 0x1p-20 * first) break;
  }
  Sites end = at(problem, solver->x);
  for (const Site& s : end)
    if (!std::isfinite(s.position.x) || !std::isfinite(s.position.y)) return {};
  std::optional<Rest> rest = refined(landscape, std::move(end), start, stopped);
  if (rest && !landscape.frames().empty() && !inside(world, rest->sites)) return {};
  return rest;
}

}  // namespace carom::ensemble
