#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "maps/closed/maps.hpp"
#include "maps/within.hpp"

namespace carom::maps {
namespace {

using Real = long double;
constexpr Real pi = maps::pi<Real>;

template <class Number>
Number uniform(std::mt19937_64& random, Number low, Number high) {
  return low + (high - low) * static_cast<Number>(random() >> 11) * static_cast<Number>(0x1p-53);
}

struct Point {
  Real x, y;
};

// The point after a time, from the start alone.
Point along(const Gyration<Real>& from, Real speed, Real omega, Real t) {
  const Real r = speed / omega, end = from.angle - omega * t;
  return {from.x + r * (std::sin(from.angle) - std::sin(end)),
          from.y + r * (std::cos(end) - std::cos(from.angle))};
}

Gyration<Real> random_start(std::mt19937_64& random, Real width, Real height) {
  return {uniform<Real>(random, 0, width), uniform<Real>(random, 0, height),
          uniform<Real>(random, -pi, pi)};
}

TEST(MagneticRectangle, EachHitIsTheFirstPointOfTheArcOnAWall) {
  std::mt19937_64 random(1);
  int pinned = 0;
  for (int i = 0; i < 3000; ++i) {
    const Real width = uniform<Real>(random, 0.5L, 2), height = uniform<Real>(random, 0.5L, 2);
    const Real size = std::pow(Real{10}, uniform<Real>(random, -1.5L, 1.5L)),
               speed = uniform<Real>(random, 0.5L, 2);
    const Real omega = i % 2 == 0 ? size : -size;
    const MagneticRectangle<Real> table(width, height, speed, omega);
    Gyration<Real> particle = random_start(random, width, height);
    for (int k = 0; k < 5; ++k) {
      const auto hit = table.arrive(particle);
      if (!hit) {
        ++pinned;
        break;
      }
      const Real flight = hit->time - particle.time;
      ASSERT_TRUE(flight > 0 && flight * std::abs(omega) < 2 * pi);
      const Point end = along(particle, speed, omega, flight);
      ASSERT_WITHIN(end.x, hit->x, 1e-14L);
      ASSERT_WITHIN(end.y, hit->y, 1e-14L);
      ASSERT_WITHIN(std::cos(hit->angle), std::cos(particle.angle - omega * flight), 1e-14L);
      ASSERT_WITHIN(std::sin(hit->angle), std::sin(particle.angle - omega * flight), 1e-14L);
      for (int j = 1; j < 30; ++j) {
        const Point p = along(particle, speed, omega, flight * static_cast<Real>(j) / 30);
        ASSERT_TRUE(p.x > -1e-15L && p.x < width + 1e-15L && p.y > -1e-15L &&
                    p.y < height + 1e-15L);
      }
      particle = *table.next(particle);
    }
  }
  EXPECT_GT(pinned, 100);
}

TEST(MagneticRectangle, ReflectsByTheLawOfReflection) {
  const MagneticRectangle<Real> table(1, 1, 1, 1.3L);
  std::mt19937_64 random(2);
  for (int i = 0; i < 1000; ++i) {
    const auto start = random_start(random, 1, 1);
    const auto before = table.arrive(start), after = table.next(start);
    ASSERT_TRUE(before && after);
    const bool vertical = after->side == Side::left || after->side == Side::right;
    EXPECT_WITHIN(std::cos(after->angle), (vertical ? -1 : 1) * std::cos(before->angle), 1e-18L);
    EXPECT_WITHIN(std::sin(after->angle), (vertical ? 1 : -1) * std::sin(before->angle), 1e-18L);
    EXPECT_EQ(after->hits, 1u);
  }
}

TEST(MagneticRectangle, RunsBackwardsInTheReversedField) {
  std::mt19937_64 random(3);
  for (int i = 0; i < 300; ++i) {
    const Real omega = (i % 2 == 0 ? 1 : -1) * uniform<Real>(random, 0.3L, 3);
    const MagneticRectangle<Real> table(1, 1.25L, 1, omega), reversed(1, 1.25L, 1, -omega);
    const auto first = table.next(random_start(random, 1, 1.25L));
    if (!first) continue;
    Gyration<Real> particle = *first;
    for (int k = 0; k < 10; ++k) particle = *table.next(particle);
    const Real elapsed = particle.time - first->time;
    // Back along the arc that led here: the velocity before the hit, reversed, is the one after it
    // with its other component reversed.
    const bool vertical = particle.side == Side::left || particle.side == Side::right;
    particle.angle = vertical ? -particle.angle : pi - particle.angle;
    const Real turned = particle.time;
    for (int k = 0; k < 10; ++k) particle = *reversed.next(particle);
    EXPECT_EQ(particle.side, first->side);
    EXPECT_WITHIN(particle.x, first->x,
                  1e-9L);  // rounding grown by ten chaotic hits, there and back
    EXPECT_WITHIN(particle.y, first->y, 1e-9L);
    EXPECT_WITHIN(particle.time - turned, elapsed, 1e-9L);
  }
}

TEST(MagneticRectangle, HopsAlongAStraightWall) {
  // A long wall: each hop advances by 2 rho sin(angle) and keeps the angle.
  const Real rho = 0.01L;
  const MagneticRectangle<Real> table(100, 1, 1, 1 / rho);
  for (const Real angle : {Real{0.3L}, pi / 2, Real{2.5L}}) {
    Gyration<Real> particle{1, 0, angle, Side::bottom};
    for (int k = 1; k <= 100; ++k) {
      particle = *table.next(particle);
      ASSERT_EQ(particle.side, Side::bottom);
      ASSERT_WITHIN(particle.x, 1 + 2 * static_cast<Real>(k) * rho * std::sin(angle), 1e-16L);
      ASSERT_WITHIN(particle.angle, angle, 1e-17L);
      ASSERT_WITHIN(particle.time, static_cast<Real>(k) * 2 * angle * rho, 1e-16L);
    }
  }
}

// Half circles along each side of the unit square, a quarter about each corner: five hits a side.
TEST(MagneticRectangle, ClosesTheScallopedOrbit) {
  for (const Real turn : {Real{1}, Real{-1}}) {
    const Real rho = 0.1L;
    const MagneticRectangle<Real> table(1, 1, 2, 2 * turn / rho);
    Gyration<Real> particle{0.5L, 0, pi / 2, Side::bottom};
    for (int k = 0; k < 2000; ++k) {
      particle = *table.next(particle);
      const Real s = table.arc_length(particle) * 10;
      ASSERT_WITHIN(s, 2 * std::floor(s / 2) + 1, 1e-12L);  // 0.1, 0.3, ... 0.9
    }
    EXPECT_EQ(particle.side, Side::bottom);
    EXPECT_WITHIN(particle.x, 0.5L, 1e-13L);
    EXPECT_WITHIN(particle.angle, pi / 2, 1e-12L);
    EXPECT_WITHIN(particle.time, 100 * 18 * pi * rho / 2, 1e-11L);  // 18 half circles a round
  }
}

// Cosine starts anywhere on the boundary: v <t> = pi (A - A0)/L, ergodic or not.
TEST(MagneticRectangle, HasTheMeanFlightOfSantalo) {
  std::mt19937_64 random(4);
  for (const double rho : {0.05, 0.2, 0.5075, 3.0}) {
    for (const double turn : {1.0, -1.0}) {
      const MagneticRectangle<double> table(1.0, 1.0, 1.0, turn / rho);
      const int n = 100000;
      double sum = 0, square = 0;
      for (int i = 0; i < n; ++i) {
        const double s = uniform(random, 0.0, 1.0), theta = std::acos(uniform(random, -1.0, 1.0));
        const Side side = static_cast<Side>(i % 4);  // each side from its start, counter-clockwise
        Gyration<double> start{s, 0, theta, side};
        if (side == Side::right) start = {1, s, theta + std::numbers::pi / 2, side};
        if (side == Side::top) start = {1 - s, 1, theta + std::numbers::pi, side};
        if (side == Side::left) start = {0, 1 - s, theta - std::numbers::pi / 2, side};
        const double flight = table.arrive(start)->time;
        sum += flight;
        square += flight * flight;
      }
      const double mean = sum / n, error = std::sqrt((square / n - mean * mean) / n);
      const double pinned = rho < 0.5 ? (1 - 2 * rho) * (1 - 2 * rho) : 0;
      EXPECT_WITHIN(mean, std::numbers::pi * (1 - pinned) / 4, 4 * error) << "rho " << rho;
      EXPECT_LT(error, 0.003);
    }
  }
}

TEST(MagneticRectangle, PinsTheShareOfGuidingCentresInside) {
  std::mt19937_64 random(5);
  const double rho = 0.3;
  const MagneticRectangle<double> table(1.0, 1.0, 1.0, 1 / rho);
  const Opening<double> hole{Side::bottom, 0.35, 0.65};
  int pinned = 0, escaped = 0, kept = 0;
  const int n = 20000;
  for (int i = 0; i < n; ++i) {
    const auto end = table.escape(hole, uniform(random, 0.0, 1.0), uniform(random, 0.0, 1.0),
                                  uniform(random, -std::numbers::pi, std::numbers::pi), 50.0);
    ASSERT_FALSE(end.pinned && end.escaped);
    ASSERT_EQ(end.time == 50.0, !end.escaped);
    pinned += end.pinned ? 1 : 0;
    escaped += end.escaped ? 1 : 0;
    kept += !end.pinned && !end.escaped ? 1 : 0;
    if (end.pinned) {
      ASSERT_EQ(end.hits, 0u);
    }
  }
  const double share = (1 - 2 * rho) * (1 - 2 * rho);
  EXPECT_WITHIN(pinned, n * share, 4 * std::sqrt(n * share * (1 - share)));
  EXPECT_GT(escaped, n / 2);
  EXPECT_EQ(pinned + escaped + kept, n);
}

TEST(MagneticRectangle, TheHoleIsClosedAtItsStartAndOpenAtItsEnd) {
  // One half circle of radius 1/8 from (1/4, 0) ends at s = 1/2 up to rounding.
  const MagneticRectangle<double> table(1.0, 1.0, 1.0, 8.0);
  const auto hit = table.arrive({0.25, 0.0, std::numbers::pi / 2, Side::bottom});
  const double s = table.arc_length(*hit);
  EXPECT_WITHIN(s, 0.5, 1e-15);
  const double before = std::nextafter(s, 0), beyond = std::nextafter(s, 1);
  const auto leaves = [&](double from, double to) {
    return table.escape({Side::bottom, from, to}, 0.25, 1e-300, std::numbers::pi / 2, 1.0).hits ==
           0;
  };
  EXPECT_TRUE(leaves(s, beyond));
  EXPECT_TRUE(leaves(before, beyond));
  EXPECT_FALSE(leaves(before, s));
  EXPECT_FALSE(leaves(beyond, 1));
}

}  // namespace
}  // namespace carom::maps
