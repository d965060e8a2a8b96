#include "analyses/relax/search.hpp"

#include <gsl/gsl_blas.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_multiroots.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "analyses/relax/eigen.hpp"

namespace carom::analyses {

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

void slope_at(const gsl_vector* x, void* problem, gsl_vector* slope) {
  const auto& p = *static_cast<const Problem*>(problem);
  const std::vector<double> g = p.landscape.slope(at(p, x));
  std::copy(g.begin(), g.end(), slope->data);
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

double length(const std::vector<double>& v) {
  double square = 0.0;
  for (const double x : v) square += x * x;
  return std::sqrt(square);
}

double product(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

/// The energy about a configuration to second order, along the curvature's own directions: the sum
/// of g_k p_k + curvature_k p_k^2/2.
class Model {
 public:
  explicit Model(const Shape& shape) : eigen_(eigen_of(shape.curvature)) {
    const std::size_t n = shape.slope.size();
    // Slopes that rounding could have made of none are none.
    const double none = std::sqrt(static_cast<double>(n)) * shape.slope_error;
    for (std::size_t k = 0; k < n; ++k) {
      double along = 0.0;
      for (std::size_t i = 0; i < n; ++i) along += eigen_.vectors(k, i) * shape.slope[i];
      all_slopes_.push_back(along);
      slope_.push_back(std::fabs(along) > none ? along : 0.0);
      double& curvature = eigen_.values[k];
      if (std::fabs(curvature) <= shape.curvature_error) curvature = 0.0;
    }
  }

  /// The most negative curvature, or the least.
  double lowest() const { return eigen_.values.empty() ? 0.0 : eigen_.values.front(); }
  std::vector<double> lowest_direction() const {
    std::vector<double> direction;
    for (std::size_t i = 0; i < slope_.size(); ++i) direction.push_back(eigen_.vectors(0, i));
    return direction;
  }
  /// Is there no slope and no way down?
  bool rests() const {
    return lowest() >= 0.0 &&
           std::all_of(slope_.begin(), slope_.end(), [](double g) { return g == 0.0; });
  }

  /// A displacement, and by how much the energy falls on it.
  struct Step {
    std::vector<double> by;
    double fall = 0.0, length = 0.0;
    bool newton = false;  ///< to the model's minimum
  };

  /// The lowest place within a distance: p_k = -g_k/(curvature_k + shift), with the least shift >=
  /// 0 that makes all denominators positive and p short enough (More and Sorensen 1983). Where the
  /// slope has no part along the most negative curvature p may be too short: it goes on there.
  Step lowest_within(double radius) const {
    const double least = std::fmax(0.0, -lowest());
    double shift = least, rest = 0.0;
    if (const double way = way_at(least); way <= radius) {
      if (lowest() < 0.0) rest = std::sqrt((radius - way) * (radius + way));
    } else {
      // |p| <= |g|/(shift - least).
      double low = least, high = least + carom::analyses::length(slope_) / radius;
      for (int i = 0; i < 100; ++i) {
        shift = 0.5 * (low + high);
        if (shift == low || shift == high) break;
        (way_at(shift) > radius ? low : high) = shift;
      }
      shift = high;
    }
    std::vector<double> p;
    for (std::size_t k = 0; k < slope_.size(); ++k)
      p.push_back(slope_[k] == 0.0 ? 0.0 : -slope_[k] / (eigen_.values[k] + shift));
    if (rest > 0.0) p[0] += rest;
    return along(p, shift == 0.0);
  }

  /// Newton's step along all directions that have a curvature; `certain`: and a slope that is more
  /// than rounding.
  Step newton(bool certain) const {
    const std::vector<double>& slopes = certain ? slope_ : all_slopes_;
    std::vector<double> p;
    for (std::size_t k = 0; k < slope_.size(); ++k)
      p.push_back(eigen_.values[k] == 0.0 ? 0.0 : -slopes[k] / eigen_.values[k]);
    return along(p, true);
  }

 private:
  double way_at(double shift) const {
    double square = 0.0;
    for (std::size_t k = 0; k < slope_.size(); ++k) {
      if (slope_[k] == 0.0) continue;
      const double p = slope_[k] / (eigen_.values[k] + shift);
      square += p * p;  // infinite where nothing bends
    }
    return std::sqrt(square);
  }
  Step along(const std::vector<double>& p, bool newton) const {
    Step step;
    step.newton = newton;
    step.by.assign(p.size(), 0.0);
    for (std::size_t k = 0; k < p.size(); ++k) {
      for (std::size_t i = 0; i < p.size(); ++i) step.by[i] += p[k] * eigen_.vectors(k, i);
      step.fall -= p[k] * (slope_[k] + 0.5 * eigen_.values[k] * p[k]);
    }
    step.length = carom::analyses::length(p);
    return step;
  }

  Eigen eigen_;  ///< curvatures below their rounding are 0
  std::vector<double> slope_, all_slopes_;
};

constexpr int most_newton_steps = 60;
/// Below the root of rounding, in units of the configuration, Newton's next step is about the
/// square of this one: rounding alone.
constexpr double small_step = 0x1p-26;

/// From near a place without slopes: Newton's steps until they do not become smaller any more.
/// Where the rounding of slopes leads far along a soft direction, which bends, they never do: then
/// those that are no more than rounding do not count.
std::optional<Rest> refined(const Landscape& landscape, Sites sites, const Sites& start,
                            const Stopped& stopped) {
  double last = std::numeric_limits<double>::infinity();
  for (int i = 0; i < most_newton_steps; ++i) {
    if (stopped()) return {};
    Shape shape = landscape.shape(sites);
    const bool certain = i >= most_newton_steps / 2;
    const std::vector<double> step = Model(shape).newton(certain).by;
    const double size = largest(step);
    if (!std::isfinite(size)) return {};
    // Steps that no longer halve say that rounding is reached, in what is small or without slopes.
    const bool near =
        size <= small_step * extent(sites, start) || largest(shape.slope) <= shape.slope_error;
    if (near && !(size < 0.5 * last)) return Rest{std::move(sites), std::move(shape), size};
    if (size == 0.0) {
      if (!certain && largest(shape.slope) > shape.slope_error) return {};
      return Rest{std::move(sites), std::move(shape), size};
    }
    last = size;
    sites = landscape.displaced(sites, step.data());
  }
  return {};
}

/// The way down from a start, in steps to the lowest place of the energy's second-order model
/// within a radius in which that model holds (a trust region).
class Descent {
 public:
  Descent(const Landscape& landscape, const World& world, Sites start, const Stopped& stopped)
      : landscape_(landscape), world_(world), stopped_(stopped), start_(start) {
    put(std::move(start));
    size_ = extent(start_, start_);
    if (!(size_ > 0.0)) size_ = 1.0;
    radius_ = first_radius * size_;
  }

  std::optional<Rest> run() {
    const std::size_t most = 1000 + 200 * start_.size();
    for (std::size_t i = 0; i < most && !stopped_(); ++i) {
      if (!std::isfinite(energy_) || !std::isfinite(largest(shape_.slope))) return {};
      // Where nothing holds the particles the energy falls for ever.
      if (extent(sites_, start_) > far_away * size_) return {};
      const Model model(shape_);
      const Model::Step step = model.lowest_within(radius_);
      const bool near = step.newton && largest(step.by) <= small_step * extent(sites_, start_);
      const bool spent = radius_ < 0x1p-60 * size_;  // no step lowers the energy
      if (model.rests() || near || spent) {
        std::optional<Rest> rest = refined(landscape_, sites_, start_, stopped_);
        if (rest && is_end(*rest)) {
          if (!push_off(*rest)) return rest;
          continue;
        }
        if (rest && !spent) continue;
        if (spent || model.rests()) return {};
      }
      try_step(model, step);
    }
    return {};
  }

 private:
  /// In units of the size of the start. A longer first step looks farther: with a 32nd charges in a
  /// circle do not come to their lowest minimum in 100 searches, with 1 in every twentieth.
  static constexpr double first_radius = 1.0;
  static constexpr double far_away = 0x1p40;
  static constexpr double poor = 0.25, good = 0.75;  ///< shares of the fall that the model promises

  void put(Sites sites) {
    sites_ = std::move(sites);
    energy_ = landscape_.energy(sites_);
    shape_ = landscape_.shape(sites_);
  }

  /// On top of a soft direction no straight step goes down: the valley bends, and short steps
  /// change the slope by less than its rounding. So the search goes on beside it, where the slope
  /// is seen. False: it is no such place, or the search has come back too often.
  bool push_off(const Rest& rest) {
    constexpr int most = 4;
    const Model model(rest.shape);
    if (model.lowest() >= 0.0 || pushes_ == most) return false;
    const double n = static_cast<double>(rest.shape.slope.size());
    const double seen = std::sqrt(n) * rest.shape.slope_error / -model.lowest();
    std::vector<double> aside = model.lowest_direction();
    ++pushes_;
    for (double& x : aside) x *= std::ldexp(seen, pushes_ + 1);
    put(landscape_.displaced(rest.sites, aside.data()));
    radius_ = first_radius * size_;
    return true;
  }

  /// Walls hold all that is outside. Is anything?
  bool hold(const Sites& before, Sites& now) const {
    if (landscape_.frames().empty()) return false;
    const bool kept = keep_inside(landscape_, world_, before, now);
    return turn_corners(landscape_, now) || kept;
  }

  /// No: particles left the table on the last steps, or a wall does not hold one any more. Then
  /// the search goes on from there.
  bool is_end(Rest& rest) {
    if (hold(sites_, rest.sites)) {
      put(std::move(rest.sites));
      return false;
    }
    Sites released = rest.sites;
    if (!release_one(landscape_, released, rest.shape.slope_error)) return true;
    put(std::move(released));
    return false;
  }

  void try_step(const Model& model, Model::Step step) {
    for (;;) {
      Sites there = landscape_.displaced(sites_, step.by.data());
      const bool held = hold(sites_, there);
      const double energy = landscape_.energy(there);
      Shape shape;
      double share = -1.0;  // of the fall
      const double rounding = landscape_.energy_error(sites_);
      if (std::isfinite(energy)) {
        shape = landscape_.shape(there);
        double fall = energy_ - energy;
        // A fall that is lost in rounding is seen in the slopes.
        if (!held && step.fall < 64.0 * rounding)
          fall = -0.5 * (product(shape_.slope, step.by) + product(shape.slope, step.by));
        share = held && fall >= -rounding ? 0.5 : fall / step.fall;
      }
      if (!(share > poor))
        radius_ = 0.25 * step.length;
      else if (share > good && step.length > 0.99 * radius_)
        radius_ *= 2.0;
      if (share > 0.0) {
        sites_ = std::move(there);
        energy_ = energy;
        shape_ = std::move(shape);
        return;
      }
      if (stopped_() || radius_ < 0x1p-60 * size_) return;
      step = model.lowest_within(radius_);
    }
  }

  const Landscape& landscape_;
  const World& world_;
  const Stopped& stopped_;
  const Sites start_;
  Sites sites_;
  double energy_ = 0.0, size_ = 0.0, radius_ = 0.0;
  Shape shape_;
  int pushes_ = 0;
};

bool inside(const World& world, const Sites& sites) {
  return std::all_of(sites.begin(), sites.end(),
                     [&](const Site& p) { return p.wall >= 0 || world.contains(p.position); });
}

}  // namespace

std::optional<Rest> downhill(const Landscape& landscape, const World& world, Sites start,
                             const Stopped& stopped) {
  return Descent(landscape, world, std::move(start), stopped).run();
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

}  // namespace carom::analyses
