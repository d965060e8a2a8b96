// Forces in 34 digits against those in doubles: two ways to one formula.
#include "forces/quad_forces.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "carom/files/system_file.hpp"
#include "carom/forces/force_field.hpp"
#include "random_tables.hpp"

namespace carom {
namespace {

using geometry::Vector;
using Kind = PotentialSpec::Kind;

constexpr Kind every_kind[] = {Kind::fermi,        Kind::harmonic,  Kind::gaussian,
                               Kind::quartic,      Kind::power,     Kind::coulomb,
                               Kind::henon_heiles, Kind::linear,    Kind::soft_circle,
                               Kind::soft_stadium, Kind::expression};

std::vector<Particle> three_particles() {
  std::vector<Particle> particles(3);
  particles[1].mass = 1.75;
  particles[1].charge = 0.625;
  particles[2].charge = 2.0;
  return particles;
}

// The accelerations of three particles at random places, both ways.
void expect_equal(const ForceSpec& spec, const std::optional<geometry::Lattice>& lattice,
                  double size, const std::string& what) {
  const std::vector<Particle> particles = three_particles();
  const auto field = ForceField::build(spec, particles, lattice);
  const forces::QuadForces quad(spec, particles, lattice);
  tests::Dice dice(1);
  for (int k = 0; k < 50; ++k) {
    std::vector<Vector> x, force(3);
    std::vector<forces::QuadForces::Vector> y, acceleration(3);
    for (int i = 0; i < 3; ++i) {
      x.push_back({dice.between(-size, size), dice.between(-size, size)});
      y.push_back({x.back().x, x.back().y});
    }
    for (std::size_t i = 0; i < 3; ++i) field->add_external(particles[i], x[i], force[i]);
    field->add_pairs(particles, x, lattice ? &*lattice : nullptr, force);
    quad.accelerations(y, acceleration);
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector a = (1.0 / particles[i].mass) * force[i];
      const Vector b{acceleration[i].x.to_double(), acceleration[i].y.to_double()};
      EXPECT_LE(length(a - b), 1e-12 * (length(b) + 1e-2))
          << what << ": " << x[i].x << " " << x[i].y;
    }
  }
}

PotentialSpec potential(Kind kind) {
  PotentialSpec s;
  s.kind = kind;
  s.height = 1.3;
  s.radius = 0.4;
  s.softness = 0.07;
  s.width = 0.3;
  s.omega_x = 0.8;
  s.omega_y = 1.4;
  s.strength = 0.9;
  s.exponent = 3.0;
  s.charge = 2.5;
  s.half_length = 0.7;
  s.force = {0.3, -1.2};
  s.centers = {{0.2, -0.1}, {-0.55, 0.35}};
  if (kind == Kind::expression)
    s.expression = std::make_shared<TypedExpression>(TypedExpression::parse(
        "x^2*sin(3*y) + cosh(x)*y^3 - log(2 + x*y*y/9) + abs(x)^2.5 + atan2(y, 3 + x) + tanh(x)",
        std::vector<std::string>{"x", "y"}, {}, {}));
  return s;
}

TEST(QuadForces, PotentialsAreThoseInDoubles) {
  for (const Kind kind : every_kind) {
    ForceSpec spec;
    spec.potentials = {potential(kind)};
    expect_equal(spec, {}, 1.5, "kind " + std::to_string(static_cast<int>(kind)));
  }
}

TEST(QuadForces, SumsOverLatticesAreThoseInDoubles) {
  const geometry::Lattice lattice = geometry::make_lattice({1.0, 0.0}, {0.5, std::sqrt(0.75)}, {});
  for (const Kind kind : {Kind::fermi, Kind::gaussian}) {
    ForceSpec spec;
    spec.potentials = {potential(kind)};
    spec.potentials[0].lattice = true;
    expect_equal(spec, lattice, 0.5, "on a lattice");
  }
}

TEST(QuadForces, InteractionsAreThoseInDoubles) {
  using Pair = InteractionSpec::Kind;
  for (const Pair kind : {Pair::coulomb, Pair::yukawa, Pair::lennard_jones, Pair::soft_sphere}) {
    ForceSpec spec;
    spec.interaction.emplace();
    spec.interaction->kind = kind;
    spec.interaction->strength = 0.7;
    spec.interaction->range = 0.9;
    spec.interaction->diameter = 0.8;
    spec.interaction->exponent = 7;
    expect_equal(spec, {}, 1.5, "interaction " + std::to_string(static_cast<int>(kind)));
  }
}

}  // namespace
}  // namespace carom
