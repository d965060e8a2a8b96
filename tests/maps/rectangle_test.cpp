#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "maps/closed/maps.hpp"
#include "maps/within.hpp"

namespace carom::maps {
namespace {

using Real = long double;

Real uniform(std::mt19937_64& random, Real low, Real high) {
  return low + (high - low) * static_cast<Real>(random() >> 11) * 0x1p-53L;
}

// From wall to wall, the slow and obvious way.
SideHit<Real> step(Real width, Real height, const SideHit<Real>& from) {
  const Phase<Real>& p = from.phase;
  const Real x_time = p.vx > 0 ? (width - p.x) / p.vx : -p.x / p.vx;
  const Real y_time = p.vy > 0 ? (height - p.y) / p.vy : -p.y / p.vy;
  const Real t = std::min(x_time, y_time);
  Phase<Real> q{p.x + t * p.vx, p.y + t * p.vy, p.vx, p.vy};
  if (x_time <= y_time) {
    q.x = p.vx > 0 ? width : 0;
    q.vx = -p.vx;
    return {p.vx > 0 ? Side::right : Side::left, from.time + t, q};
  }
  q.y = p.vy > 0 ? height : 0;
  q.vy = -p.vy;
  return {p.vy > 0 ? Side::top : Side::bottom, from.time + t, q};
}

TEST(Rectangle, UnfoldingIsBouncing) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 100; ++i) {
    const Real width = uniform(random, 0.5L, 2), height = uniform(random, 0.5L, 2);
    const Phase<Real> start{uniform(random, 0, width), uniform(random, 0, height),
                            uniform(random, -1, 1), uniform(random, -1, 1)};
    const auto hits = Rectangle<Real>(width, height).hits(start, 200);
    ASSERT_EQ(hits.size(), 200u);
    SideHit<Real> bounced{Side::none, 0, start};
    for (const auto& hit : hits) {
      bounced = step(width, height, bounced);
      ASSERT_EQ(bounced.side, hit.side);
      const Real tolerance = 1e-15L * (1 + hit.time);
      ASSERT_WITHIN(bounced.time, hit.time, tolerance);
      ASSERT_WITHIN(bounced.phase.x, hit.phase.x, tolerance);
      ASSERT_WITHIN(bounced.phase.y, hit.phase.y, tolerance);
      ASSERT_EQ(bounced.phase.vx, hit.phase.vx);
      ASSERT_EQ(bounced.phase.vy, hit.phase.vy);
    }
  }
}

TEST(Rectangle, RunsBackwards) {
  std::mt19937_64 random(2);
  const Rectangle<Real> table(1.5L, 1);
  for (int i = 0; i < 1000; ++i) {
    const Phase<Real> start{uniform(random, 0, 1.5L), uniform(random, 0, 1), uniform(random, -1, 1),
                            uniform(random, -1, 1)};
    Phase<Real> p = table.at(start, 1000);
    EXPECT_TRUE(p.x >= 0 && p.x <= 1.5L && p.y >= 0 && p.y <= 1);
    const Phase<Real> past = table.at({p.x, p.y, -p.vx, -p.vy}, 1000), same = table.at(p, -1000);
    EXPECT_WITHIN(past.x, start.x, 1e-15L);
    EXPECT_WITHIN(past.y, start.y, 1e-15L);
    EXPECT_EQ(past.vx, -start.vx);
    EXPECT_WITHIN(same.x, start.x, 1e-15L);
    EXPECT_EQ(same.vy, start.vy);
  }
}

TEST(Rectangle, ClosesItsPeriodicOrbits) {
  const Rectangle<Real> square(1, 1);
  const Phase<Real> start{0.25L, 0, 1, 1};
  const Phase<Real> end = square.at(start, 2000000);  // the diamond: period 2, four hits
  EXPECT_EQ(end.x, start.x);
  EXPECT_EQ(end.vx, start.vx);
  const auto hits = square.hits({0.25L, 0.5L, 1, 1}, 400);
  EXPECT_EQ(hits[399].time - hits[3].time, 198);
  EXPECT_EQ(hits[399].side, hits[3].side);
}

TEST(Rectangle, MovesAlongAnAxis) {
  const auto hits = Rectangle<Real>(2, 1).hits({0.5L, 0.25L, -1, 0}, 3);
  EXPECT_EQ(hits[0].side, Side::left);
  EXPECT_EQ(hits[0].time, 0.5L);
  EXPECT_EQ(hits[1].side, Side::right);
  EXPECT_EQ(hits[1].time, 2.5L);
  EXPECT_EQ(hits[2].phase.y, 0.25L);
  EXPECT_TRUE(Rectangle<Real>(2, 1).hits({0.5L, 0.25L, 0, 0}, 3).empty());
}

// The product of the angular momenta about the foci, along an orbit made by the chord formula.
TEST(Ellipse, ConservesTheFocalProduct) {
  std::mt19937_64 random(3);
  for (int i = 0; i < 200; ++i) {
    const Real a = uniform(random, 1, 2), b = uniform(random, 0.3L, 1);
    const Real phi = uniform(random, 0, 6.28L),
               direction = phi + 3.14L + uniform(random, -0.5L, 0.5L);
    Phase<Real> p{a * std::cos(phi), b * std::sin(phi), std::cos(direction), std::sin(direction)};
    if (p.x * p.vx / (a * a) + p.y * p.vy / (b * b) > 0) p = {p.x, p.y, -p.vx, -p.vy};
    const Real first = focal_product(a, b, p), focus = std::sqrt((a - b) * (a + b));
    for (int k = 0; k < 200; ++k) {
      const Real square = p.vx * p.vx / (a * a) + p.vy * p.vy / (b * b);
      const Real t = -2 * (p.x * p.vx / (a * a) + p.y * p.vy / (b * b)) / square;
      const Real axis = p.y - p.x * p.vy / p.vx;  // where the chord meets y = 0 follows from it
      const Real crossing = -axis * p.vx / p.vy;
      // The sign tells whether the chord passes between the foci.
      if (std::abs(p.vy) > 0.01L && std::abs(p.vx) > 0.01L) {
        ASSERT_EQ(std::abs(crossing) < focus, focal_product(a, b, p) < 0);
      }
      p.x += t * p.vx;
      p.y += t * p.vy;
      const Real nx = p.x / (a * a), ny = p.y / (b * b);
      const Real along = 2 * (p.vx * nx + p.vy * ny) / (nx * nx + ny * ny);
      p.vx -= along * nx;
      p.vy -= along * ny;
      ASSERT_WITHIN(focal_product(a, b, p), first, 1e-15L);
    }
  }
}

}  // namespace
}  // namespace carom::maps
