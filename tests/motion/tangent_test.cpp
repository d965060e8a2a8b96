// Tangent maps by themselves: structure to rounding, and differences of flights.
#include "carom/motion/tangent.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "motion/free_motion.hpp"
#include "random_tables.hpp"

namespace carom {

using namespace motion;

namespace {

using geometry::Vector;
using tests::Dice;

// The form that motion in a field keeps: dx dv_x + dy dv_y - omega dx dy.
double form(const Deviation& a, const Deviation& b, double omega) {
  return dot(a.position, b.velocity) - dot(b.position, a.velocity) -
         omega * cross(a.position, b.position);
}
Deviation any(Dice& dice) {
  return {{dice.between(-1, 1), dice.between(-1, 1)}, {dice.between(-1, 1), dice.between(-1, 1)}};
}
// An incoming velocity that does not graze.
Vector incoming(Dice& dice, Vector normal) {
  const Vector tangent = right(normal);
  return dice.between(-1, 1) * tangent - dice.between(0.1, 1) * normal;
}

TEST(Tangent, FlightsKeepTheSymplecticForm) {
  Dice dice(1);
  for (int i = 0; i < 1000; ++i) {
    const double omega = i % 5 == 0 ? 0.0 : dice.between(-3, 3);
    const FlightTangent flight = flight_tangent(omega, dice.between(0, 4));
    const Deviation a = any(dice), b = any(dice);
    EXPECT_NEAR(form(flight(a), flight(b), omega), form(a, b, omega), 1e-13);
    EXPECT_NEAR(dot(flight.before(b), a), dot(b, flight(a)), 1e-13);
  }
}

TEST(Tangent, ReflectionsKeepTheSymplecticForm) {
  Dice dice(2);
  for (int i = 0; i < 1000; ++i) {
    const Vector normal = dice.direction();
    const double omega = i % 5 == 0 ? 0.0 : dice.between(-3, 3), curvature = dice.between(-3, 3);
    const ReflectionTangent map =
        reflection_tangent(normal, curvature, incoming(dice, normal), omega);
    const Deviation a = any(dice), b = any(dice);
    EXPECT_NEAR(form(map(a), map(b), omega), form(a, b, omega), 1e-10);
  }
}

TEST(Tangent, TheFlowsOwnDirectionIsCarriedAlong) {
  // A state a little later is on the same orbit, before and after; and it has no delay-free
  // displacement.
  Dice dice(3);
  for (int i = 0; i < 1000; ++i) {
    const Vector normal = dice.direction(), v = incoming(dice, normal);
    const double omega = dice.between(-3, 3);
    const ReflectionTangent map = reflection_tangent(normal, dice.between(-3, 3), v, omega);
    const Deviation image = map({v, omega * right(v)});
    const Vector after = map.mirrored(v), force = omega * right(after);
    EXPECT_NEAR(image.position.x, after.x, 1e-12);
    EXPECT_NEAR(image.position.y, after.y, 1e-12);
    EXPECT_NEAR(image.velocity.x, force.x, 1e-10);
    EXPECT_NEAR(image.velocity.y, force.y, 1e-10);
    const AtWall at = at_wall(normal, after, omega);
    EXPECT_NEAR(dot(at.arc, image), 0.0, 1e-10);
    EXPECT_NEAR(dot(at.delay, image), -1.0, 1e-12);
    EXPECT_NEAR(dot(at.angle, image), 0.0, 1e-10);
  }
}

TEST(Tangent, FlightsAgreeWithDifferences) {
  Dice dice(4);
  for (int i = 0; i < 200; ++i) {
    const double omega = i % 5 == 0 ? 0.0 : dice.between(-3, 3), t = dice.between(0, 4),
                 h = 0x1p-20;
    const Vector x = dice.direction(), v = dice.direction();
    const Deviation d = any(dice), image = flight_tangent(omega, t)(d);
    const auto [x1, v1] = moved(x + h * d.position, v + h * d.velocity, omega, t);
    const auto [x0, v0] = moved(x - h * d.position, v - h * d.velocity, omega, t);
    const Vector dx = (0.5 / h) * (x1 - x0), dv = (0.5 / h) * (v1 - v0);
    EXPECT_NEAR(image.position.x, dx.x, 1e-8);
    EXPECT_NEAR(image.position.y, dx.y, 1e-8);
    EXPECT_NEAR(image.velocity.x, dv.x, 1e-8);
    EXPECT_NEAR(image.velocity.y, dv.y, 1e-8);
  }
}

}  // namespace
}  // namespace carom
