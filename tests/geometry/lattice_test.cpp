// Lattices and their cells, in rational numbers.
#include "carom/geometry/lattice.hpp"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>

namespace carom::geometry {
namespace {

using Rational = BasicVector<mpq_class>;
Rational rational(Vector v) { return {mpq_class(v.x), mpq_class(v.y)}; }
bool same(const Rational& a, const Rational& b) { return a.x == b.x && a.y == b.y; }
Rational translation(const Lattice& l, const Cell& c) {
  return mpq_class(static_cast<long>(c.first)) * rational(l.first) +
         mpq_class(static_cast<long>(c.second)) * rational(l.second);
}

void expect_cell(const Lattice& l, Vector centre, std::size_t edges) {
  const std::size_t n = l.edges.size();
  ASSERT_EQ(n, edges);
  mpq_class twice_area = 0;
  const double size = std::sqrt(std::fabs(l.cell_area()));
  for (std::size_t i = 0; i < n; ++i) {
    const CellEdge& edge = l.edges[i];
    const CellEdge& next = l.edges[(i + 1) % n];
    const CellEdge& opposite = l.edges[(i + n / 2) % n];
    EXPECT_EQ(edge.segment.to, next.segment.from);
    const Rational d = rational(edge.segment.to) - rational(edge.segment.from),
                   e = rational(next.segment.to) - rational(next.segment.from);
    EXPECT_TRUE(cross(d, e) > 0) << mpq_class(cross(d, e)).get_d();
    twice_area += cross(rational(edge.segment.from), rational(edge.segment.to));
    // The cell beyond is entered through the opposite edge, translated: exactly.
    EXPECT_EQ(opposite.beyond, (Cell{-edge.beyond.first, -edge.beyond.second}));
    const Rational step = translation(l, edge.beyond);
    EXPECT_TRUE(same(rational(opposite.segment.from) + step, rational(edge.segment.to)));
    EXPECT_TRUE(same(rational(opposite.segment.to) + step, rational(edge.segment.from)));
    // A bisector: both corners are as far from the centre as from the neighbour.
    const Vector neighbour = centre + l.translation(edge.beyond);
    for (const Vector p : {edge.segment.from, edge.segment.to}) {
      const Vector here = p - centre, there = p - neighbour;
      EXPECT_NEAR(std::sqrt(dot(here, here)), std::sqrt(dot(there, there)),
                  1e-12 * (size + std::sqrt(dot(here, here))));
    }
  }
  const Rational a = rational(l.first), b = rational(l.second);
  EXPECT_TRUE(twice_area == 2 * abs(cross(a, b))) << twice_area.get_d();
}

TEST(Lattice, SquareAndTriangularLatticesAreReduced) {
  const Lattice square = make_lattice({1.0, 0.0}, {0.0, 1.0}, {0.5, 0.5});
  expect_cell(square, {0.5, 0.5}, 4);
  for (const CellEdge& edge : square.edges)
    for (const Vector p : {edge.segment.from, edge.segment.to}) {
      EXPECT_TRUE(p.x == 0.0 || p.x == 1.0);
      EXPECT_TRUE(p.y == 0.0 || p.y == 1.0);
    }
  const Lattice triangular = make_lattice({1.0, 0.0}, {0.5, std::sqrt(3.0) / 2.0}, {0.0, 0.0});
  expect_cell(triangular, {0.0, 0.0}, 6);
  EXPECT_EQ(triangular.first, (Vector{1.0, 0.0}));
  EXPECT_NEAR(triangular.second.y, std::sqrt(3.0) / 2.0, 0x1p-52);
  EXPECT_EQ(triangular.translation({2, -1}), (Vector{1.5, -triangular.second.y}));
}

TEST(Lattice, AnyTwoVectors) {
  std::mt19937_64 random(3);
  for (const double size : {1e-6, 1.0, 1e6}) {
    std::uniform_real_distribution<double> box(-size, size);
    for (int i = 0; i < 300; ++i) {
      const Vector a{box(random), box(random)}, b{box(random), box(random)},
          c{box(random), box(random)};
      const double sine = std::fabs(cross(a, b)) / std::sqrt(dot(a, a) * dot(b, b));
      if (sine < 0.01) continue;
      const Lattice l = make_lattice(a, b, c);
      const double grid = 0x1p-51 * size;
      EXPECT_NEAR(l.first.x, a.x, grid);
      EXPECT_NEAR(l.second.y, b.y, grid);
      expect_cell(l, c, 6);
    }
  }
}

TEST(Lattice, SkewedBasisOfASquareLatticeIsSquare) {
  const Lattice l = make_lattice({1.0, 0.0}, {7.0, 1.0}, {0.0, 0.0});
  expect_cell(l, {0.0, 0.0}, 4);
  EXPECT_EQ(l.second, (Vector{7.0, 1.0}));
  bool up = false;
  for (const CellEdge& edge : l.edges)
    up = up || (l.translation(edge.beyond) == Vector{0.0, 1.0} && edge.beyond == Cell{-7, 1});
  EXPECT_TRUE(up);
}

TEST(Lattice, NearlyRectangularLatticesAreReduced) {
  // Two of the six edges would be shorter than the grid.
  for (const double tilt : {0x1p-52, -0x1p-52, 0x1p-50, 3 * 0x1p-50, 1e-13})
    for (const double length : {1.0, 1.25, 0.7}) {
      const Lattice l = make_lattice({1.0, tilt}, {tilt, length}, {0.0, 0.0});
      EXPECT_TRUE(l.edges.size() == 4 || l.edges.size() == 6);
      expect_cell(l, {0.0, 0.0}, l.edges.size());
    }
}

TEST(Lattice, BadVectorsAreRefused) {
  EXPECT_THROW(make_lattice({1, 0}, {2, 0}, {0, 0}), std::invalid_argument);
  EXPECT_THROW(make_lattice({0, 0}, {0, 1}, {0, 0}), std::invalid_argument);
  EXPECT_THROW(make_lattice({1, 0}, {NAN, 1}, {0, 0}), std::invalid_argument);
  EXPECT_THROW(make_lattice({1e-30, 0}, {0, 1}, {0, 0}), std::invalid_argument);
}

}  // namespace
}  // namespace carom::geometry
