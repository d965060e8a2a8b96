// The potentials that need no sum over many centres.
#include "forces/potential.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "carom/forces/typed_expression.hpp"
#include "forces/bumps.hpp"
#include "forces/central_bounds.hpp"
#include "forces/dual.hpp"
#include "forces/formula_bound.hpp"
#include "forces/lattice_bumps.hpp"

namespace carom::forces {

using geometry::BasicVector;
using geometry::Vector;
using Kind = PotentialSpec::Kind;

namespace {

template <class N>
N square(const BasicVector<N>& a) {
  return dot(a, a);
}

/// A potential of one place, repeated at each centre. `Bound`: of its force near a place, as seen
/// from the centre.
template <class Formula, class Bound>
class AtCenters final : public Potential {
 public:
  AtCenters(Formula formula, Bound bound, std::vector<Vector> centers)
      : formula_(std::move(formula)), bound_(std::move(bound)), centers_(std::move(centers)) {}
  ForceBound bound(const Particle& p, const Neighbourhood& n) const override {
    ForceBound sum;
    for (const Vector& c : centers_) sum += bound_(p, Neighbourhood{n.low - c, n.high - c, n.rho});
    return sum;
  }
  double add_force(const Particle& p, Vector x, Vector& force) const override {
    double value = 0.0;
    for (const Vector& c : centers_) value += formula_(p, x - c, force);
    return value;
  }
  // The formula in dual numbers: the slopes of its force.
  void add_hessian(const Particle& p, Vector x, Hessian& hessian) const override {
    using Number = Dual<2>;
    for (const Vector& c : centers_) {
      BasicVector<Number> force{0.0, 0.0};
      formula_(p,
               BasicVector<Number>{Number::variable(x.x - c.x, 0), Number::variable(x.y - c.y, 1)},
               force);
      hessian.xx -= force.x.d[0];
      hessian.xy -= 0.5 * (force.x.d[1] + force.y.d[0]);  // equal except for rounding
      hessian.yy -= force.y.d[1];
    }
  }
  // A loop around the formula itself, which the compiler may turn into vectors.
  void add_forces(const Particle& p, int count, const double* __restrict x,
                  const double* __restrict y, double* __restrict force_x,
                  double* __restrict force_y) const override {
    for (const Vector& c : centers_)
      for (int i = 0; i < count; ++i) {
        Vector force{force_x[i], force_y[i]};
        formula_(p, Vector{x[i], y[i]} - c, force);
        force_x[i] = force.x;
        force_y[i] = force.y;
      }
  }

