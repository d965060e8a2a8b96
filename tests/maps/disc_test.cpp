#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "maps/closed/maps.hpp"
#include "maps/within.hpp"

namespace carom::maps {
namespace {

using Real = long double;
constexpr Real pi = maps::pi<Real>;

// Free motion for a time in the field, written with the exponential of the velocity's rotation.
Phase<Real> fly(const Phase<Real>& p, Real omega, Real t) {
  if (omega == 0) return {p.x + t * p.vx, p.y + t * p.vy, p.vx, p.vy};
  const Real s = std::sin(omega * t), half = std::sin(omega * t / 2),
             c = 2 * half * half;  // 1 - cos
  return {p.x + (s * p.vx + c * p.vy) / omega, p.y + (s * p.vy - c * p.vx) / omega,
          p.vx - c * p.vx + s * p.vy, p.vy - c * p.vy - s * p.vx};
}

Real uniform(std::mt19937_64& random, Real low, Real high) {
  return low + (high - low) * static_cast<Real>(random() >> 11) * 0x1p-53L;
}

Real random_omega(std::mt19937_64& random, int i) {
  if (i % 5 == 0) return 0;
  const Real size = std::pow(Real{10}, uniform(random, -3, 2));
  return i % 2 == 0 ? size : -size;
}

TEST(Disc, EachHitIsReachedByTheFlightAndReflected) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 5000; ++i) {
    const Real radius = uniform(random, 0.1L, 3), speed = uniform(random, 0.2L, 2);
    const Real omega = random_omega(random, i);
    const Disc<Real> disc(radius, speed, omega);
    const DiscHit<Real> hit{uniform(random, -pi, pi), uniform(random, -1.57L, 1.57L), 0};
    const DiscHit<Real> next = disc.next(hit);
    ASSERT_GT(next.time, 0);
    const Phase<Real> arrived = fly(disc.phase(hit), omega, next.time), left = disc.phase(next);
    const Real tolerance = 1e-15L * (1 + std::abs(omega));
    ASSERT_WITHIN(arrived.x, left.x, tolerance);
    ASSERT_WITHIN(arrived.y, left.y, tolerance);
    // The velocity before the hit is the mirror image of the one after it.
    const Real c = std::cos(next.theta), s = std::sin(next.theta);
    ASSERT_WITHIN(arrived.vx * c + arrived.vy * s, -(left.vx * c + left.vy * s), tolerance);
    ASSERT_WITHIN(arrived.vy * c - arrived.vx * s, left.vy * c - left.vx * s, tolerance);
    // No wall was passed on the way.
    for (int k = 1; k < 20; ++k) {
      const Phase<Real> p = fly(disc.phase(hit), omega, next.time * static_cast<Real>(k) / 20);
      ASSERT_LT(std::hypot(p.x, p.y), radius);
    }
  }
}

TEST(Disc, RunsBackwardsInTheReversedField) {
  std::mt19937_64 random(2);
  for (int i = 0; i < 1000; ++i) {
    const Real omega = random_omega(random, i);
    const Disc<Real> disc(1, 1, omega), reversed(1, 1, -omega);
    const DiscHit<Real> start{uniform(random, -pi, pi), uniform(random, -1.57L, 1.57L), 0};
    DiscHit<Real> hit = start;
    for (int k = 0; k < 100; ++k) hit = disc.next(hit);
    // Reversing the velocity before the hit gives the outgoing one of the way back.
    const Real time = hit.time;
    hit.beta = -hit.beta;
    for (int k = 0; k < 100; ++k) hit = reversed.next(hit);
    ASSERT_WITHIN(std::remainder(hit.theta - start.theta, 2 * pi), 0, 1e-14L);
    ASSERT_WITHIN(hit.beta, -start.beta, 1e-18L);
    ASSERT_WITHIN(hit.time, 2 * time, 1e-14L * (1 + time));
  }
}

TEST(Disc, ConservesTheCanonicalAngularMomentum) {
  std::mt19937_64 random(3);
  for (int i = 0; i < 200; ++i) {
    const Real omega = random_omega(random, i), radius = uniform(random, 0.5L, 2);
    const Disc<Real> disc(radius, 1, omega);
    DiscHit<Real> hit{uniform(random, -pi, pi), uniform(random, -1.57L, 1.57L), 0};
    const Real first = canonical_angular_momentum(disc.phase(hit), omega);
    for (int k = 0; k < 100; ++k) {
      const Phase<Real> between = fly(disc.phase(hit), omega, (disc.next(hit).time - hit.time) / 3);
      ASSERT_WITHIN(canonical_angular_momentum(between, omega), first,
                    1e-15L * (1 + std::abs(omega)));
      hit = disc.next(hit);
    }
  }
}

TEST(Disc, ManyHitsAtOnceAreThatManyHits) {
  for (const Real omega : {Real{0}, Real{0.7L}, Real{-3}}) {
    const Disc<Real> disc(2, 1, omega);
    DiscHit<Real> hit{0.3L, 0.4L, 0};
    for (int k = 0; k < 1000; ++k) hit = disc.next(hit);
    const DiscHit<Real> at_once = disc.after({0.3L, 0.4L, 0}, 1000);
    EXPECT_WITHIN(hit.theta, at_once.theta, 1e-13L);
    EXPECT_WITHIN(hit.time, at_once.time, 1e-13L);
  }
}

