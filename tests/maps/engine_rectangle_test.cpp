// The engine and the maps of the rectangle: unfolding without a field, angles with one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>

#include "maps/closed/maps.hpp"
#include "maps/engine.hpp"

namespace carom {
namespace {

using Real = long double;

Real instant(Time time) { return static_cast<Real>(time.high) + static_cast<Real>(time.low); }

TEST(EngineRectangle, IsTheUnfoldedLineForAMillionHits) {
  const Table table = witness::table("rectangle", {{"width", "1.5"}, {"height", "1"}});
  State start;
  start.position = {0.3, 0.7};
  start.velocity = {0.6, 0.8};
  for (const geometry::Vector velocity :
       {geometry::Vector{0.6, 0.8}, geometry::Vector{-0.28, 0.96}}) {
    start.velocity = velocity;
    const double speed = std::sqrt(velocity.x * velocity.x + velocity.y * velocity.y);
    const auto hits = witness::orbit(table, {1, 1, speed, 0}, start, 1000000);
    const auto expected =
        maps::Rectangle<Real>(1.5L, 1).hits({0.3, 0.7, velocity.x, velocity.y}, hits.size());
    ASSERT_EQ(hits.size(), 1000000u);
    Real time = 0, place = 0;
    std::size_t corners = 0;
    for (std::size_t n = 0; n < hits.size(); ++n) {
      // Two hits nearer in time than rounding may come in either order.
      const auto& e = expected[n];
      if (hits[n].wall != static_cast<int>(e.side)) {
        ++corners;
        ASSERT_LT(std::abs(instant(hits[n].time) - e.time), 1e-8L) << "hit " << n;
        continue;
      }
      time = std::max(time, std::abs(instant(hits[n].time) - e.time));
      place = std::max({place, std::abs(hits[n].position.x - e.phase.x),
                        std::abs(hits[n].position.y - e.phase.y)});
    }
    EXPECT_LT(time, 1e-8L);
    EXPECT_LT(place, 1e-8L);
    EXPECT_LE(corners, 4u);
    std::printf("rectangle: time %.2Lg, place %.2Lg, corners %zu\n", time, place, corners);
  }
}

// Regular: the scallops along the walls of the square.
TEST(EngineMagneticRectangle, KeepsToTheScallopsForAMillionHits) {
  const Table table = witness::table("rectangle", {{"width", "1"}, {"height", "1"}});
  for (const double omega : {10.0, -10.0}) {
    State start;
    start.position = {0.5, 0.001};
    start.velocity = {0.0, 1.0};
    const auto hits = witness::orbit(table, {1, 1, 1, omega}, start, 1000000);
    const maps::MagneticRectangle<Real> map(1, 1, 1, omega);
    maps::Gyration<Real> particle{0.5L, static_cast<Real>(0.001), maps::pi<Real> / 2};
    Real place = 0, time = 0;
    for (const HitEvent& hit : hits) {
      particle = *map.next(particle);
      ASSERT_EQ(static_cast<int>(particle.side), hit.wall);
      place = std::max(
          {place, std::abs(hit.position.x - particle.x), std::abs(hit.position.y - particle.y)});
      time = std::max(time, std::abs(instant(hit.time) - particle.time));
    }
    EXPECT_EQ(hits.size(), 1000000u);
    EXPECT_LT(place, 1e-6L);
    EXPECT_LT(time, 1e-6L);
    std::printf("scallops, omega %g: place %.2Lg, time %.2Lg\n", omega, place, time);
  }
}

// Chaotic: hit by hit until rounding has grown. The map in long double is the truth for the engine
// and for the map in double, which are both orbits with roundings of 2^-53: the engine must keep up
// with the latter.
TEST(EngineMagneticRectangle, FollowsChaosUntilRoundingHasGrown) {
  const Table table = witness::table("rectangle", {{"width", "1"}, {"height", "1"}});
  std::mt19937_64 random(7);
  const auto uniform = [&random] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  double engine_length = 0, map_length = 0, error_ratio = 0;
  const int orbits = 200;
  const std::size_t most = 400;
  int compared = 0;
  for (int i = 0; i < orbits; ++i) {
    const double rho = 0.5075, turn = i % 2 == 0 ? 1 : -1;
    State start;
    start.position = {uniform(), uniform()};
    const double angle = 2 * std::numbers::pi * uniform();
    start.velocity = {std::cos(angle), std::sin(angle)};
    const double speed =
        std::sqrt(start.velocity.x * start.velocity.x + start.velocity.y * start.velocity.y);
    const double omega = turn / rho;
    const auto hits = witness::orbit(table, {1, 1, speed, omega}, start, most);
    ASSERT_EQ(hits.size(), most);
    const Real exact_angle =
        std::atan2(static_cast<Real>(start.velocity.y), static_cast<Real>(start.velocity.x));
    const Real exact_speed =
        std::hypot(static_cast<Real>(start.velocity.x), static_cast<Real>(start.velocity.y));
    const maps::MagneticRectangle<Real> fine(1, 1, exact_speed, omega);
    const maps::MagneticRectangle<double> coarse(1, 1, static_cast<double>(exact_speed), omega);
    maps::Gyration<Real> truth{start.position.x, start.position.y, exact_angle};
    maps::Gyration<double> rounded{start.position.x, start.position.y,
                                   static_cast<double>(exact_angle)};
    bool engine_follows = true, map_follows = true;
    for (std::size_t n = 0; n < most && (engine_follows || map_follows); ++n) {
      truth = *fine.next(truth);
      rounded = *coarse.next(rounded);
      const HitEvent& hit = hits[n];
      const Real engine_error =
          std::max({std::abs(hit.position.x - truth.x), std::abs(hit.position.y - truth.y)});
      const Real map_error =
          std::max({std::abs(rounded.x - truth.x), std::abs(rounded.y - truth.y)});
      engine_follows =
          engine_follows && engine_error < 1e-4L && hit.wall == static_cast<int>(truth.side);
      map_follows = map_follows && map_error < 1e-4L && rounded.side == truth.side;
      if (n < 5) {  // a few hits: nothing but rounding
        ASSERT_EQ(hit.wall, static_cast<int>(truth.side));
        ASSERT_LT(engine_error, 1e-11L) << "orbit " << i << " hit " << n;
        error_ratio = std::max(error_ratio, static_cast<double>(engine_error));
      }
      engine_length += engine_follows ? 1 : 0;
      map_length += map_follows ? 1 : 0;
    }
    ++compared;
  }
  std::printf(
      "chaos: engine follows %.1f hits, map in double %.1f, largest error in five hits %.2g\n",
      engine_length / compared, map_length / compared, error_ratio);
  EXPECT_GT(engine_length, 0.9 * map_length);
  EXPECT_GT(engine_length / compared, 20);
}

}  // namespace
}  // namespace carom
