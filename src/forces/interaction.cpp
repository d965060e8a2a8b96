// Interactions of pairs.
#include <cmath>
#include <optional>
#include <type_traits>

#include "base/interrupt.hpp"
#include "carom/base/elementary.hpp"
#include "carom/forces/typed_expression.hpp"
#include "forces/central_bounds.hpp"
#include "forces/coulomb_pairs.hpp"
#include "forces/dual.hpp"
#include "forces/formula_bound.hpp"
#include "forces/nearest_copy.hpp"
#include "forces/potential.hpp"

namespace carom::forces {

using geometry::Vector;
using Kind = InteractionSpec::Kind;

namespace {

/// Particles from which on eight partners at a time pay.
constexpr std::size_t worth_lanes = 16;

/// `law` gives W and -W'/r at a squared distance, for unit charges where `charged`; `bound` bounds
/// the force.
template <class Law, class Bound>
class Central final : public Interaction {
 public:
  Central(Law law, Bound bound, bool charged, double reach, double tail,
          std::optional<double> coulomb_strength)
      : law_(std::move(law)),
        bound_(std::move(bound)),
        charged_(charged),
        reach_(reach),
        tail_(tail),
        coulomb_strength_(coulomb_strength) {}
  ForceBound bound(const Particle& a, const Particle& b, double distance,
                   double rho) const override {
    const ForceBound unit = bound_(central::Distances{distance, distance, rho});
    const double charges = charged_ ? std::fabs(a.charge * b.charge) : 1.0;
    return charges == 0.0 ? ForceBound{} : ForceBound{charges * unit.force, charges * unit.jump};
  }
  double add_force(const Particle& a, const Particle& b, Vector separation,
                   Vector& force) const override {
    const auto [w, over_r] = law_(dot(separation, separation));
    const double charges = charged_ ? a.charge * b.charge : 1.0;
    force = force + (charges * over_r) * separation;
    return charges * w;
  }
  void add_hessian(const Particle& a, const Particle& b, Vector separation,
                   Hessian& hessian) const override {
    const double charges = charged_ ? a.charge * b.charge : 1.0;
    add_central(law_(Dual<1>::variable(dot(separation, separation), 0)).over_r, separation, charges,
                hessian);
  }
  void add_forces(std::span<const Particle> particles, std::span<const Vector> x,
                  const geometry::Lattice* lattice, std::span<Vector> force,
                  base::Interrupt* interrupt) const override {
    if (!lattice && coulomb_strength_ && x.size() >= worth_lanes)
      return add_coulomb_pairs(*coulomb_strength_, particles, x, force, interrupt);
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (interrupt && interrupt->after(10.0 * static_cast<double>(x.size() - i))) return;
      Vector sum{};
      for (std::size_t j = i + 1; j < x.size(); ++j) {
        const Vector d = lattice ? nearest_copy(x[i] - x[j], *lattice) : x[i] - x[j];
        const double charges = charged_ ? particles[i].charge * particles[j].charge : 1.0;
        const Vector f = (charges * law_(dot(d, d)).over_r) * d;
        sum = sum + f;
        force[j] = force[j] - f;
      }
      force[i] = force[i] + sum;
    }
  }
  double energy(std::span<const Particle> particles, std::span<const Vector> x,
                const geometry::Lattice* lattice, base::Interrupt* interrupt) const override {
    if (!lattice && coulomb_strength_ && x.size() >= worth_lanes)
      return coulomb_energy(*coulomb_strength_, particles, x, interrupt);
    double all = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (interrupt && interrupt->after(10.0 * static_cast<double>(x.size() - i))) return all;
      double sum = 0.0;
      for (std::size_t j = i + 1; j < x.size(); ++j) {
        const Vector d = lattice ? nearest_copy(x[i] - x[j], *lattice) : x[i] - x[j];
        const double charges = charged_ ? particles[i].charge * particles[j].charge : 1.0;
        sum += charges * law_(dot(d, d)).value;
      }
      all += sum;
    }
    return all;
  }
  double reach() const override { return reach_; }
  double tail() const override { return tail_; }

 private:
  Law law_;
  Bound bound_;
  bool charged_;
  double reach_, tail_;
  std::optional<double>
      coulomb_strength_;  ///< of a Coulomb law, whose sums have a loop of their own
};

template <class Law, class Bound>
std::unique_ptr<const Interaction> central_law(Law law, Bound bound, bool charged, double reach,
                                               double tail,
                                               std::optional<double> coulomb_strength = {}) {
  return std::make_unique<Central<Law, Bound>>(std::move(law), std::move(bound), charged, reach,
                                               tail, coulomb_strength);
}

