// What motion conserves, over long orbits; reversal of time.
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
Departure<Function> follow(const Table& table, double omega, Vector position, Vector velocity,
                           std::uint64_t hits, Function function) {
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

TEST(Invariants, ProductOfAngularMomentaAboutTheFociIsKept) {
  const Table table = loop({Ellipse{{0, 0}, {1, 0}, 0.75, true}});
  const double focus = std::sqrt(1 - 0.5625);
  int signs = 0;
  for (const Vector x : {Vector{0.1, 0.05}, Vector{0.3, 0.05}, Vector{0.5, 0.05}, Vector{0.7, 0.05},
                         Vector{0.9, 0.1}}) {
    const auto seen = follow(table, 0.0, x, {0.6, 0.8}, 1'000'000, [&](const HitEvent& e) {
      return angular_momentum(e, {focus, 0}) * angular_momentum(e, {-focus, 0});
    });
    std::printf("ellipse: product %+.6f departs by %.1e at most, %.1e a hit\n", seen.first,
                seen.largest, seen.last / 1e6);
    EXPECT_LT(seen.largest, 2e-12);
    signs |= seen.first > 0 ? 1 : 2;
  }
  EXPECT_EQ(signs, 3);  // orbits around both foci, and between them
}

TEST(Invariants, AnOrbitInTheMushroomsCapStaysThere) {
  const Table table = loop({Segment{{-0.5, -1}, {0.5, -1}}, Segment{{0.5, -1}, {0.5, 0}},
                            Segment{{0.5, 0}, {1, 0}}, CircularArc{{1, 0}, {-1, 0}, 0, true},
                            Segment{{-1, 0}, {-0.5, 0}}, Segment{{-0.5, 0}, {-0.5, -1}}});
  // Angular momenta 0.51 … 0.95 of a unit circle: the caustic's radius exceeds half the stem's
  // width.
  for (const double momentum : {0.51, 0.6, 0.75, 0.95}) {
    bool in_stem = false;
    const auto seen =
        follow(table, 0.0, {momentum, 0.125}, {0.0, 1.0}, 1'000'000, [&](const HitEvent& e) {
          in_stem = in_stem || e.position.y < 0.0;
          return std::fabs(angular_momentum(e));
        });
    std::printf("mushroom: |L| = %.2f departs by %.1e at most\n", momentum, seen.largest);
    EXPECT_FALSE(in_stem);
    EXPECT_LT(seen.largest, 1e-12);
  }
}

TEST(Invariants, CanonicalAngularMomentumIsKeptInADiscWithField) {
  for (const double radius : {1.0, 1.5})
    for (const double omega : {0.3, -0.7, 1e-6, 5.0}) {
      const auto seen = follow(
          disc(radius), omega, {radius - 0.3, 0.05}, {0.6, 0.8}, 1'000'000, [&](const HitEvent& e) {
            return angular_momentum(e) + 0.5 * omega * dot(e.position, e.position);
          });
      std::printf("disc %.1f, omega %+.0e: L departs by %.1e at most, %.1e a hit\n", radius, omega,
                  seen.largest, seen.last / 1e6);
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
double reversal_error(const Table& table, double omega, Vector position, Vector velocity,
                      std::uint64_t hits) {
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

}  // namespace
}  // namespace carom::tests
