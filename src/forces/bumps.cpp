#include "forces/bumps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "base/inline.hpp"
#include "carom/base/elementary.hpp"
#include "forces/central_bounds.hpp"
#include "forces/dual.hpp"

namespace carom::forces {

using geometry::Vector;

namespace {

// Bumps are taken eight at a time. Eight running sums, added up in one fixed order at the end, make
// the result the same whatever the width of the machine's vectors.
constexpr std::size_t lanes = 8;
using Lanes [[gnu::vector_size(lanes * sizeof(double))]] = double;

CAROM_INLINE void load(Lanes& lane, const double* from) { std::memcpy(&lane, from, sizeof lane); }
CAROM_INLINE void store(const Lanes& lane, double* to) { std::memcpy(to, &lane, sizeof lane); }
double total(const Lanes& s) {
  return ((s[0] + s[1]) + (s[2] + s[3])) + ((s[4] + s[5]) + (s[6] + s[7]));
}

/// Centres in columns, filled up to a multiple of eight with bumps of weight 0.
struct Centers {
  std::vector<double> x, y, weight;
  std::size_t count;  ///< without the filling
  explicit Centers(const std::vector<Vector>& points) : count(points.size()) {
    for (const Vector& p : points) {
      x.push_back(p.x);
      y.push_back(p.y);
      weight.push_back(1.0);
    }
    while (x.size() % lanes != 0) {
      x.push_back(points.front().x);
      y.push_back(points.front().y);
      weight.push_back(0.0);
    }
  }
};

/// The largest number of bumps (a multiple of eight) whose distances are kept on the stack at a
/// time.
constexpr std::size_t batch = 64;

struct Batch {
  alignas(64) std::array<double, batch> dx, dy, r, e;
};

struct Fermi {
  BumpShape shape;
  double slope;  ///< 1 / softness
  Fermi(double radius, double softness)
      : shape{BumpShape::Kind::fermi, radius, softness, 1.0}, slope(1.0 / softness) {}

  double reach() const { return shape.radius + tail_exponent * shape.softness; }
  ForceBound bound(double height, const central::Distances& d) const {
    return central::fermi(height, shape.radius, shape.softness, d);
  }
  CAROM_VECTORISED void distances(const Centers& centers, Vector x, std::size_t from, std::size_t n,
                                  Batch& b) const {
    for (std::size_t i = 0; i < n; i += lanes) {
      Lanes cx, cy;
      load(cx, &centers.x[from + i]);
      load(cy, &centers.y[from + i]);
      const Lanes dx = x.x - cx, dy = x.y - cy;
      store(dx, &b.dx[i]);
      store(dy, &b.dy[i]);
      // The smallest normal number keeps 1/r finite at a centre, where the force has no direction.
      store(dx * dx + dy * dy + 0x1p-1022, &b.r[i]);
    }
    double* __restrict r = b.r.data();
    double* __restrict e = b.e.data();
    const double radius = shape.radius, inverse = slope;
    for (std::size_t i = 0; i < n; ++i) {
      r[i] = std::sqrt(r[i]);
      // The exponential of a bump of 1e-130 stays finite, lest 0 times infinity be no number.
      const double t = (r[i] - radius) * inverse;
      e[i] = t < 300.0 ? t : 300.0;
    }
  }
  // With q = 1/(1 + e): V = q and -dV/dr = q^2 e / softness; one division gives q and 1/r.
  CAROM_VECTORISED void sum(const Centers& centers, std::size_t from, std::size_t n, const Batch& b,
                            Lanes& value, Lanes& fx, Lanes& fy) const {
    for (std::size_t i = 0; i < n; i += lanes) {
      Lanes e, r, dx, dy, weight;
      load(e, &b.e[i]);
      load(r, &b.r[i]);
      load(dx, &b.dx[i]);
      load(dy, &b.dy[i]);
      load(weight, &centers.weight[from + i]);
      const Lanes one = 1.0 + e;
      const Lanes inverse = 1.0 / (r * one);
      const Lanes q = r * inverse;
      const Lanes f = weight * (q * q * e * (one * inverse));
      value += weight * q;
      fx += f * dx;
      fy += f * dy;
    }
  }
};

struct Gaussian {
  BumpShape shape;
  double slope;  ///< 1 / width^2
  explicit Gaussian(double width)
      : shape{BumpShape::Kind::gaussian, 0.0, 1.0, width}, slope(1.0 / (width * width)) {}

  double reach() const { return std::sqrt(2.0 * tail_exponent) * shape.width; }
  ForceBound bound(double height, const central::Distances& d) const {
    return {central::gaussian(height, shape.width, d)};
  }
  CAROM_VECTORISED void distances(const Centers& centers, Vector x, std::size_t from, std::size_t n,
                                  Batch& b) const {
    for (std::size_t i = 0; i < n; i += lanes) {
      Lanes cx, cy;
      load(cx, &centers.x[from + i]);
      load(cy, &centers.y[from + i]);
      const Lanes dx = x.x - cx, dy = x.y - cy;
      store(dx, &b.dx[i]);
      store(dy, &b.dy[i]);
      store((-0.5 * slope) * (dx * dx + dy * dy), &b.e[i]);
    }
  }
  CAROM_VECTORISED void sum(const Centers& centers, std::size_t from, std::size_t n, const Batch& b,
                            Lanes& value, Lanes& fx, Lanes& fy) const {
    for (std::size_t i = 0; i < n; i += lanes) {
      Lanes e, dx, dy, weight;
      load(e, &b.e[i]);
      load(dx, &b.dx[i]);
      load(dy, &b.dy[i]);
      load(weight, &centers.weight[from + i]);
      const Lanes g = weight * e;
      value += g;
      fx += g * dx;
      fy += g * dy;
    }
  }
};

template <class Kind>
class Bumps final : public Potential {
 public:
  Bumps(double height, const Kind& kind, const std::vector<Vector>& centers)
      : height_(height), kind_(kind), centers_(centers) {}

