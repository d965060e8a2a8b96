// The engine and the map of the disc hit by hit: all its orbits are regular.
#include <gtest/gtest.h>

#include <cmath>

#include "maps/closed/maps.hpp"
#include "maps/engine.hpp"
#include "maps/within.hpp"

namespace carom {
namespace {

using Real = long double;
constexpr Real two_pi = 2 * maps::pi<Real>;

struct Difference {
  Real angle = 0, time = 0, momentum = 0;
};

// Largest differences over the hits, measured against the map started at the engine's first hit.
Difference compare(double omega, double radius, const State& start, std::uint64_t count) {
  const Table table = witness::table("circle", {{"radius", ExactNumber(radius).text()}});
  const double speed = std::hypot(start.velocity.x, start.velocity.y);
  const auto hits = witness::orbit(table, {1, 1, speed, omega}, start, count);
  EXPECT_EQ(hits.size(), count);
  const Real r = radius, w = omega;
  const maps::Disc<Real> disc(r, speed, w);
  const maps::Phase<Real> phase{start.position.x, start.position.y, start.velocity.x,
                                start.velocity.y};
  const auto first = disc.first_hit(phase);
  const Real momentum = maps::canonical_angular_momentum(phase, w);
  Difference largest;
  for (std::size_t n = 0; n < hits.size(); ++n) {
    const HitEvent& hit = hits[n];
    const auto expected = disc.after(*first, n);
    const Real theta =
        std::atan2(static_cast<Real>(hit.position.y), static_cast<Real>(hit.position.x));
    const Real time = static_cast<Real>(hit.time.high) + static_cast<Real>(hit.time.low);
    const maps::Phase<Real> after{hit.position.x, hit.position.y, hit.after.x, hit.after.y};
    largest.angle =
        std::max(largest.angle, std::abs(std::remainder(theta - expected.theta, two_pi)));
    largest.time = std::max(largest.time, std::abs(time - expected.time));
    largest.momentum =
        std::max(largest.momentum, std::abs(maps::canonical_angular_momentum(after, w) - momentum));
  }
  return largest;
}

constexpr std::uint64_t many = 1000000;

struct DiscCase {
  double radius, omega;
};
class DiscField : public ::testing::TestWithParam<DiscCase> {};

// A rounding of 2^-53 a hit that always has the same sign makes the momentum drift like n 2^-53,
// and the angle and the time like n^2 2^-53; a wrong decision would be of the order 1.
TEST_P(DiscField, AgreesForAMillionHits) {
  const auto [radius, omega] = GetParam();
  State start;
  start.position = {0.25 * radius, -0.5 * radius};
  start.velocity = {-0.28, 0.96};  // sin(beta) = 1/10 at B = 0: not a closed orbit
  const Difference d = compare(omega, radius, start, many);
  EXPECT_LT(d.momentum, 0x1p-53L * many * radius);
  EXPECT_LT(d.angle, 0x1p-53L * many * many);
  EXPECT_LT(d.time, 0x1p-53L * many * many * radius);
  std::printf("R %g, omega %g: angle %.2Lg, time %.2Lg, momentum %.2Lg\n", radius, omega, d.angle,
              d.time, d.momentum);
}

INSTANTIATE_TEST_SUITE_P(Fields, DiscField,
                         ::testing::Values(DiscCase{1, 0}, DiscCase{1.5, 0}, DiscCase{1, 1},
                                           DiscCase{1.5, -1.2}, DiscCase{3, 0.01},
                                           DiscCase{1, 1e-6}));

// The speed of the shell and the one that flights are timed by agree beyond their last digits: else
// each hit would lie off its wall by the difference, always to the same side, and the momentum
// would drift by 2^-53 a hit.
TEST(DiscOrbit, KeepsItsMomentumAtAnySpeed) {
  for (const double speed : {1.3, 0.9, 0.7})
    for (const double radius : {1.0, 0.77, 1.7}) {
      State start;
      start.position = {0.21, 0.2};
      start.velocity = {0.6 * speed, 0.8 * speed};
      const Difference d = compare(0.0, radius, start, many);
      EXPECT_LT(d.momentum, 0x1p-56L * many * speed * radius) << speed << " " << radius;
    }
}

TEST(DiscOrbit, GrazesTheWallForALongTime) {
  // A whispering orbit: sin(beta) close to 1, so the hits are close together.
  State start;
  start.position = {0, -0.999};
  start.velocity = {1, 0};
  for (const double omega : {0.0, 0.5, -0.5}) {
    const Difference d = compare(omega, 1.0, start, 100000);
    EXPECT_LT(d.angle, 1e-7L);
    EXPECT_LT(d.time, 1e-7L);
    EXPECT_LT(d.momentum, 1e-13L);
  }
}

TEST(DiscOrbit, IsPinnedWhereTheMapHasNoHit) {
  const Table table = witness::table("circle", {{"radius", "1"}});
  for (const double x : {-0.9, -0.5, 0.0, 0.1, 0.35, 0.4, 0.8}) {
    for (const double omega : {2.0, -2.0, 5.0, 0.5}) {
      World world(table);
      State start;
      start.position = {x, 0.1};
      start.velocity = {0, 1};
      world.add({1, 1, 1, omega}, start);
      world.limit_hits(1);
      witness::Recorder recorder;
      world.run_until(1000, recorder);
      const bool hits = maps::Disc<Real>(1, 1, omega).first_hit({x, 0.1L, 0, 1}).has_value();
      EXPECT_EQ(world.fate(0) == Fate::pinned, !hits) << "x " << x << ", omega " << omega;
    }
  }
}

}  // namespace
}  // namespace carom
