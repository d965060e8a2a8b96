// What motion conserves, over long orbits; reversal of time; Larmor radii over eighteen decades.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "carom/geometry/curve.hpp"
#include "events/recorder.hpp"

namespace carom::tests {
namespace {

/// Largest departure of a function of a hit from its first value, over an orbit.
template <class Function>
struct Departure : Observer {
  Function function;
  double first = 0.0, largest = 0.0, last = 0.0;
  std::uint64_t hits = 0;
  explicit Departure(Function f) : function(f) {}
  void hit(const HitEvent& e) override {
    const double value = function(e);
    if (hits++ == 0) first = value;
    last = value - first;
    largest = std::max(largest, std::fabs(last));
  }
};

template <class Function>
Departure<Function> follow(const Table& table, double omega, Vector position, Vector velocity, std::uint64_t hits,
                           Function function) {
  World world(table);
  world.add(particle(omega), start(position, velocity));
  world.limit_hits(hits);
  Departure<Function> seen(function);
  world.run_until(1e300, seen);
  EXPECT_EQ(world.fate(0), Fate::capped);
  return seen;
}

double angular_momentum(const HitEvent& e, Vector about = {0.0, 0.0}) {
  return cross(e.position - about, e.after);
}

TEST(Invariants, ProductOfAngularMomentaAboutTheFociOfAnEllipse) {
  const Table table = loop({Ellipse{{0, 0}, {1, 0}, 0.75, true}});
  const double focus = std::sqrt(1 - 0.5625);
  int signs = 0;
  for (const Vector x : {Vector{0.1, 0.05}, Vector{0.3, 0.05}, Vector{0.5, 0.05}, Vector{0.7, 0.05}, Vector{0.9, 0.1}}) {
    const auto seen = follow(table, 0.0, x, {0.6, 0.8}, 1'000'000, [&](const HitEvent& e) {
      return angular_momentum(e, {focus, 0}) * angular_momentum(e, {-focus, 0});
    });
    std::printf("ellipse: product %+.6f departs by %.1e at most, %.1e a hit\n", seen.first, seen.largest,
                seen.last / 1e6);
    EXPECT_LT(seen.largest, 2e-12);
    signs |= seen.first > 0 ? 1 : 2;
  }
  EXPECT_EQ(signs, 3);  // orbits around both foci, and between them
}

TEST(Invariants, AnOrbitInTheMushroomsCapStaysThere) {
  const Table table = loop({Segment{{-0.5, -1}, {0.5, -1}}, Segment{{0.5, -1}, {0.5, 0}}, Segment{{0.5, 0}, {1, 0}},
                            CircularArc{{1, 0}, {-1, 0}, 0, true}, Segment{{-1, 0}, {-0.5, 0}},
                            Segment{{-0.5, 0}, {-0.5, -1}}});
  // Angular momenta 0.51 … 0.95 of a unit circle: the caustic's radius exceeds half the stem's width.
  for (const double momentum : {0.51, 0.6, 0.75, 0.95}) {
    bool in_stem = false;
    const auto seen = follow(table, 0.0, {momentum, 0.125}, {0.0, 1.0}, 1'000'000, [&](const HitEvent& e) {
      in_stem = in_stem || e.position.y < 0.0;
      return std::fabs(angular_momentum(e));
    });
    std::printf("mushroom: |L| = %.2f departs by %.1e at most\n", momentum, seen.largest);
    EXPECT_FALSE(in_stem);
    EXPECT_LT(seen.largest, 1e-12);
  }
}

TEST(Invariants, CanonicalAngularMomentumInADiscWithField) {
  for (const double radius : {1.0, 1.5})
    for (const double omega : {0.3, -0.7, 1e-6, 5.0}) {
      const auto seen = follow(disc(radius), omega, {radius - 0.3, 0.05}, {0.6, 0.8}, 1'000'000, [&](const HitEvent& e) {
        return angular_momentum(e) + 0.5 * omega * dot(e.position, e.position);
      });
      std::printf("disc %.1f, omega %+.0e: L departs by %.1e at most, %.1e a hit\n", radius, omega, seen.largest,
                  seen.last / 1e6);
      EXPECT_LT(seen.largest, 5e-10);
    }
}

TEST(Invariants, TheSpeedStaysOnItsShell) {
  for (const double omega : {0.0, 0.8})
    for (const double speed : {1.0, 0.1, 1000.0}) {
      const Table table = stadium();
      World world(table);
      world.add(particle(omega * speed, speed), start({0.1, 0.2}, speed * Vector{0.6, 0.8}));
      world.limit_hits(300'000);
      Departure seen([&](const HitEvent& e) { return std::sqrt(dot(e.after, e.after)) / speed; });
      world.run_until(1e300, seen);
      EXPECT_LT(seen.largest, 4e-15);
      EXPECT_NEAR(seen.first, 1.0, 4e-15);
    }
}

/// After `hits` hits the velocity and the field are turned round, and the orbit runs back.
double reversal_error(const Table& table, double omega, Vector position, Vector velocity, std::uint64_t hits) {
  World there(table);
  there.add(particle(omega), start(position, velocity));
  there.limit_hits(hits);
  Recorder forth;
  there.run_until(1e300, forth);
  EXPECT_EQ(forth.hits.size(), hits);
  State turned = there.state(0);
  turned.velocity = -forth.hits.back().before;
  World back(table);
  back.add(particle(-omega), turned);
  back.limit_hits(hits - 1);
  Recorder home;
  back.run_until(1e300, home);
  EXPECT_EQ(home.hits.size(), hits - 1);
  const Vector d = home.hits.back().position - forth.hits.front().position;
  return std::sqrt(dot(d, d));
}

TEST(Invariants, RegularOrbitsRunBack) {
  const Table ellipse = loop({Ellipse{{0, 0}, {1, 0}, 0.75, true}});
  EXPECT_LT(reversal_error(disc(1.0), 0.0, {0.3, 0.1}, {0.6, 0.8}, 100), 1e-12);
  EXPECT_LT(reversal_error(disc(1.0), 0.4, {0.8, 0.1}, {0.0, 1.0}, 100), 1e-12);
  EXPECT_LT(reversal_error(disc(1.0), 1.5, {0.8, 0.1}, {0.0, 1.0}, 100), 1e-12);
  EXPECT_LT(reversal_error(ellipse, 0.0, {0.3, 0.1}, {0.6, 0.8}, 100), 1e-12);
  EXPECT_LT(reversal_error(ellipse, 1.0 / 3.0, {0.0, 0.05}, {0.0, 1.0}, 100), 1e-12);
  EXPECT_LT(reversal_error(square(), 0.0, {0.3, 0.1}, {0.6, 0.8}, 100), 1e-12);
}

TEST(Invariants, ChaoticOrbitsRunBackAsFarAsRoundingLets) {
  EXPECT_LT(reversal_error(stadium(), 0.0, {0.1, 0.2}, {0.6, 0.8}, 8), 1e-9);
  EXPECT_LT(reversal_error(stadium(), 0.5, {0.1, 0.2}, {0.6, 0.8}, 8), 1e-9);
}

// One flight from (0.125, 0) on the bottom of the unit square against the same in long double by the formula of
// the chord: t from the height, without the variable kappa of the engine.
TEST(Invariants, LarmorRadiiOverEighteenDecades) {
  const Table table = square();
  for (int decade = -6; decade <= 12; ++decade) {
    if (decade == 0) continue;  // ends at a side: covered by the map of the rectangle
    const double radius = std::pow(10.0, decade), omega = 1.0 / radius;
    World world(table);
    State s;
    s.wall = 0;
    s.u = 0.125;
    s.velocity = {0.6, 0.8};
    world.add(particle(omega), s);
    world.limit_hits(1);
    Recorder seen;
    world.run_until(1e300, seen);
    ASSERT_EQ(seen.hits.size(), 1u);
    const HitEvent& hit = seen.hits[0];
    const long double r = 1.0L / omega;  // the exact radius of the rounded omega
    // Velocity at angle a = theta - omega t; y(t) = r (cos(a) - cos(theta)).
    const long double theta = std::atan2(0.8L, 0.6L);
    long double t = 0.0L;
    if (decade < 0 || r * (1.0L - 0.6L) < 1.0L) {
      t = 2.0L * theta * r;  // back to the bottom: cos(theta - omega t) = cos(theta)
      EXPECT_EQ(hit.wall, 0);
    } else {
      // y = 2 r sin(omega t/2) sin(theta - omega t/2) = 1, by Newton from the straight flight.
      t = 1.25L;
      for (int i = 0; i < 60; ++i) {
        const long double half = 0.5L * t / r;
        const long double y = 2.0L * r * std::sin(half) * std::sin(theta - half);
        t -= (y - 1.0L) / std::sin(theta - 2.0L * half);
      }
      EXPECT_EQ(hit.wall, 2);
    }
    EXPECT_NEAR(hit.time.value() / static_cast<double>(t), 1.0, 8e-16) << "radius 1e" << decade;
    const long double half = 0.5L * t / r;
    const double x = static_cast<double>(0.125L + 2.0L * r * std::sin(half) * std::cos(theta - half));
    EXPECT_NEAR(hit.position.x, x, 4e-16) << "radius 1e" << decade;
    EXPECT_NEAR(hit.before.x, static_cast<double>(std::cos(theta - 2.0L * half)), 6e-16) << "radius 1e" << decade;
    EXPECT_NEAR(hit.before.y, static_cast<double>(std::sin(theta - 2.0L * half)), 6e-16) << "radius 1e" << decade;
  }
}

}  // namespace
}  // namespace carom::tests