TEST(Disc, ClosesItsPolygonsAndStars) {
  for (int corners = 3; corners < 12; ++corners) {
    const Disc<Real> disc(1, 1, 0);
    const Real beta = pi / 2 - pi / static_cast<Real>(corners);  // theta advances by 2 pi / corners
    const DiscHit<Real> hit = disc.after({0.1L, beta, 0}, static_cast<std::uint64_t>(corners));
    EXPECT_WITHIN(hit.theta, 0.1L + 2 * pi, 1e-16L * 50);
    EXPECT_WITHIN(hit.time,
                  2 * static_cast<Real>(corners) * std::sin(pi / static_cast<Real>(corners)),
                  1e-16L * 50);
  }
  // Perpendicular starts with rho = R: quarter arcs about the corners of a square, four to a turn.
  const Disc<Real> disc(1, 1, 1);
  const DiscHit<Real> hit = disc.after({0, 0, 0}, 4);
  EXPECT_WITHIN(hit.theta, 2 * pi, 1e-17L);
  EXPECT_WITHIN(hit.time, 2 * pi, 1e-17L);
}

TEST(Disc, AWeakFieldIsAlmostNone) {
  const DiscHit<Real> start{0.2L, -0.9L, 0};
  const DiscHit<Real> straight = Disc<Real>(1, 1, 0).next(start);
  for (const Real omega : {1e-9L, -1e-9L}) {
    const DiscHit<Real> curved = Disc<Real>(1, 1, omega).next(start);
    const Real change = std::remainder(curved.theta - straight.theta, 2 * pi);
    EXPECT_WITHIN(change, 0, 2e-9L);
    EXPECT_NE(change, 0);
    EXPECT_WITHIN(curved.time, straight.time, 2e-9L);
  }
}

// With cosine starts the mean flight is pi (A - A0)/L, A0 = pi (R - rho)^2 for rho < R. The mean
// over sin(beta) is taken by midpoints, so this is the formula and no statistics.
TEST(Disc, HasTheMeanFlightOfSantalo) {
  for (const Real rho : {Real{0.1L}, Real{0.5L}, Real{0.9L}, Real{1.5L}, Real{20}}) {
    const Disc<Real> disc(1, 2, 2 / rho);
    const int n = 400000;
    Real sum = 0;
    for (int i = 0; i < n; ++i) {
      sum += 2 * disc.next({0, std::asin(-1 + (2 * static_cast<Real>(i) + 1) / n), 0}).time;
    }
    const Real pinned = rho < 1 ? (1 - rho) * (1 - rho) : 0;
    EXPECT_WITHIN(sum / n, pi * (1 - pinned) / 2, 2e-6L);
  }
}

TEST(Disc, FindsTheFirstHitFromInside) {
  std::mt19937_64 random(4);
  int pinned = 0;
  for (int i = 0; i < 5000; ++i) {
    const Real omega = random_omega(random, i), angle = uniform(random, -pi, pi);
    const Real r = uniform(random, 0, 0.999L), phi = uniform(random, -pi, pi);
    const Phase<Real> start{r * std::cos(phi), r * std::sin(phi), std::cos(angle), std::sin(angle)};
    const Disc<Real> disc(1, 1, omega);
    const auto hit = disc.first_hit(start);
    if (!hit) {
      ++pinned;
      const Real gyro = std::hypot(start.x + start.vy / omega, start.y - start.vx / omega);
      ASSERT_LE(gyro + 1 / std::abs(omega), 1 + 1e-15L);
      continue;
    }
    ASSERT_GE(hit->time, 0);
    const Phase<Real> arrived = fly(start, omega, hit->time), left = disc.phase(*hit);
    const Real tolerance = 1e-15L * (1 + std::abs(omega));
    ASSERT_WITHIN(arrived.x, left.x, tolerance);
    ASSERT_WITHIN(arrived.y, left.y, tolerance);
    ASSERT_WITHIN(arrived.vx * left.vx + arrived.vy * left.vy, -std::cos(2 * hit->beta),
                  100 * tolerance);
    for (int k = 1; k < 20; ++k) {
      const Phase<Real> p = fly(start, omega, hit->time * static_cast<Real>(k) / 20);
      ASSERT_LT(std::hypot(p.x, p.y), 1);
    }
  }
  EXPECT_GT(pinned, 500);
  // A weak field costs no digits.
  const Phase<Real> start{0.25L, -0.5L, 0.6L, 0.8L};
  const auto straight = Disc<Real>(1.5L, 1, 0).first_hit(start);
  const auto curved = Disc<Real>(1.5L, 1, 1e-12L).first_hit(start);
  EXPECT_WITHIN(curved->theta, straight->theta, 3e-12L);
  EXPECT_WITHIN(curved->beta, straight->beta, 3e-12L);
}

}  // namespace
}  // namespace carom::maps