 private:
  Formula formula_;
  Bound bound_;
  std::vector<Vector> centers_;
};

template <class Formula, class Bound>
std::unique_ptr<const Potential> at_centers(Formula formula, Bound bound,
                                            const PotentialSpec& spec) {
  return std::make_unique<AtCenters<Formula, Bound>>(std::move(formula), std::move(bound),
                                                     spec.centers);
}

central::Distances from_origin(const Neighbourhood& n) { return central::distances(n, {}); }

/// More bumps than that overlap in a point only where the potential is flat.
constexpr double most_copies = 1e5;

/// The bumps of a lattice, all copies nearer than `reach`.
std::unique_ptr<const Potential> on_lattice(const PotentialSpec& s, const BumpShape& shape,
                                            const geometry::Lattice& lattice, double reach) {
  const double each = 4.0 * reach * reach / lattice.cell_area();
  if (!(each * static_cast<double>(s.centers.size()) < most_copies))
    throw InputError(s.place, "more than 100000 bumps overlap: the potential is as good as flat",
                     "a softness or width of a few cells at most");
  // The table's coarsest meshes are a quarter of the cell wide; what lies about one is listed.
  const double square =
      std::max(dot(lattice.first, lattice.first), dot(lattice.second, lattice.second));
  if (!(square / lattice.cell_area() * static_cast<double>(s.centers.size()) < most_copies))
    throw InputError(s.place,
                     "the lattice vectors are too unequal: more than 100000 bumps lie in a line "
                     "within one cell's length",
                     "vectors more alike in length");
  return make_lattice_bumps(shape, s.height, s.centers, lattice, reach);
}

/// V = h/(1 + e), e = exp((radius - r)/softness): its force points inwards along `out` = grad r.
template <class N>
N soft_wall(const PotentialSpec& s, const N& r, const BasicVector<N>& out, BasicVector<N>& force) {
  const N e = exponential((s.radius - r) / s.softness);
  const N q = 1.0 / (1.0 + e);
  // Far inside e overflows to infinity and q is 0: e q is then 1, not 0 * infinity.
  const N f = s.height / s.softness * q * (1.0 - q);
  force = force - f * out;
  return s.height * q;
}

}  // namespace

std::unique_ptr<const Potential> make_potential(const PotentialSpec& s,
                                                const std::optional<geometry::Lattice>& lattice) {
  switch (s.kind) {
    case Kind::fermi: {
      if (!s.lattice) return make_fermi_bumps(s.height, s.radius, s.softness, s.centers);
      return on_lattice(s, {BumpShape::Kind::fermi, s.radius, s.softness, 1.0}, *lattice,
                        fermi_sum_reach(s.radius, s.softness, *lattice));
    }
    case Kind::gaussian: {
      if (!s.lattice) return make_gaussian_bumps(s.height, s.width, s.centers);
      return on_lattice(s, {BumpShape::Kind::gaussian, 0.0, 1.0, s.width}, *lattice,
                        gaussian_sum_reach(s.width, *lattice));
    }
    case Kind::harmonic:
      return at_centers(
          [x2 = s.omega_x * s.omega_x, y2 = s.omega_y * s.omega_y]<class N>(
              const Particle& p, BasicVector<N> d, BasicVector<N>& force) {
            const BasicVector<N> f{p.mass * x2 * d.x, p.mass * y2 * d.y};
            force = force - f;
            return 0.5 * dot(f, d);
          },
          [most = std::max(s.omega_x * s.omega_x, s.omega_y * s.omega_y)](const Particle& p,
                                                                          const Neighbourhood& n) {
            return ForceBound{central::rising(p.mass * most, 1.0, from_origin(n)), 0.0};
          },
          s);
    case Kind::quartic:
      return at_centers(
          [k = s.strength]<class N>(const Particle&, BasicVector<N> d, BasicVector<N>& force) {
            const N r2 = square(d);
            force = force - (4.0 * k * r2) * d;
            return k * r2 * r2;
          },
          [k = s.strength](const Particle&, const Neighbourhood& n) {
            return ForceBound{central::rising(4.0 * k, 3.0, from_origin(n)), 0.0};
          },
          s);
    case Kind::power:
      return at_centers(
          [k = s.strength, n = s.exponent]<class N>(const Particle&, BasicVector<N> d,
                                                    BasicVector<N>& force) {
            const N r2 = square(d);
            // A whole even power is a product; another one goes through the logarithm.
            const double half = 0.5 * n;
            const bool whole = half == std::floor(half) && half > 0.0 && half <= 64.0;
            const N lower = whole ? power_by_squaring(r2, static_cast<int>(half) - 1)
                                  : exponential((half - 1.0) * logarithm(r2));  // r^(n - 2)
            force = force - (k * n * lower) * d;
            return k * lower * r2;
          },
          [k = s.strength, n = s.exponent](const Particle&, const Neighbourhood& about) {
            const central::Distances d = from_origin(about);
            if (n < 1.0) return ForceBound{central::falling(k * n, 1.0 - n, d), 0.0};
            const double force = central::rising(k * n, n - 1.0, d);
            const bool analytic = d.rho < d.near || 0.5 * n == std::floor(0.5 * n);
            if (analytic || n >= 2.0) return ForceBound{force, 0.0};  // a force without a jump
            return ForceBound{force, 2.0 * force};
          },
          s);
    case Kind::coulomb:
      return at_centers(
          [charge = s.charge]<class N>(const Particle& p, BasicVector<N> d, BasicVector<N>& force) {
            const N inverse = 1.0 / root(square(d));
            const N value = p.charge * charge * inverse;
            force = force + (value * inverse * inverse) * d;
            return value;
          },
          [charge = s.charge](const Particle& p, const Neighbourhood& n) {
            return ForceBound{central::falling(p.charge * charge, 2.0, from_origin(n)), 0.0};
          },
          s);
    case Kind::henon_heiles:
      return at_centers(
          []<class N>(const Particle&, BasicVector<N> d, BasicVector<N>& force) {
            const N x2 = d.x * d.x, y2 = d.y * d.y;
            force.x = force.x - (d.x + 2.0 * d.x * d.y);
            force.y = force.y - (d.y + (x2 - y2));
            return 0.5 * (x2 + y2) + d.y * (x2 - y2 / 3.0);
          },
          [](const Particle&, const Neighbourhood& n) {
            const central::Distances d = from_origin(n);
            return ForceBound{central::rising(1.0, 1.0, d) * (1.0 + d.far + d.rho),
                              0.0};  // p + i q^2
          },
          s);
    case Kind::linear:
      return at_centers(
          [f = s.force]<class N>(const Particle&, BasicVector<N> d, BasicVector<N>& force) {
            const BasicVector<N> constant{f.x, f.y};
            force = force + constant;
            return -dot(constant, d);
          },
          [size = std::sqrt(square(s.force))](const Particle&, const Neighbourhood&) {
            return ForceBound{size, 0.0};
          },
          s);
    case Kind::soft_circle:
      return at_centers(
          [s]<class N>(const Particle&, BasicVector<N> d, BasicVector<N>& force) {
            const N r = root(square(d));
            return soft_wall(s, r, value_of(r) > 0.0 ? (1.0 / r) * d : BasicVector<N>{}, force);
          },
          [s](const Particle&, const Neighbourhood& n) {
            return central::fermi(s.height, s.radius, s.softness, from_origin(n));
          },
          s);
    case Kind::soft_stadium:
      return at_centers(
          [s]<class N>(const Particle&, BasicVector<N> d, BasicVector<N>& force) {
            // From the nearest point of the segment between the caps' centres.
            const double along = value_of(d.x);
            const N beyond = along > s.half_length    ? d.x - s.half_length
                             : along < -s.half_length ? d.x + s.half_length
                                                      : N(0.0);
            const BasicVector<N> e{beyond, d.y};
            const N r = root(square(e));
            return soft_wall(s, r, value_of(r) > 0.0 ? (1.0 / r) * e : BasicVector<N>{}, force);
          },
          [s](const Particle&, const Neighbourhood& n) {
            // Distances from the segment between the caps' centres.
            const double out_x =
                std::max({n.low.x - s.half_length, -n.high.x - s.half_length, 0.0});
            const double out_y = std::max({n.low.y, -n.high.y, 0.0});
            const double far_x =
                std::max({n.high.x - s.half_length, -n.low.x - s.half_length, 0.0});
            const double far_y = std::max(n.high.y, -n.low.y);
            const central::Distances d{std::sqrt(out_x * out_x + out_y * out_y),
                                       std::sqrt(far_x * far_x + far_y * far_y), n.rho};
            return central::fermi(s.height, s.radius, s.softness, d);
          },
          s);
    case Kind::expression:
      return at_centers(
          [v = s.expression]<class N>(const Particle&, BasicVector<N> d, BasicVector<N>& force) {
            const double at[] = {value_of(d.x), value_of(d.y)};
            double gradient[2];
            if constexpr (std::is_same_v<N, double>) {
              const double value = v->value_and_gradient(at, gradient);
              // A point without a value has no force, even where its formula has one, as 1/x for
              // log(x) has.
              const double none = value - value;
              force.x -= gradient[0] + none;
              force.y -= gradient[1] + none;
              return value;
            } else {
              double second[4];
              const double value = v->value_gradient_and_hessian(at, gradient, second);
              const double none = value - value;
              force.x = force.x - chain(gradient[0] + none, second[0], d.x, second[1], d.y);
              force.y = force.y - chain(gradient[1] + none, second[2], d.x, second[3], d.y);
              return chain(value, gradient[0], d.x, gradient[1], d.y);
            }
          },
          [v = s.expression](const Particle&, const Neighbourhood& n) { return bound_of(*v, n); },
          s);
  }
  return nullptr;
}

}  // namespace carom::forces
