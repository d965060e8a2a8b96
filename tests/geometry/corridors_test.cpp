// Free corridors: known lattices, exact tangency, and a search by brute force.
#include "carom/geometry/corridors.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace carom::geometry {
namespace {

constexpr double pi = 3.141592653589793;

Lattice square(double a = 1.0) { return make_lattice({a, 0}, {0, a}, {0, 0}); }
Lattice triangular(double a) {
  return make_lattice({a, 0}, {a / 2, a * std::sqrt(3.0) / 2}, {0, 0});
}
Curve disc(double r, Vector c = {}) { return Circle{c, r, false}; }

double width(const Corridors& corridors, const Cell& cell) {
  for (const Corridor& c : corridors.list)
    if (c.direction == cell) return c.width;
  return 0.0;
}

TEST(Corridors, SquareLatticeHasItsCorridors) {
  // 1/sqrt(8) < R < 1/2: along the axes alone.
  const Corridors axes = free_corridors(square(), {disc(0.4)});
  ASSERT_EQ(axes.list.size(), 2u);
  EXPECT_NEAR(axes.list[0].width, 0.2, 1e-15);
  EXPECT_NEAR(width(axes, {1, 0}), 0.2, 1e-15);
  EXPECT_NEAR(width(axes, {0, 1}), 0.2, 1e-15);
  EXPECT_NEAR(flight_tail(axes, 1.0 - pi * 0.16), 2 * 0.04 / (pi * (1 - pi * 0.16)), 1e-14);
  // R < 1/sqrt(8): the diagonals open, and so on.
  const Corridors diagonals = free_corridors(square(), {disc(0.35)});
  ASSERT_EQ(diagonals.list.size(), 4u);
  EXPECT_NEAR(width(diagonals, {1, -1}), std::sqrt(0.5) - 0.7, 1e-15);
  for (const double r : {0.3, 0.1, 0.02}) {
    const Corridors all = free_corridors(square(), {disc(r)});
    std::size_t expected = 0;
    for (int m = 0; m < 60; ++m)
      for (int n = -60; n <= 60; ++n) {
        if (std::gcd(m, n) != 1 || (m == 0 && n < 0)) continue;
        if (1.0 / std::hypot(m, n) > 2 * r) {
          ++expected;
          EXPECT_NEAR(width(all, {m, n}), 1.0 / std::hypot(m, n) - 2 * r, 1e-15);
        }
      }
    EXPECT_EQ(all.list.size(), expected) << r;
    EXPECT_TRUE(all.complete);
  }
}

TEST(Corridors, TriangularLatticeHasItsCorridors) {
  // Finite horizon for R > sqrt(3)/4 of the spacing.
  EXPECT_TRUE(free_corridors(triangular(2.2), {disc(1)}).list.empty());
  EXPECT_TRUE(free_corridors(triangular(2.3), {disc(1)}).list.empty());
  const Corridors open = free_corridors(triangular(2.4), {disc(1)});
  ASSERT_EQ(open.list.size(), 3u);
  for (const Corridor& c : open.list) EXPECT_NEAR(c.width, 2.4 * std::sqrt(3.0) / 2 - 2, 1e-14);
}

TEST(Corridors, DiscsThatTouchALineFromBothSidesLeaveNone) {
  EXPECT_TRUE(free_corridors(square(), {disc(0.5)}).list.empty());
  // The nearest doubles to half the height, from both sides.
  const std::vector<Curve> exact{disc(0.25), disc(0.25, {0.5, 0.5})};
  EXPECT_EQ(free_corridors(square(), exact).list.size(), 2u) << "the diagonals alone";
  const double less = std::nextafter(0.25, 0.0);
  const std::vector<Curve> open{disc(less), disc(0.25, {0.5, 0.5})};
  const Corridors corridors = free_corridors(square(), open);
  ASSERT_EQ(corridors.list.size(), 6u) << "two strips along each axis more";
  for (std::size_t k = 2; k < 6; ++k) EXPECT_EQ(corridors.list[k].width, 0x1p-55);
  // Across a diagonal the roots differ: 1/sqrt(8) is no double.
  const double r = std::sqrt(0.125);
  const bool above = r * r * 8 >= 1;  // rounded, but far from a tie
  EXPECT_EQ(free_corridors(square(), {disc(r)}).list.size(), above ? 2u : 4u);
  EXPECT_EQ(free_corridors(square(), {disc(std::nextafter(r, above ? 0.0 : 1.0))}).list.size(),
            above ? 4u : 2u);
}

TEST(Corridors, DoNotDependOnWhereTheObstaclesAreDrawn) {
  const std::vector<Curve> here{disc(0.2), disc(0.1, {0.5, 0.25})};
  const std::vector<Curve> there{disc(0.2, {7, -3}), disc(0.1, {-11.5, 5.25})};
  const Corridors a = free_corridors(square(), here), b = free_corridors(square(), there);
  ASSERT_EQ(a.list.size(), b.list.size());
  EXPECT_GT(a.list.size(), 1u);
  for (std::size_t i = 0; i < a.list.size(); ++i) EXPECT_EQ(a.list[i].width, b.list[i].width);
}

// Shares of lines of one direction that hit nothing, by the distance of lines to discs.
double open_share(const Lattice& lattice, const std::vector<Circle>& discs, const Cell& cell,
                  int lines) {
  const Vector p = lattice.translation(cell);
  const double length = std::sqrt(dot(p, p)), period = lattice.cell_area() / length;
  int open = 0;
  for (int i = 0; i < lines; ++i) {
    const double at = period * (i + 0.5) / lines;
    bool free = true;
    for (const Circle& c : discs) {
      const double distance = std::remainder(cross(p, c.centre) / length - at, period);
      free = free && std::fabs(distance) > c.radius;
    }
    open += free;
  }
  return static_cast<double>(open) / lines;
}

TEST(Corridors, AgreeWithBruteForce) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> in_cell(0, 1), radius(0.02, 0.2);
  std::size_t found = 0;
  for (int table = 0; table < 40; ++table) {
    const Lattice lattice = make_lattice({1 + in_cell(random), 0}, {in_cell(random), 1}, {0, 0});
    std::vector<Circle> discs;
    std::vector<Curve> walls;
    for (int k = 0; k < 3; ++k) {
      discs.push_back({{2 * in_cell(random), in_cell(random)}, radius(random), false});
      walls.emplace_back(discs.back());
    }
    const Corridors corridors = free_corridors(lattice, walls);
    for (int m = 0; m <= 4; ++m)
      for (int n = -4; n <= 4; ++n) {
        if (std::gcd(m, n) != 1 || (m == 0 && n < 0)) continue;
        const Vector p = lattice.translation({m, n});
        const double period = lattice.cell_area() / std::sqrt(dot(p, p));
        double sum = 0;
        for (const Corridor& c : corridors.list)
          if (c.direction == Cell{m, n}) sum += c.width, ++found;
        EXPECT_NEAR(sum / period, open_share(lattice, discs, {m, n}, 2000), 3.0 / 2000) << table;
      }
  }
  EXPECT_GT(found, 50u);
}

