#include "forces/quad_forces.hpp"

#include <cmath>
#include <map>
#include <string>

#include "carom/base/error.hpp"
#include "forces/formula_evaluation.hpp"
#include "forces/nearest_copy.hpp"

namespace carom::forces {

namespace {

using Vector = QuadForces::Vector;

/// exp(-t) = 1e-34, rounded up: the force of what is cut off is below 34 digits, also of narrow and
/// high bumps, and errors may grow.
constexpr double quad_tail_exponent = 79.0;

struct Text {
  const char* formula;
  std::map<std::string, double> parameters;
};

// Parameters meet variables before they meet each other: what is computed of parameters alone is
// rounded to a double.
Text text_of(const PotentialSpec& s) {
  using Kind = PotentialSpec::Kind;
  switch (s.kind) {
    case Kind::fermi:
      return {"h / (1 + exp((sqrt(x^2 + y^2) - R) / s))",
              {{"h", s.height}, {"R", s.radius}, {"s", s.softness}}};
    case Kind::harmonic:
      return {"((wx*x)^2 + (wy*y)^2)/2", {{"wx", s.omega_x}, {"wy", s.omega_y}}};
    case Kind::gaussian:
      return {"h*exp(-((x/w)^2 + (y/w)^2)/2)", {{"h", s.height}, {"w", s.width}}};
    case Kind::quartic:
      return {"k*(x^2 + y^2)^2", {{"k", s.strength}}};
    case Kind::power:
      return {"k*sqrt(x^2 + y^2)^n", {{"k", s.strength}, {"n", s.exponent}}};
    case Kind::coulomb:
      return {"q / sqrt(x^2 + y^2)", {{"q", s.charge}}};
    case Kind::henon_heiles:
      return {"(x^2 + y^2)/2 + x^2*y - y^3/3", {}};
    case Kind::linear:
      return {"-(fx*x + fy*y)", {{"fx", s.force.x}, {"fy", s.force.y}}};
    case Kind::soft_circle:
      return {"h / (1 + exp((R - sqrt(x^2 + y^2)) / s))",
              {{"h", s.height}, {"R", s.radius}, {"s", s.softness}}};
    case Kind::soft_stadium:
      return {"h / (1 + exp((R - sqrt(max(abs(x) - a, 0)^2 + y^2)) / s))",
              {{"h", s.height}, {"R", s.radius}, {"s", s.softness}, {"a", s.half_length}}};
    case Kind::expression:
      break;
  }
  throw InternalError("a potential without a formula");
}
Text text_of(const InteractionSpec& s) {
  using Kind = InteractionSpec::Kind;
  switch (s.kind) {
    case Kind::coulomb:
      return {"k / r", {{"k", s.strength}}};
    case Kind::yukawa:
      return {"k*exp(-r/range)/r", {{"k", s.strength}, {"range", s.range}}};
    case Kind::lennard_jones:
      return {"4*depth*((d/r)^12 - (d/r)^6)", {{"depth", s.depth}, {"d", s.diameter}}};
    case Kind::soft_sphere:
      return {"k*(d/r)^n",
              {{"k", s.strength}, {"d", s.diameter}, {"n", static_cast<double>(s.exponent)}}};
    case Kind::hard_discs:
    case Kind::expression:
      break;
  }
  throw InternalError("an interaction without a formula");
}

TypedExpression formula_of(const auto& s, const std::vector<std::string>& variables) {
  if (s.expression) return *s.expression;
  const Text text = text_of(s);
  return TypedExpression::parse(text.formula, variables, text.parameters, {});
}

double reach_of(const PotentialSpec& s) {
  return s.kind == PotentialSpec::Kind::gaussian ? s.width * std::sqrt(2.0 * quad_tail_exponent)
                                                 : s.radius + quad_tail_exponent * s.softness;
}

Vector quad(const geometry::Vector& a) { return {a.x, a.y}; }
geometry::Vector rounded(const Vector& a) { return {a.x.to_double(), a.y.to_double()}; }

Vector translation(const geometry::Cell& c, const geometry::Lattice& lattice) {
  const Quad first(static_cast<double>(c.first)), second(static_cast<double>(c.second));
  return first * quad(lattice.first) + second * quad(lattice.second);
}

}  // namespace

QuadForces::QuadForces(const ForceSpec& spec, const std::vector<Particle>& particles,
                       const std::optional<geometry::Lattice>& lattice)
    : particles_(particles), lattice_(lattice) {
  for (const PotentialSpec& s : spec.potentials) {
    using Kind = PotentialSpec::Kind;
    double Particle::*factor = s.kind == Kind::harmonic  ? &Particle::mass
                               : s.kind == Kind::coulomb ? &Particle::charge
                                                         : nullptr;
    sources_.push_back({formula_of(s, {"x", "y"}), s.centers, factor, reach_of(s)});
  }
  if (!spec.interaction || particles.size() < 2) return;
  using Kind = InteractionSpec::Kind;
  const Kind kind = spec.interaction->kind;
  if (kind != Kind::hard_discs)
    pairs_.emplace(PairLaw{formula_of(*spec.interaction, {"r"}),
                           kind == Kind::coulomb || kind == Kind::yukawa});
}

Vector QuadForces::gradient(const Source& source, const Vector& x, int& terms) const {
  using Number = Dual<2, Quad>;
  Vector sum;
  const auto add = [&](const Vector& d) {
    const Number at[] = {Number::variable(d.x, 0), Number::variable(d.y, 1)};
    const Number value = formula::run(source.formula.formula(), at);
    sum = sum + Vector{value.d[0], value.d[1]};
    ++terms;
  };
  for (const geometry::Vector& center : source.centers) {
    Vector d = x - quad(center);
    if (!lattice_) {
      add(d);
      continue;
    }
    d = nearest(d);
    const geometry::Vector about = rounded(d);
    // A lattice vector i a + j b is at least |i| area/|b| long, and |j| area/|a|.
    const double reach = source.reach + length(about), area = lattice_->cell_area();
    const auto most_first = static_cast<std::int64_t>(reach * length(lattice_->second) / area) + 1;
    const auto most_second = static_cast<std::int64_t>(reach * length(lattice_->first) / area) + 1;
    for (std::int64_t i = -most_first; i <= most_first; ++i)
      for (std::int64_t j = -most_second; j <= most_second; ++j)
        if (length(about - lattice_->translation({i, j})) <= source.reach)
          add(d - translation({i, j}, *lattice_));
  }
  return sum;
}

Vector QuadForces::nearest(const Vector& d) const {
  if (!lattice_) return d;
  return d - translation(nearest_copy_and_cell(rounded(d), *lattice_).cell, *lattice_);
}

int QuadForces::accelerations(std::span<const Vector> position,
                              std::span<Vector> acceleration) const {
  int terms = 0;
  for (std::size_t i = 0; i < position.size(); ++i) {
    Vector force;
    for (const Source& source : sources_) {
      const Quad factor = source.factor ? particles_[i].*source.factor : 1.0;
      force = force - factor * gradient(source, position[i], terms);
    }
    acceleration[i] = force;
  }
  for (std::size_t i = 0; pairs_ && i < position.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      using Number = Dual<1, Quad>;
      const Vector d = nearest(position[i] - position[j]);
      const Quad r = root(dot(d, d));
      const Number at[] = {Number::variable(r, 0)};
      const Quad slope = formula::run(pairs_->formula.formula(), at).d[0];
      const Quad charges =
          pairs_->charged ? Quad(particles_[i].charge) * Quad(particles_[j].charge) : Quad(1.0);
      const Vector force = (charges * slope / r) * d;
      ++terms;
      acceleration[i] = acceleration[i] - force;
      acceleration[j] = acceleration[j] + force;
    }
  for (std::size_t i = 0; i < position.size(); ++i)
    acceleration[i] = (Quad(1.0) / Quad(particles_[i].mass)) * acceleration[i];
  return terms;
}

}  // namespace carom::forces