constexpr double everywhere = std::numeric_limits<double>::infinity();

template <class N>
struct Pair {
  N value, over_r;
};

}  // namespace

std::unique_ptr<const Interaction> make_interaction(const InteractionSpec& s) {
  switch (s.kind) {
    case Kind::coulomb:
      return central_law(
          [k = s.strength]<class N>(N r2) {
            const N inverse = 1.0 / root(r2), w = k * inverse;
            return Pair<N>{w, w * (inverse * inverse)};
          },
          [k = s.strength](const central::Distances& d) {
            return ForceBound{central::falling(k, 2.0, d), 0.0};
          },
          true, everywhere, 0.0, s.strength);
    case Kind::yukawa:
      // Beyond r the potential is below its value at the range times exp(-(r/range - 1)).
      return central_law(
          [k = s.strength, range = s.range]<class N>(N r2) {
            const N r = root(r2), inverse = 1.0 / r;
            const N w = k * inverse * exponential(-r / range);
            return Pair<N>{w, w * (inverse + 1.0 / range) * inverse};
          },
          [k = s.strength, range = s.range](const central::Distances& d) {
            const double r = d.near - d.rho;
            if (!(r > 0.0)) return ForceBound{central::none, 0.0};
            const double ratio = std::sqrt((d.near + d.rho) / r);  // of |p|/|sqrt(p q)|
            return ForceBound{
                std::fabs(k) * ratio * elementary::exp(-r / range) * (1.0 / r + 1.0 / range) / r,
                0.0};
          },
          true, (tail_exponent + 1.0) * s.range, tail_share * std::fabs(s.strength) / s.range);
    case Kind::lennard_jones:
      // (d/r)^6 = tail_share / 4 at r = d (4e16)^(1/6) < 585 d.
      return central_law(
          [e = s.depth, d2 = s.diameter * s.diameter]<class N>(N r2) {
            const N inverse = 1.0 / r2, s2 = d2 * inverse, s6 = s2 * s2 * s2;
            return Pair<N>{4.0 * e * s6 * (s6 - 1.0), 24.0 * e * s6 * (2.0 * s6 - 1.0) * inverse};
          },
          [e = s.depth, diameter = s.diameter](const central::Distances& d) {
            const double r = d.near - d.rho;
            if (!(r > 0.0)) return ForceBound{central::none, 0.0};
            const double s6 = power_by_squaring(diameter / r, 6);
            return ForceBound{24.0 * std::fabs(e) * s6 * (2.0 * s6 + 1.0) / r, 0.0};
          },
          false, 585.0 * s.diameter, tail_share * std::fabs(s.depth));
    case Kind::soft_sphere:
      return central_law(
          [k = s.strength, d = s.diameter, n = s.exponent]<class N>(N r2) {
            const N inverse = 1.0 / r2;
            const N w = n % 2 == 0 ? k * power_by_squaring<N>(d * d * inverse, n / 2)
                                   : k * power_by_squaring<N>(d * root(inverse), n);
            return Pair<N>{w, n * w * inverse};
          },
          [k = s.strength, diameter = s.diameter, n = s.exponent](const central::Distances& d) {
            const double r = d.near - d.rho;
            if (!(r > 0.0)) return ForceBound{central::none, 0.0};
            return ForceBound{std::fabs(k) * n * power_by_squaring(diameter / r, n) / r, 0.0};
          },
          false, s.diameter * elementary::exp(tail_exponent / s.exponent),
          tail_share * std::fabs(s.strength));
    case Kind::expression:
      return central_law(
          [v = s.expression]<class N>(N r2) {
            const N r = root(r2);
            const double at[] = {value_of(r)};
            double slope[1];
            if constexpr (std::is_same_v<N, double>) {
              const double w = v->value_and_gradient(at, slope);
              return Pair<N>{w, (w - w) - slope[0] / r};  // no value, no force
            } else {
              double second[1];
              const double w = v->value_gradient_and_hessian(at, slope, second);
              return Pair<N>{chain(w, slope[0], r), (w - w) - chain(slope[0], second[0], r) / r};
            }
          },
          [v = s.expression](const central::Distances& d) { return bound_of(*v, d.near, d.rho); },
          false, everywhere, 0.0);
    case Kind::hard_discs:
      break;
  }
  return nullptr;
}

}  // namespace carom::forces
