// External potentials: values and forces against 40 digits, sums over lattices, supports.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>

#include "carom/files/system_file.hpp"
#include "carom/forces/force_field.hpp"
#include "forces/bumps.hpp"
#include "forces/copies.hpp"
#include "forces/formulas.hpp"

namespace carom {

using namespace forces;

namespace {

using geometry::Vector;
using Real = FortyDigits;
using Kind = PotentialSpec::Kind;

using Potential40 = std::function<Real(const Real& x, const Real& y)>;

Particle heavy() {
  Particle p;
  p.mass = 1.75;
  p.charge = 0.625;
  return p;
}

PotentialSpec spec_of(Kind kind) {
  PotentialSpec s;
  s.kind = kind;
  s.height = 1.3;
  s.radius = kind == Kind::fermi ? 0.4 : 1.1;
  s.softness = 0.07;
  s.width = 0.6;
  s.omega_x = 0.8;
  s.omega_y = 1.4;
  s.strength = 0.9;
  s.exponent = 3.0;
  s.charge = 2.5;
  s.half_length = 0.7;
  s.force = {0.3, -1.2};
  s.centers = {{0.2, -0.1}, {-0.55, 0.35}, {1.5, 1.25}};
  return s;
}

/// The same potential about the origin, written down a second time.
Potential40 formula40(const PotentialSpec& s) {
  const Real h = s.height, a = s.radius, sigma = s.softness, w = s.width, k = s.strength;
  const Real m = heavy().mass, q = heavy().charge;
  const auto r = [](const Real& x, const Real& y) { return sqrt(x * x + y * y); };
  switch (s.kind) {
    case Kind::fermi:
      return [=](const Real& x, const Real& y) { return h / (1 + exp((r(x, y) - a) / sigma)); };
    case Kind::gaussian:
      return [=](const Real& x, const Real& y) { return h * exp(-(x * x + y * y) / (2 * w * w)); };
    case Kind::harmonic:
      return [=](const Real& x, const Real& y) {
        return m * (Real(s.omega_x) * s.omega_x * x * x + Real(s.omega_y) * s.omega_y * y * y) / 2;
      };
    case Kind::quartic:
      return [=](const Real& x, const Real& y) { return k * pow(x * x + y * y, 2); };
    case Kind::power:
      return [=](const Real& x, const Real& y) { return k * pow(r(x, y), Real(s.exponent)); };
    case Kind::coulomb:
      return [=](const Real& x, const Real& y) { return q * s.charge / r(x, y); };
    case Kind::henon_heiles:
      return [=](const Real& x, const Real& y) {
        return (x * x + y * y) / 2 + x * x * y - y * y * y / 3;
      };
    case Kind::linear:
      return [=](const Real& x, const Real& y) { return -(s.force.x * x + s.force.y * y); };
    case Kind::soft_circle:
      return [=](const Real& x, const Real& y) { return h / (1 + exp((a - r(x, y)) / sigma)); };
    case Kind::soft_stadium:
      return [=](const Real& x, const Real& y) {
        const Real half = s.half_length, beyond = abs(x) > half ? Real(abs(x) - half) : Real(0);
        return h / (1 + exp((a - r(beyond, y)) / sigma));
      };
    case Kind::expression:
      break;
  }
  return [=](const Real& x, const Real& y) { return x * sin(y) - exp(-x * x); };
}

std::shared_ptr<const ForceField> field_of(const PotentialSpec& s) {
  ForceSpec spec;
  spec.potentials = {s};
  return ForceField::build(spec, {heavy()}, std::nullopt);
}

/// V and F at a point, each to `tolerance` of the sizes of their terms.
void expect_exact(const PotentialSpec& s, Vector at, double tolerance) {
  const Potential40 v = formula40(s);
  const Real d("1e-12");  // central differences: an error of 1e-24
  Real value = 0, fx = 0, fy = 0, size = 0, force_size = 0;
  for (const Vector& c : s.centers) {
    const Real x = Real(at.x) - c.x, y = Real(at.y) - c.y;
    const Real gx = (v(x + d, y) - v(x - d, y)) / (2 * d),
               gy = (v(x, y + d) - v(x, y - d)) / (2 * d);
    value += v(x, y);
    fx -= gx;
    fy -= gy;
    size += abs(v(x, y));
    force_size += abs(gx) + abs(gy);
  }
  // Potentials with a height are as exact as that height; others as their terms, each of a few
  // products.
  size += abs(Real(s.height)) + 1;
  force_size += size / (s.kind == Kind::fermi || s.kind >= Kind::soft_circle ? s.softness : 1.0);
  Vector force{};
  const double computed = field_of(s)->add_external(heavy(), at, force);
  const std::string where = std::to_string(static_cast<int>(s.kind)) + " at " +
                            std::to_string(at.x) + ", " + std::to_string(at.y);
  EXPECT_LT(static_cast<double>(abs(computed - value) / size), tolerance) << where;
  EXPECT_LT(static_cast<double>(abs(force.x - fx) / force_size), tolerance) << where;
  EXPECT_LT(static_cast<double>(abs(force.y - fy) / force_size), tolerance) << where;
}

TEST(Potentials, EveryKindHasItsValuesAndForces) {
  std::mt19937_64 generator(11);
  std::uniform_real_distribution<double> uniform(-2.5, 2.5);
  for (const Kind kind : {Kind::fermi, Kind::harmonic, Kind::gaussian, Kind::quartic, Kind::power,
                          Kind::coulomb, Kind::henon_heiles, Kind::linear, Kind::soft_circle,
                          Kind::soft_stadium, Kind::expression}) {
    PotentialSpec s = spec_of(kind);
    if (kind == Kind::expression)
      s.expression = std::make_shared<TypedExpression>(formula("x*sin(y) - exp(-x*x)"));
    for (int i = 0; i < 60; ++i) expect_exact(s, {uniform(generator), uniform(generator)}, 3e-15);
  }
}

TEST(Potentials, EveryPowerHasItsForce) {
  PotentialSpec s = spec_of(Kind::power);
  for (const double exponent : {2.0, 4.0, 12.0, 1.0, 2.5, -1.0, -2.0}) {
    s.exponent = exponent;
    for (const Vector at : {Vector{0.9, 0.4}, Vector{-1.1, 1.7}, Vector{0.3, -2.0}})
      expect_exact(s, at, 1e-14);
  }
}

TEST(Potentials, ForcesAddUp) {
  Vector force{3.0, -4.0}, alone{};
  const auto field = field_of(spec_of(Kind::fermi));
  field->add_external(heavy(), {0.3, 0.2}, alone);
  field->add_external(heavy(), {0.3, 0.2}, force);
  EXPECT_DOUBLE_EQ(force.x, 3.0 + alone.x);
  EXPECT_DOUBLE_EQ(force.y, -4.0 + alone.y);
}

// Far away an exponential overflows, in the middle a direction is missing: both are numbers all the
// same.
TEST(Potentials, BumpsAreNumbersEverywhere) {
  for (const double softness : {1e-6, 1e-3, 0.1, 10.0})
    for (const Kind kind : {Kind::fermi, Kind::gaussian, Kind::soft_circle, Kind::soft_stadium}) {
      PotentialSpec s = spec_of(kind);
      s.softness = s.width = softness;
      s.centers = {{0.0, 0.0}};
      for (const double r : {0.0, 1e-300, 1e-20, 1.0, 1e3, 1e6, 1e12}) {
        Vector force{};
        const double v = field_of(s)->add_external(heavy(), {0.6 * r, -0.8 * r}, force);
        EXPECT_TRUE(v >= 0.0 && v <= s.height)
            << static_cast<int>(kind) << " " << softness << " " << r;
        EXPECT_TRUE(std::isfinite(force.x) && std::isfinite(force.y))
            << static_cast<int>(kind) << " " << softness;
        const bool wall = kind == Kind::soft_circle || kind == Kind::soft_stadium;
        if (r > 1e3 && softness < 1.0) {
          EXPECT_NEAR(v, wall ? s.height : 0.0, 1e-100);
          EXPECT_LT(dot(force, force), 1e-200);
        }
      }
    }
}

// The tail is below its bound outside the support, and not much less just inside.
TEST(Potentials, SupportsEndWhereTheTailIsBelowItsBound) {
  for (const Kind kind : {Kind::fermi, Kind::gaussian})
    for (const double height : {1.3, -40.0}) {
      PotentialSpec s = spec_of(kind);
      s.height = height;
      s.centers = {{0.25, -0.5}};
      const auto field = field_of(s);
      ASSERT_FALSE(field->everywhere());
      ASSERT_EQ(field->supports().size(), 1u);
      EXPECT_EQ(field->supports()[0].center, s.centers[0]);
      EXPECT_DOUBLE_EQ(field->tail_bound(), 1e-16 * std::fabs(height));
      const double reach = field->supports()[0].radius;
      Vector unused{};
      EXPECT_LE(std::fabs(field->add_external(heavy(), {0.25 + reach, -0.5}, unused)),
                field->tail_bound());
      EXPECT_GT(std::fabs(field->add_external(heavy(), {0.25, -0.5 + 0.99 * reach}, unused)),
                field->tail_bound());
    }
  EXPECT_TRUE(field_of(spec_of(Kind::harmonic))->everywhere());
  EXPECT_TRUE(field_of(spec_of(Kind::soft_circle))->everywhere());
}

std::shared_ptr<const ForceField> on_lattice(const PotentialSpec& s,
                                             const geometry::Lattice& lattice) {
  ForceSpec spec;
  spec.potentials = {s};
  spec.potentials[0].lattice = true;
  return ForceField::build(spec, {heavy()}, lattice);
}

TEST(LatticeSums, AreCoveredOrNot) {
  const geometry::Lattice square = geometry::make_lattice({1, 0}, {0, 1}, {0, 0});
  PotentialSpec s = spec_of(Kind::fermi);
  s.centers = {{0, 0}};
  s.radius = 0.1;
  s.softness = 0.001;
  EXPECT_FALSE(on_lattice(s, square)->everywhere());
  EXPECT_NEAR(on_lattice(s, square)->supports().at(0).radius, 0.137, 0.001);
  s.softness = 0.02;  // reaches the corners of the cell, at .707
  EXPECT_TRUE(on_lattice(s, square)->everywhere());
  EXPECT_TRUE(on_lattice(s, square)->supports().empty());
}

// One support each for what repeats others, lies in others, or stands out by rounding; on a lattice
// also in copies.
TEST(Supports, DoNotLieInOthers) {
  PotentialSpec s = spec_of(Kind::gaussian);
  s.width = 0.02;
  s.centers = {{0, 0}, {0.5, 0.25}, {0, 0}, {0.5, 0.25 + 0x1p-53}};
  ForceSpec spec;
  spec.potentials = {s, s, s};
  spec.potentials[1].width = 0.021;  // about the same centres, larger
  spec.potentials[2].width = 0.005;
  spec.potentials[2].centers = {{0.01, 0}, {0.2, 0.25}};  // inside the first, beside the second
  const auto in_plane = ForceField::build(spec, {heavy()}, std::nullopt);
  ASSERT_EQ(in_plane->supports().size(), 3u);
  PotentialSpec one = s;
  one.width = 0.021;
  const double radius = field_of(one)->supports()[0].radius;
  for (const Support& support : in_plane->supports())
    EXPECT_NEAR(support.radius, support.center.x == 0.2 ? radius * 0.005 / 0.021 : radius, 1e-15);

  const geometry::Lattice lattice =
      geometry::make_lattice({1, 0}, {0.5, 0x1.bb67ae8584caap-1}, {0, 0});
  for (PotentialSpec& p : spec.potentials) p.lattice = true;
  spec.potentials[0].centers = {
      {0, 0}, {0.5, 0x1.bb67ae8584cabp-1}, {-3, 0}};  // an ulp above a lattice point
  spec.potentials[1].centers = {{4, 0}};
  spec.potentials[2].centers = {{0.01, 0}};
  EXPECT_EQ(ForceField::build(spec, {heavy()}, lattice)->supports().size(), 1u);
}

// What is left out, summed itself, at the points of the cell where most is left out: its corners.
TEST(LatticeSums, LeaveOutLessThanTheirBound) {
  std::mt19937_64 generator(5);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  double largest = 0.0;
  for (int i = 0; i < 40; ++i) {
    const double b = 0.4 + 1.2 * uniform(generator), shear = uniform(generator) - 0.5;
    const geometry::Lattice lattice = geometry::make_lattice({1, 0}, {shear, b}, {0.1, 0.2});
    const Vector center{uniform(generator), uniform(generator)};
    const double radius = 0.5 * uniform(generator),
                 softness = std::pow(10.0, -2.0 + 1.5 * uniform(generator));
    const double width = softness * 3.0;
    for (const bool gaussian : {false, true}) {
      const double reach = gaussian ? gaussian_sum_reach(width, lattice)
                                    : fermi_sum_reach(radius, softness, lattice);
      const auto kept = copies_that_reach({center}, lattice, reach);
      const auto all = copies_that_reach({center}, lattice, 1.6 * reach);
      for (const geometry::CellEdge& edge : lattice.edges) {
        double left_out = 0.0;
        for (const Vector& c : all) {
          const bool is_kept = std::find(kept.begin(), kept.end(), c) != kept.end();
          const double r = std::sqrt(dot(edge.segment.from - c, edge.segment.from - c));
          // Nothing within reach of the corner may be missing.
          EXPECT_TRUE(is_kept || r > reach * (1 - 1e-14));
          if (!is_kept || r > reach)
            left_out += gaussian ? std::exp(-r * r / (2 * width * width))
                                 : std::exp((radius - r) / softness);
        }
        EXPECT_LT(left_out, 1e-16);
        largest = std::max(largest, left_out);
      }
    }
  }
  EXPECT_GT(largest, 1e-18);  // the bound is not wasteful
}

TEST(LatticeSums, HaveTheSymmetryOfTheLattice) {
  const System system = load_system("soft-lorentz").system;
  const ForceField& field = *system.dynamics.forces;
  const geometry::Lattice& lattice = *system.table->lattice;
  EXPECT_TRUE(field.everywhere());
  const Particle p;
  std::mt19937_64 generator(3);
  std::uniform_real_distribution<double> uniform(-0.45, 0.45);
  for (int i = 0; i < 200; ++i) {
    const Vector x{uniform(generator), uniform(generator)};
    Vector f{};
    const double v = field.add_external(p, x, f);
    // Turned by 60 degrees, and in a mirror.
    const double c = 0.5, s = std::sqrt(3.0) / 2.0;
    Vector g{};
    EXPECT_NEAR(field.add_external(p, {c * x.x - s * x.y, s * x.x + c * x.y}, g), v, 2e-15);
    EXPECT_NEAR(g.x, c * f.x - s * f.y, 2e-14);
    EXPECT_NEAR(g.y, s * f.x + c * f.y, 2e-14);
    g = {};
    EXPECT_NEAR(field.add_external(p, {x.x, -x.y}, g), v, 2e-15);
    EXPECT_NEAR(g.y, -f.y, 2e-14);
  }
  // A particle that leaves the cell at an edge comes in at the opposite one.
  for (const geometry::CellEdge& edge : lattice.edges)
    for (double u = 0.0; u < 1.0; u += 0.125) {
      const Vector x = edge.segment.from + u * (edge.segment.to - edge.segment.from);
      Vector f{}, g{};
      const double v = field.add_external(p, x, f);
      EXPECT_NEAR(field.add_external(p, x - lattice.translation(edge.beyond), g), v, 1e-16);
      EXPECT_NEAR(g.x, f.x, 4e-15);
      EXPECT_NEAR(g.y, f.y, 4e-15);
    }
}

/// Fermi bumps of the soft Lorentz gas within a distance, to 40 digits.
Real soft_lorentz(const Real& x, const Real& y, double within) {
  const Real height = sqrt(Real(3)) / 2;
  Real sum = 0;
  for (int m = -14; m <= 14; ++m)
    for (int n = -14; n <= 14; ++n) {
      const Real dx = x - m - Real(n) / 2, dy = y - n * height, r = sqrt(dx * dx + dy * dy);
      if (r < within) sum += 1 / (1 + exp((r - Real("0.15")) * 10));
    }
  return sum;
}

TEST(LatticeSums, SoftLorentzGasHasItsSums) {
  const System system = load_system("soft-lorentz").system;
  const Real low = sqrt(Real(3)) / 6;
  // Centre, saddle, hollow. Sums over neighbours nearer than 1.8 are the numbers known for this
  // system; all the others together add up to 3e-7.
  const struct {
    Real x, y;
    double all, near;
  } points[] = {{0, 0, 0.81879590162678407, 0.8187958460},
                {Real(1) / 2, 0, 0.060212220176778692, 0.0602119463},
                {Real(1) / 2, low, 0.041360523558561539, 0.0413604975}};
  for (const auto& p : points) {
    Vector force{};
    const double v = system.dynamics.forces->add_external(
        Particle{}, {static_cast<double>(p.x), static_cast<double>(p.y)}, force);
    EXPECT_NEAR(v, p.all, 1e-15);
    EXPECT_LT(static_cast<double>(abs(soft_lorentz(p.x, p.y, 12.0) - p.all)), 1e-15);
    EXPECT_LT(static_cast<double>(abs(soft_lorentz(p.x, p.y, 1.8) - p.near)), 0.6e-10);
    EXPECT_NEAR(force.x, 0.0, 1e-14);
    EXPECT_NEAR(force.y, 0.0, 1e-14);
  }
}

}  // namespace
}  // namespace carom