  /// Adds the forces of all bumps, in sums of units of each.
  double add_force(const Particle&, Vector x, Vector& force) const override {
    Lanes value{}, fx{}, fy{};
    Batch b;
    for (std::size_t from = 0; from < centers_.x.size(); from += batch) {
      const std::size_t n = std::min(batch, centers_.x.size() - from);
      kind_.distances(centers_, x, from, n, b);
      elementary::exp(std::span(b.e.data(), n));
      kind_.sum(centers_, from, n, b, value, fx, fy);
    }
    const double slope = height_ * kind_.slope;
    force.x += slope * total(fx);
    force.y += slope * total(fy);
    return height_ * total(value);
  }
  ForceBound bound(const Particle&, const Neighbourhood& n) const override {
    ForceBound sum;
    for (std::size_t i = 0; i < centers_.count; ++i)
      sum += kind_.bound(height_, central::distances(n, {centers_.x[i], centers_.y[i]}));
    return sum;
  }
  void add_hessian(const Particle&, Vector x, Hessian& hessian) const override {
    for (std::size_t i = 0; i < centers_.count; ++i)
      add_bump_hessian(kind_.shape, height_, x - Vector{centers_.x[i], centers_.y[i]}, hessian);
  }
  double reach() const override { return kind_.reach(); }
  double tail() const override { return tail_share * std::fabs(height_); }

 private:
  double height_;
  Kind kind_;
  Centers centers_;
};

}  // namespace

void add_bump_hessian(const BumpShape& shape, double height, Vector d, Hessian& hessian) {
  // The smallest normal number as in the sums: at a Fermi bump's centre the force has no direction.
  const auto square = Dual<1>::variable(dot(d, d) + 0x1p-1022, 0);
  if (shape.kind == BumpShape::Kind::gaussian) {
    const double inverse = 1.0 / (shape.width * shape.width);
    add_central(inverse * exponential(-0.5 * inverse * square), d, height, hessian);
    return;
  }
  const auto r = root(square), t = (r - shape.radius) / shape.softness;
  if (!(t.v < 300.0))
    return;  // there the bump is below 1e-130, and exp(t)^2 not much below infinity
  const auto e = exponential(t), q = 1.0 / (1.0 + e);
  add_central(q * q * e / (shape.softness * r), d, height, hessian);
}

namespace {

/// Half the distance of neighbouring lattice points.
double inner_radius(const geometry::Lattice& lattice) {
  double smallest = std::numeric_limits<double>::infinity();
  for (const geometry::CellEdge& e : lattice.edges) {
    const Vector t = lattice.translation(e.beyond);
    smallest = std::min(smallest, dot(t, t));
  }
  return 0.5 * std::sqrt(smallest);
}

}  // namespace

// Beyond its centre's neighbourhood a bump's tail is subharmonic: its value at a lattice point is
// at most its mean over a disc of radius s about it. Discs of neighbours do not overlap if s <=
// inner_radius, so the sum over the points beyond R is at most 1/(pi s^2) times the integral over r
// > R - s.
double fermi_sum_reach(double radius, double softness, const geometry::Lattice& lattice) {
  const double s = std::min(2.0 * softness, inner_radius(lattice));
  const double single = radius + tail_exponent * softness;
  // 2 softness (R - s + softness)/s^2 exp(-(R - s - radius)/softness) <= tail_share; R < 2 single +
  // s here.
  const double sum = 2.0 * softness * (2.0 * single + softness) / (s * s);
  return single + s + softness * std::max(0.0, elementary::log(sum));
}
double gaussian_sum_reach(double width, const geometry::Lattice& lattice) {
  const double s = std::min(0.5 * width, inner_radius(lattice));
  // 2 width^2/s^2 exp(-(R - s)^2/(2 width^2)) <= tail_share
  return s +
         width * std::sqrt(2.0 * (tail_exponent +
                                  std::max(0.0, elementary::log(2.0 * width * width / (s * s)))));
}

std::unique_ptr<const Potential> make_fermi_bumps(double height, double radius, double softness,
                                                  const std::vector<Vector>& centers) {
  return std::make_unique<Bumps<Fermi>>(height, Fermi(radius, softness), centers);
}
std::unique_ptr<const Potential> make_gaussian_bumps(double height, double width,
                                                     const std::vector<Vector>& centers) {
  return std::make_unique<Bumps<Gaussian>>(height, Gaussian(width), centers);
}

}  // namespace carom::forces
