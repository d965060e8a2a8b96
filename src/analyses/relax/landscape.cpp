#include "analyses/relax/landscape.hpp"

#include <algorithm>
#include <cmath>

#include "carom/forces/hessian.hpp"
#include "carom/starts/sampler.hpp"
#include "forces/nearest_copy.hpp"

namespace carom::analyses {

using geometry::Vector;

namespace {

double size(const Vector& v) { return std::fabs(v.x) + std::fabs(v.y); }
double size(const Hessian& h) { return std::fabs(h.xx) + std::fabs(h.xy) + std::fabs(h.yy); }

/// A term of a sum: a formula of about eight roundings.
constexpr double rounding_of_a_term = 8 * 0x1p-53;

double product(const Vector& a, const Hessian& h, const Vector& b) {
  return a.x * (h.xx * b.x + h.xy * b.y) + a.y * (h.xy * b.x + h.yy * b.y);
}

/// The directions in which a particle can move.
struct Axes {
  Vector axis[2];
  int count = 0;
};

}  // namespace

std::size_t freedom(const Sites& sites) {
  std::size_t n = 0;
  for (const Site& p : sites) n += static_cast<std::size_t>(p.freedom());
  return n;
}

Landscape::Landscape(const System& system)
    : system_(system),
      field_(*system.dynamics.forces),
      lattice_(system.table->lattice ? &*system.table->lattice : nullptr) {
  for (const Wall& wall : system.table->walls) frames_.push_back(geometry::frame_of(wall.curve));
}

Vector Landscape::in_cell(Vector x) const {
  geometry::Cell cell;
  fold_into_cell(*system_.table, x, cell);
  return x;
}

Vector Landscape::separation(Vector d) const {
  return lattice_ ? forces::nearest_copy(d, *lattice_) : d;
}

double Landscape::energy(const Sites& sites) const {
  std::vector<Vector> x;
  for (const Site& p : sites) x.push_back(in_cell(p.position));
  return field_.potential_energy(system_.particles, x, lattice_);
}

double Landscape::energy_error(const Sites& sites) const {
  const auto& particles = system_.particles;
  double sum = 0.0;
  Vector unused{};
  for (std::size_t i = 0; i < sites.size(); ++i) {
    sum += std::fabs(field_.add_external(particles[i], in_cell(sites[i].position), unused));
    for (std::size_t j = i + 1; j < sites.size(); ++j)
      sum += std::fabs(field_.add_pair(particles[i], particles[j],
                                       separation(sites[i].position - sites[j].position), unused));
  }
  // Each partial sum is rounded as well: at most one a particle, as pairs are summed by particle.
  return (rounding_of_a_term + 0x1p-52 * static_cast<double>(sites.size())) * sum;
}

std::vector<Vector> Landscape::forces(const Sites& sites) const {
  const auto& particles = system_.particles;
  std::vector<Vector> x, force(sites.size(), Vector{});
  for (const Site& p : sites) x.push_back(in_cell(p.position));
  if (field_.external())
    for (std::size_t i = 0; i < x.size(); ++i) field_.add_external(particles[i], x[i], force[i]);
  field_.add_pairs(particles, x, lattice_, force);
  return force;
}

Vector Landscape::tangent(const Site& p) const { return geometry::tangent_at(frame(p), p.u); }
Vector Landscape::normal(const Site& p) const { return geometry::normal_at(frame(p), p.u); }

namespace {

Axes axes_of(const Landscape& l, const Site& p) {
  if (p.corner) return {};
  if (p.wall >= 0) return {{l.tangent(p), {}}, 1};
  return {{{1.0, 0.0}, {0.0, 1.0}}, 2};
}

}  // namespace

std::vector<double> Landscape::slope(const Sites& sites) const {
  const std::vector<Vector> force = forces(sites);
  std::vector<double> slope;
  for (std::size_t i = 0; i < sites.size(); ++i) {
    const Axes axes = axes_of(*this, sites[i]);
    for (int k = 0; k < axes.count; ++k) slope.push_back(-dot(axes.axis[k], force[i]));
  }
  return slope;
}

// Along a wall, x'' = kappa n: the energy's second derivative is t H t - kappa F n.
Shape Landscape::shape(const Sites& sites) const {
  const auto& particles = system_.particles;
  const std::vector<Vector> force = forces(sites);
  std::vector<Axes> axes;
  std::vector<std::size_t> first;
  Shape shape;
  for (std::size_t i = 0; i < sites.size(); ++i) {
    axes.push_back(axes_of(*this, sites[i]));
    first.push_back(shape.slope.size());
    for (int k = 0; k < axes[i].count; ++k) shape.slope.push_back(-dot(axes[i].axis[k], force[i]));
  }
  shape.curvature = Matrix(shape.slope.size());
  // Sizes of all that is added in a particle's rows, and to its force.
  std::vector<double> terms(sites.size(), 0.0), pushes(sites.size(), 0.0);
  const auto add = [&](std::size_t i, std::size_t j, const Hessian& h, double sign) {
    for (int k = 0; k < axes[i].count; ++k)
      for (int l = 0; l < axes[j].count; ++l)
        shape.curvature(first[i] + static_cast<std::size_t>(k),
                        first[j] + static_cast<std::size_t>(l)) +=
            sign * product(axes[i].axis[k], h, axes[j].axis[l]);
    terms[i] += size(h);
  };
  for (std::size_t i = 0; i < sites.size(); ++i) {
    Hessian own;
    Vector push{};
    field_.add_external_hessian(particles[i], in_cell(sites[i].position), own);
    field_.add_external(particles[i], in_cell(sites[i].position), push);
    pushes[i] += size(push);
    add(i, i, own, 1.0);
    if (sites[i].freedom() == 1) {
      const double bend =
          geometry::curvature_at(frame(sites[i]), sites[i].u) * dot(force[i], normal(sites[i]));
      shape.curvature(first[i], first[i]) -= bend;
      terms[i] += std::fabs(bend);
    }
    for (std::size_t j = i + 1; field_.interacts() && j < sites.size(); ++j) {
      Hessian h;
      Vector pair{};
      const Vector d = separation(sites[i].position - sites[j].position);
      field_.add_pair_hessian(particles[i], particles[j], d, h);
      field_.add_pair(particles[i], particles[j], d, pair);
      pushes[i] += size(pair);
      pushes[j] += size(pair);
      add(i, i, h, 1.0);
      add(j, j, h, 1.0);
      add(i, j, h, -1.0);
      add(j, i, h, -1.0);
    }
  }
  // An eigenvalue moves by the norm of the error at most, which is below the largest sum of a row's
  // errors; the solver's own error is of the same size (Golub and Van Loan, section 8.3).
  const double each = rounding_of_a_term + 0x1p-52 * static_cast<double>(shape.slope.size());
  for (std::size_t i = 0; i < sites.size(); ++i) {
    // Coordinates are rounded, too: forces change with them by the curvature.
    const double far = size(sites[i].position);
    shape.curvature_error = std::fmax(shape.curvature_error, each * terms[i]);
    shape.slope_error = std::fmax(shape.slope_error, each * pushes[i] + 0x1p-52 * far * terms[i]);
  }
  return shape;
}

std::vector<double> Landscape::masses(const Sites& sites) const {
  std::vector<double> masses;
  for (std::size_t i = 0; i < sites.size(); ++i)
    for (int k = 0; k < sites[i].freedom(); ++k) masses.push_back(system_.particles[i].mass);
  return masses;
}

bool Landscape::in_field() const {
  return std::any_of(system_.particles.begin(), system_.particles.end(),
                     [](const Particle& p) { return p.omega != 0.0; });
}

// a = omega (v_y, -v_x). Along one axis the magnetic force does nothing.
Matrix Landscape::gyroscopic(const Sites& sites) const {
  Matrix g(freedom(sites));
  std::size_t row = 0;
  for (std::size_t i = 0; i < sites.size(); ++i) {
    if (sites[i].freedom() == 2) {
      const double strength = system_.particles[i].mass * system_.particles[i].omega;
      g(row, row + 1) = strength;
      g(row + 1, row) = -strength;
    }
    row += static_cast<std::size_t>(sites[i].freedom());
  }
  return g;
}

Sites Landscape::displaced(const Sites& sites, const double* by) const {
  Sites moved = sites;
  for (Site& p : moved) {
    if (p.freedom() == 2) {
      p.position = p.position + Vector{by[0], by[1]};
      by += 2;
    } else if (p.freedom() == 1) {
      const geometry::CurveFrame& f = frame(p);
      const double all = geometry::length(f);
      double s = geometry::arc_length_at(f, p.u) + *by++;
      if (f.kind == geometry::CurveFrame::Kind::closed)
        s -= all * std::floor(s / all);
      else
        p.end = s < 0.0 ? -1 : s > all ? 1 : 0;
      p.u = std::clamp(geometry::parameter_at_length(f, std::clamp(s, 0.0, all)),
                       geometry::first_parameter, f.last);
      p.position = geometry::point_at(f, p.u);
      if (p.end != 0) p.position = p.position + (p.end < 0 ? s : s - all) * tangent(p);
    }
  }
  return moved;
}

}  // namespace carom::analyses
