// Tables of lattice sums: against the copies added one by one, and the bound of what their
// polynomials leave out.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "forces/bumps.hpp"
#include "forces/copies.hpp"
#include "forces/formulas.hpp"
#include "forces/lattice_bumps.hpp"
#include "forces/nearest_copy.hpp"

namespace carom {

using namespace forces;

namespace {

using geometry::Vector;
using Real = FortyDigits;
using Kind = BumpShape::Kind;

struct Case {
  BumpShape shape;
  std::vector<Vector> centers;
  geometry::Lattice lattice;
  double reach() const {
    return shape.kind == Kind::fermi ? fermi_sum_reach(shape.radius, shape.softness, lattice)
                                     : gaussian_sum_reach(shape.width, lattice);
  }
};

std::vector<Case> random_cases(int n, unsigned seed) {
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<Case> cases;
  for (int i = 0; i < n; ++i) {
    Case c;
    const double size = std::pow(10.0, 3.0 * uniform(generator) - 1.5);
    c.shape.kind = i % 3 == 2 ? Kind::gaussian : Kind::fermi;
    c.shape.radius = 0.5 * size * uniform(generator);
    c.shape.softness = size * std::pow(10.0, -3.5 + 3.0 * uniform(generator));
    c.shape.width = 2.0 * c.shape.softness;
    // Every other lattice is given by vectors that are not its shortest.
    const double skew = i % 2 == 0 ? 0.0 : 3.0;
    c.lattice = geometry::make_lattice(
        {size, 0.0}, {(uniform(generator) + skew) * size, (0.5 + uniform(generator)) * size},
        {0.0, 0.0});
    for (int k = 0; k <= i % 3; ++k)
      c.centers.push_back({size * uniform(generator), -size * uniform(generator)});
    cases.push_back(c);
  }
  return cases;
}

Vector in_cell(const geometry::Lattice& lattice, std::mt19937_64& generator) {
  std::uniform_real_distribution<double> uniform(-0.6, 0.6);
  const double m = uniform(generator), n = uniform(generator);
  return nearest_copy(
      {m * lattice.first.x + n * lattice.second.x, m * lattice.first.y + n * lattice.second.y},
      lattice);
}

TEST(LatticeTables, AreTheSumsOfAllCopies) {
  std::mt19937_64 generator(7);
  int with_polynomials = 0;
  for (const Case& c : random_cases(24, 1)) {
    const LatticeTable table(c.shape, c.centers, c.lattice, c.reach());
    const LatticeSum& t = table.sum();
    with_polynomials += t.degree >= 0;
    EXPECT_LE(table.error(), tail_share);
    const auto potential = make_lattice_bumps(c.shape, 1.0, c.centers, c.lattice, c.reach());
    const auto copies = copies_that_reach(c.centers, c.lattice, 1.5 * c.reach());
    const auto one_by_one = c.shape.kind == Kind::fermi
                                ? make_fermi_bumps(1.0, c.shape.radius, c.shape.softness, copies)
                                : make_gaussian_bumps(1.0, c.shape.width, copies);
    for (int i = 0; i < 100; ++i) {
      const Vector x = in_cell(c.lattice, generator);
      Vector f{}, g{};
      const double v = potential->add_force({}, x, f), w = one_by_one->add_force({}, x, g);
      // Both round: by the sum's size, and where the point lies by that of the lattice.
      const double size = std::sqrt(dot(c.lattice.first, c.lattice.first) +
                                    dot(c.lattice.second, c.lattice.second));
      const double tolerance = 1e-15 + 2e-15 * w + 3e-16 * size / c.shape.length();
      EXPECT_NEAR(v, w, tolerance);
      EXPECT_NEAR(f.x * c.shape.length(), g.x * c.shape.length(), tolerance);
      EXPECT_NEAR(f.y * c.shape.length(), g.y * c.shape.length(), tolerance);
    }
  }
  EXPECT_GE(with_polynomials, 4);
}

// Bumps much broader than a cell: finer grids would take minutes, and the coarsest has the sum.
TEST(LatticeTables, OfBroadBumpsAreCoarse) {
  Case c;
  c.shape.radius = 0.15;
  c.shape.softness = 2.0;
  c.lattice = geometry::make_lattice({1.0, 0.0}, {0.5, 0.875}, {0.0, 0.0});
  c.centers = {{0.0, 0.0}};
  const LatticeTable table(c.shape, c.centers, c.lattice, c.reach());
  EXPECT_EQ(table.sum().mask, 3);
  EXPECT_LE(table.error(), tail_share);
  const auto potential = make_lattice_bumps(c.shape, 1.0, c.centers, c.lattice, c.reach());
  const auto copies = copies_that_reach(c.centers, c.lattice, 1.5 * c.reach());
  const auto one_by_one = make_fermi_bumps(1.0, c.shape.radius, c.shape.softness, copies);
  std::mt19937_64 generator(3);
  for (int i = 0; i < 5; ++i) {
    const Vector x = in_cell(c.lattice, generator);
    Vector f{}, g{};
    const double v = potential->add_force({}, x, f), w = one_by_one->add_force({}, x, g);
    EXPECT_NEAR(v, w, 1e-13 * w);
    EXPECT_NEAR(f.x, g.x, 1e-13 * w);
    EXPECT_NEAR(f.y, g.y, 1e-13 * w);
  }
}

// Bumps much smaller than the mesh: many nodes have none near.
TEST(LatticeTables, HaveNoBumpsWhereThereAreNone) {
  for (const Kind kind : {Kind::fermi, Kind::gaussian}) {
    const Case c{
        {kind, 0.02, 0.001, 0.008}, {{0.05, -0.1}}, geometry::make_lattice({1, 0}, {0, 1}, {0, 0})};
    const auto potential = make_lattice_bumps(c.shape, 1.0, c.centers, c.lattice, c.reach());
    const auto copies = copies_that_reach(c.centers, c.lattice, c.reach());
    const auto one_by_one = kind == Kind::fermi
                                ? make_fermi_bumps(1.0, c.shape.radius, c.shape.softness, copies)
                                : make_gaussian_bumps(1.0, c.shape.width, copies);
    for (double x = -0.5; x <= 0.5; x += 0x1p-7)
      for (double y = -0.5; y <= 0.5; y += 0x1p-7) {
        Vector f{}, g{};
        EXPECT_NEAR(potential->add_force({}, {x, y}, f), one_by_one->add_force({}, {x, y}, g),
                    1e-13);
        EXPECT_NEAR(f.x, g.x, 1e-10);
        EXPECT_NEAR(f.y, g.y, 1e-10);
      }
  }
}

Real value40(const BumpShape& s, const Real& x, const Real& y) {
  const Real square = x * x + y * y;
  if (s.kind == Kind::gaussian) return exp(-square / (2 * Real(s.width) * s.width));
  return 1 / (1 + exp((sqrt(square) - s.radius) / s.softness));
}

// Taylor's polynomials of low degree, whose error is far above rounding, against 40 digits: it is
// below its bound, and the bound is not wasteful.
TEST(LatticeTables, SeriesKeepTheirBounds) {
  std::mt19937_64 generator(3);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  double largest = 0.0;
  for (int i = 0; i < 60; ++i) {
    BumpShape s{i % 4 == 3 ? Kind::gaussian : Kind::fermi, 0.6 * uniform(generator),
                0.03 + 0.3 * uniform(generator), 0.4};
    const double angle = 7.0 * uniform(generator), r = 0.2 + 1.2 * uniform(generator);
    const double mesh = 0.15 * std::min(r, s.length());
    const Vector d{r * std::cos(angle), r * std::sin(angle)}, a{mesh, 0.1 * mesh},
        b{-0.3 * mesh, 0.8 * mesh};
    const Vector sum = a + b, difference = a - b;
    const double way = 0.5 * std::sqrt(std::max(dot(sum, sum), dot(difference, difference)));
    const SeriesErrors bounds = series_errors(s, r, way);
    for (const int degree : {2, 4, 6}) {
      const auto width = static_cast<std::size_t>(degree + 1);
      std::vector<double> p(width * width, 0.0);
      add_series(s, d, a, b, degree, width, p);
      double error = 0.0;
      for (int k = 0; k < 40; ++k) {
        const double X = k < 4 ? (k & 1) - 0.5 : uniform(generator) - 0.5,
                     Y = k < 4 ? (k / 2) - 0.5 : uniform(generator) - 0.5;
        Real value = 0, by_x = 0, by_y = 0;
        for (std::size_t j = width; j-- > 0;) {
          Real row = 0, slope = 0;
          for (std::size_t m = width - j; m-- > 0;) {
            slope = slope * X + row;
            row = row * X + p[m + width * j];
          }
          by_y = by_y * Y + value;
          value = value * Y + row;
          by_x = by_x * Y + slope;
        }
        const Real x = Real(d.x) + Real(X) * a.x + Real(Y) * b.x,
                   y = Real(d.y) + Real(X) * a.y + Real(Y) * b.y;
        error = std::max(error, std::fabs(static_cast<double>(value - value40(s, x, y))));
        // Slopes along a and b, each at most the gradient times their length.
        const Real h("1e-12");
        const auto slope = [&](Vector e) -> Real {
          return (value40(s, x + h * e.x, y + h * e.y) - value40(s, x - h * e.x, y - h * e.y)) /
                 (2 * h);
        };
        const double to_bound = s.length() / mesh / 1.01;
        error = std::max(error, to_bound * std::fabs(static_cast<double>(by_x - slope(a))));
        error = std::max(error, to_bound * std::fabs(static_cast<double>(by_y - slope(b))));
      }
      const double bound = bounds[static_cast<std::size_t>(degree)];
      ASSERT_TRUE(std::isfinite(bound));
      EXPECT_LT(error, bound + 1e-14) << i << " degree " << degree;
      largest = std::max(largest, error / bound);
    }
  }
  EXPECT_GT(largest, 0.05);
}

// A table is periodic for ever, as far as the point itself is exact.
TEST(LatticeTables, ArePeriodic) {
  const Case c{{Kind::fermi, 0.15, 0.1, 1.0},
               {{0.0, 0.0}},
               geometry::make_lattice({1, 0}, {0.25, 1}, {0, 0})};
  const auto potential = make_lattice_bumps(c.shape, 1.0, c.centers, c.lattice, c.reach());
  for (const geometry::Cell cell : {geometry::Cell{1, 0}, {-3, 2}, {0, 40}, {1000, -999}}) {
    const Vector x{0.25, 0.375}, far = x + c.lattice.translation(cell);  // exact
    Vector f{}, g{};
    EXPECT_NEAR(potential->add_force({}, x, f), potential->add_force({}, far, g), 2e-16);
    EXPECT_NEAR(f.x, g.x, 2e-15);
    EXPECT_NEAR(f.y, g.y, 2e-15);
  }
}

}  // namespace
}  // namespace carom
