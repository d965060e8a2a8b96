// The equations of closed chains: their derivatives, and that they belong to the action.
#include "orbits/chain.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <vector>

#include "carom/table/make.hpp"
#include "orbits/itinerary.hpp"
#include "orbits/newton.hpp"
#include "random_tables.hpp"

namespace carom::orbits {
namespace {

using tests::Dice;

// A chain of places at random, with half-turns that close its flights where a field acts.
Chain chain_at_random(const Boundary& boundary, Dice& dice, std::size_t n) {
  Chain chain;
  for (std::size_t i = 0; i < n; ++i) {
    Link link;
    link.wall = static_cast<int>(i % boundary.frames.size());
    link.u = dice.between(0.05, 0.9);
    chain.push_back(link);
  }
  const double k = std::abs(boundary.flight_curvature());
  if (k == 0.0) return chain;
  const ChainGeometry g = geometry_of(boundary, chain);
  for (std::size_t i = 0; i < n; ++i) {
    chain[i].half_turn = std::asin(0.5 * k * g.flights[i].chord);
    if (i % 2 == 1) chain[i].half_turn = M_PI - chain[i].half_turn;  // the longer arc
  }
  return chain;
}

struct Example {
  MadeTable table;
  double omega;
};
std::vector<Example> examples() {
  const MadeTable tables[] = {stadium(1.0, 1.0), mushroom(1.0, 0.5, 1.0), ellipse(1.0, 0.75),
                              sinai(2.0, 0.4, false)};
  std::vector<Example> all;
  for (const MadeTable& table : tables)
    for (const double omega : {0.0, 0.3, -0.3}) all.push_back({table, omega});
  return all;
}

TEST(Chain, DerivativesAgreeWithDifferences) {
  Dice dice(1);
  for (const Example& example : examples()) {
    const Boundary boundary(*example.table.table, {.speed = 1.5, .omega = example.omega});
    if (boundary.frames.size() < 2) continue;
    const Chain chain = chain_at_random(boundary, dice, 4);
    const std::vector<double> matrix = derivatives(boundary, geometry_of(boundary, chain));
    const std::size_t m = equations(boundary, chain);
    for (std::size_t j = 0; j < m; ++j) {
      const double h = 0x1p-20;
      std::vector<double> step(m, 0.0);
      step[j] = 1.0;
      Chain more = chain, less = chain;
      ASSERT_TRUE(move(boundary, more, step, h));
      ASSERT_TRUE(move(boundary, less, step, -h));
      const std::vector<double> a = residual(boundary, geometry_of(boundary, more));
      const std::vector<double> b = residual(boundary, geometry_of(boundary, less));
      for (std::size_t i = 0; i < m; ++i)
        EXPECT_NEAR(matrix[i * m + j], (a[i] - b[i]) / (2.0 * h), 1e-7);
    }
  }
}

// The reflections' equations are the derivatives of length + omega area / v at fixed ends of each
// flight, in any gauge: the sign of the area is that of conventions.md.
TEST(Chain, TheActionIsStationaryWhereTheLawOfReflectionHolds) {
  Dice dice(2);
  for (const Example& example : examples()) {
    const double speed = 1.5, h = 0x1p-20;
    const Boundary boundary(*example.table.table, {.speed = speed, .omega = example.omega});
    if (boundary.frames.size() < 2) continue;
    const double k = std::abs(boundary.flight_curvature());
    const Chain chain = chain_at_random(boundary, dice, 4);
    const std::vector<double> sides = residual(boundary, geometry_of(boundary, chain));
    const auto action = [&](std::size_t i, double by) {
      Chain moved = chain;
      bool left = false;
      const WallPlace place = moved_along(boundary, {chain[i].wall, chain[i].u}, by, left);
      moved[i].wall = place.wall;
      moved[i].u = place.u;
      // Flights of the particle's curvature between the new places.
      const ChainGeometry g = geometry_of(boundary, moved);
      for (std::size_t f = 0; k > 0.0 && f < moved.size(); ++f) {
        const double half = std::asin(0.5 * k * g.flights[f].chord);
        moved[f].half_turn = chain[f].half_turn > M_PI_2 ? M_PI - half : half;
      }
      const ChainGeometry closed = geometry_of(boundary, moved);
      return length_of(boundary, moved, closed) +
             example.omega / speed * area_of(boundary, moved, closed);
    };
    for (std::size_t i = 0; i < chain.size(); ++i)
      EXPECT_NEAR((action(i, h) - action(i, -h)) / (2.0 * h), sides[i], 1e-7);
  }
}

// Two ways to one orbit: the shortest chain, and the zero of the equations.
TEST(Chain, TheShortestOneIsTheOrbit) {
  const MadeTable table = discs({{0.0, 0.0}, {6.0, 0.0}, {2.0, 5.0}}, 1.0);
  const Boundary boundary(*table.table, {});
  for (std::size_t n = 2; n <= 6; ++n)
    for_each_word(3, n, [&](const std::vector<int>& word) {
      Chain start = chain_of_word(boundary, word);
      const std::optional<Solution> solution = solve(boundary, start);
      const Chain least = shortest(boundary, start);
      EXPECT_TRUE(solution);
      if (!solution) return true;
      const ChainGeometry g = geometry_of(boundary, least);
      EXPECT_NEAR(length_of(boundary, least, g),
                  length_of(boundary, solution->chain, solution->geometry), 1e-12);
      for (std::size_t i = 0; i < n; ++i) {
        const geometry::Vector apart = g.points[i].position - solution->geometry.points[i].position;
        EXPECT_LT(std::sqrt(dot(apart, apart)), 1e-6);
      }
      return true;
    });
}

TEST(Words, AreCountedByNecklaces) {
  // Of three letters without equal neighbours: closed words 2^n + 2 (-1)^n; prime cycles by
  // Moebius.
  const std::size_t counts[] = {3, 2, 3, 6, 9, 18, 30, 56, 99};
  for (std::size_t n = 2; n <= 10; ++n) {
    std::size_t count = 0;
    for_each_word(3, n, [&](const std::vector<int>&) {
      ++count;
      return true;
    });
    EXPECT_EQ(count, counts[n - 2]) << n;
  }
}

// Along a curve of many pieces: there and back, and once round; not over a corner.
TEST(Boundary, StepsLeadFromPieceToPiece) {
  const MadeTable made = limacon(1, 0.5);
  const Boundary boundary(*made.table, {.speed = 1.0});
  double perimeter = 0.0;
  for (const auto& frame : boundary.frames) perimeter += geometry::length(frame);
  ASSERT_GT(boundary.frames.size(), 100U);
  bool left = false;
  const WallPlace start{7, 0.25};
  const auto at = [&](const WallPlace& p) { return wall_point(boundary, p.wall, p.u).position; };
  for (const double by : {0.3, -2.5, perimeter - 1.0}) {
    const WallPlace there = moved_along(boundary, start, by, left);
    EXPECT_NE(there.wall, start.wall);
    EXPECT_LT(length(at(moved_along(boundary, there, -by, left)) - at(start)), 1e-13);
  }
  EXPECT_LT(length(at(moved_along(boundary, start, perimeter, left)) - at(start)), 1e-12);
  EXPECT_FALSE(left);
  EXPECT_EQ(boundary.curves.front(), boundary.curves.back());

  const MadeTable cusped = cardioid(1);
  const Boundary with_cusp(*cusped.table, {.speed = 1.0});
  moved_along(with_cusp, {3, 0.5}, -2.0, left);
  EXPECT_TRUE(left);
}

}  // namespace
}  // namespace carom::orbits