TEST(Corridors, PolygonsAndRoundedOnesLeaveCorridors) {
  // A diamond of half diagonal 0.3 and a half disc on a straight base.
  const std::vector<Curve> diamond{Segment{{0.3, 0}, {0, -0.3}}, Segment{{0, -0.3}, {-0.3, 0}},
                                   Segment{{-0.3, 0}, {0, 0.3}}, Segment{{0, 0.3}, {0.3, 0}}};
  const Corridors a = free_corridors(square(), diamond);
  EXPECT_NEAR(width(a, {1, 0}), 0.4, 1e-15);
  EXPECT_NEAR(width(a, {1, 1}), std::sqrt(0.5) * (1 - 0.6), 1e-15);
  // Clockwise: the base runs to the left below the dome.
  const std::vector<Curve> dome{CircularArc{{-0.4, 0}, {0.4, 0}, 0.0, false},
                                Segment{{0.4, 0}, {-0.4, 0}}};
  const Corridors b = free_corridors(square(), dome);
  EXPECT_NEAR(width(b, {1, 0}), 0.6, 1e-15) << "the dome is 0.4 high";
  EXPECT_NEAR(width(b, {0, 1}), 0.2, 1e-15);
  const std::vector<Curve> ellipse{Ellipse{{0.1, 0.2}, {0.4, 0}, 0.5, false}};
  const Corridors c = free_corridors(square(), ellipse);
  EXPECT_NEAR(width(c, {1, 0}), 0.6, 1e-15);
  EXPECT_NEAR(width(c, {0, 1}), 0.2, 1e-15);
  EXPECT_NEAR(width(c, {1, 1}), std::sqrt(0.5) - 2 * std::sqrt(0.5 * (0.16 + 0.04)), 1e-15);
}

TEST(Corridors, TinyDiscsLeaveTheWidestCorridors) {
  const Corridors corridors = free_corridors(square(), {disc(1e-6)});
  EXPECT_FALSE(corridors.complete);
  EXPECT_NEAR(corridors.list.front().width, 1 - 2e-6, 1e-15);
}

}  // namespace
}  // namespace carom::geometry
