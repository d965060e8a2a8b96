// Interactions of pairs: energy and force against 40 digits, opposite forces, ranges.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "base/interrupt.hpp"
#include "carom/forces/force_field.hpp"
#include "forces/formulas.hpp"

namespace carom {
namespace {

using geometry::Vector;
using Real = FortyDigits;
using Kind = InteractionSpec::Kind;
using Law = std::function<Real(const Real& r)>;

std::vector<Particle> pair_of_particles() {
  Particle a, b;
  a.charge = 2.0;
  b.charge = 0.75;
  b.mass = 3.0;
  return {a, b};
}

struct Case {
  const char* name;
  InteractionSpec spec;
  Law law;  // of this pair, as in the comment of InteractionSpec
  double smallest, largest;
};

std::vector<Case> cases() {
  InteractionSpec s;
  s.strength = 1.3;
  s.range = 0.4;
  s.depth = 0.7;
  s.diameter = 0.9;
  const Real k = s.strength, q = 1.5, l = s.range, e = s.depth, d = s.diameter;
  std::vector<Case> all;
  s.kind = Kind::coulomb;
  all.push_back({"coulomb", s, [=](const Real& r) { return k * q / r; }, 1e-3, 1e3});
  s.kind = Kind::yukawa;
  all.push_back({"yukawa", s, [=](const Real& r) { return k * q * exp(-r / l) / r; }, 1e-3, 15.0});
  s.kind = Kind::lennard_jones;
  all.push_back({"lennard-jones", s,
                 [=](const Real& r) { return 4 * e * (pow(d / r, 12) - pow(d / r, 6)); }, 0.5,
                 100.0});
  s.kind = Kind::soft_sphere;
  for (const int exponent : {1, 2, 9, 12, 36}) {
    s.exponent = exponent;
    all.push_back(
        {"soft-sphere", s, [=](const Real& r) { return k * pow(d / r, exponent); }, 0.3, 20.0});
  }
  s.kind = Kind::expression;
  const std::vector<std::string> variables = {"r"};
  s.expression =
      std::make_shared<TypedExpression>(TypedExpression::parse("exp(-r^2)/r", variables, {}, {}));
  all.push_back({"expression", s, [=](const Real& r) { return exp(-r * r) / r; }, 0.1, 4.0});
  return all;
}

std::shared_ptr<const ForceField> field_of(const InteractionSpec& s) {
  ForceSpec spec;
  spec.interaction = s;
  return ForceField::build(spec, pair_of_particles(), std::nullopt);
}

TEST(Interactions, EveryKindHasItsEnergiesAndForces) {
  const std::vector<Particle> p = pair_of_particles();
  for (const Case& c : cases()) {
    const auto field = field_of(c.spec);
    EXPECT_TRUE(field->interacts());
    EXPECT_FALSE(field->external());
    for (double r = c.smallest; r < c.largest; r *= 1.37) {
      const Vector separation{0.6 * r, -0.8 * r};
      const Real exact =
          sqrt(Real(separation.x) * separation.x + Real(separation.y) * separation.y);
      const Real d = exact * Real("1e-12"), slope = (c.law(exact + d) - c.law(exact - d)) / (2 * d);
      Vector force{};
      const double w = field->add_pair(p[0], p[1], separation, force);
      // Terms of both signs cancel in Lennard-Jones' law: errors count against the larger of the
      // two.
      const double size = static_cast<double>(abs(c.law(exact))) +
                          (c.spec.kind == Kind::lennard_jones ? 8.0 * std::pow(0.9 / r, 6) : 0.0);
      const double slope_size =
          static_cast<double>(abs(slope)) +
          (c.spec.kind == Kind::lennard_jones ? 48.0 * std::pow(0.9 / r, 6) / r : 0.0);
      // An exponential has the error of its argument, a power as many roundings as factors.
      double roundings = 1.0;
      if (c.spec.kind == Kind::yukawa) roundings += r / c.spec.range;
      if (c.spec.kind == Kind::expression) roundings += r * r;
      if (c.spec.kind == Kind::soft_sphere) roundings += c.spec.exponent / 8.0;
      const double tolerance = 4e-15 * roundings;
      EXPECT_LT(std::fabs(static_cast<double>(w - c.law(exact))), tolerance * size)
          << c.name << " " << r;
      EXPECT_LT(std::fabs(static_cast<double>(force.x + slope * separation.x / exact)),
                tolerance * slope_size)
          << c.name << " " << r;
      EXPECT_LT(std::fabs(static_cast<double>(force.y + slope * separation.y / exact)),
                tolerance * slope_size)
          << c.name << " " << r;
    }
  }
}

TEST(Interactions, ForcesAreOppositeToTheBit) {
  const std::vector<Particle> p = pair_of_particles();
  for (const Case& c : cases()) {
    const auto field = field_of(c.spec);
    for (double r = c.smallest; r < c.largest; r *= 1.91) {
      Vector on_a{}, on_b{};
      const Vector separation{0.28 * r, 0.96 * r};
      const double w = field->add_pair(p[0], p[1], separation, on_a);
      EXPECT_EQ(field->add_pair(p[1], p[0], {-separation.x, -separation.y}, on_b), w) << c.name;
      EXPECT_EQ(on_b, (Vector{-on_a.x, -on_a.y})) << c.name;
    }
  }
}

TEST(Interactions, AllPairsAreTheSumOfPairs) {
  std::vector<Particle> p;
  std::vector<Vector> x;
  for (int i = 0; i < 7; ++i) {
    p.emplace_back();
    p.back().charge = 1.0 + 0.25 * i;
    x.push_back({0.7 * i - 0.1 * i * i, 0.3 * i * (i % 3)});
  }
  for (const Case& c : cases()) {
    const auto field = field_of(c.spec);
    std::vector<Vector> at_once(x.size());
    field->add_pairs(p, x, nullptr, at_once);
    for (std::size_t i = 0; i < x.size(); ++i) {
      Vector sum{};
      double size = 0.0;
      for (std::size_t j = 0; j < x.size(); ++j) {
        if (i == j) continue;
        Vector one{};
        field->add_pair(p[i], p[j], x[i] - x[j], one);
        sum = sum + one;
        size += std::sqrt(dot(one, one));
      }
      EXPECT_NEAR(at_once[i].x, sum.x, 1e-15 * size) << c.name;
      EXPECT_NEAR(at_once[i].y, sum.y, 1e-15 * size) << c.name;
    }
  }
}

TEST(Interactions, EndWhereTheTailIsBelowItsBound) {
  for (const Case& c : cases()) {
    const auto field = field_of(c.spec);
    const bool finite = c.spec.kind != Kind::coulomb && c.spec.kind != Kind::expression;
    ASSERT_EQ(std::isfinite(field->pair_range()), finite) << c.name;
    if (!finite) continue;
    EXPECT_LE(abs(c.law(field->pair_range())), field->tail_bound()) << c.name;
    EXPECT_GT(abs(c.law(0.8 * field->pair_range())), field->tail_bound())
        << c.name << c.spec.exponent;
  }
}

TEST(Interactions, HardDiscsMeetAndDoNotAct) {
  InteractionSpec s;
  s.kind = Kind::hard_discs;
  s.radii = {0.25, 0.5};
  const auto field = field_of(s);
  EXPECT_TRUE(field->empty());
  EXPECT_EQ(field->disc_radii(), s.radii);
}

TEST(Interactions, AttractionWithoutBoundIsRefused) {
  std::vector<Particle> p = pair_of_particles();
  p[1].charge = -0.75;
  ForceSpec spec;
  for (const Kind kind : {Kind::coulomb, Kind::yukawa}) {
    spec.interaction.emplace();
    spec.interaction->kind = kind;
    EXPECT_THROW(ForceField::build(spec, p, std::nullopt), InputError);
    spec.interaction->strength = -1.0;
    EXPECT_NO_THROW(ForceField::build(spec, p, std::nullopt));
    EXPECT_THROW(ForceField::build(spec, {p[0], p[0]}, std::nullopt), InputError);
    EXPECT_NO_THROW(ForceField::build(spec, {p[0], Particle{.charge = 0.0}}, std::nullopt));
  }
}

// The energy of two million pairs takes longer than the ten milliseconds between two questions.
TEST(Interactions, SumsOverAllPairsStopWhereTheyAreAsked) {
  constexpr std::size_t count = 2000;
  const std::vector<Particle> particles(count);
  std::vector<Vector> x(count);
  for (std::size_t i = 0; i < count; ++i) x[i] = {static_cast<double>(i), 0.0};
  ForceSpec spec;
  spec.interaction.emplace();
  spec.interaction->kind = Kind::yukawa;
  const auto field = ForceField::build(spec, particles, std::nullopt);
  const std::function<bool()> stop = [] { return true; };
  base::Interrupt interrupt(&stop);
  const double whole = field->pair_energy(particles, x, nullptr),
               part = field->pair_energy(particles, x, nullptr, &interrupt);
  EXPECT_TRUE(interrupt.stopped());
  EXPECT_LT(part, 0.9 * whole);
}

}  // namespace
}  // namespace carom
