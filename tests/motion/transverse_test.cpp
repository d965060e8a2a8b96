// Deviations across an orbit: the tangent map itself, seen across it.
#include "carom/motion/transverse.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "carom/geometry/curve_frame.hpp"
#include "motion/free_tangent.hpp"
#include "random_tables.hpp"

namespace carom {
namespace {

using geometry::Vector;
using tests::Dice;

// Any deviation to an orbit of the same speed.
Deviation at_speed(Dice& dice, const Vector& v) {
  return {{dice.between(-1, 1), dice.between(-1, 1)}, dice.between(-1, 1) * left(v)};
}
double omega_of(Dice& dice, int i) { return i % 4 == 0 ? 0.0 : dice.between(-3, 3); }

TEST(Transverse, AShiftAlongTheOrbitIsNone) {
  Dice dice(1);
  for (int i = 0; i < 100; ++i) {
    const double omega = omega_of(dice, i);
    const Vector v = dice.spread(0.1, 10) * dice.direction();
    const Transverse w = across({v, omega * right(v)}, v, omega);
    EXPECT_NEAR(w.place, 0.0, 1e-14 * std::sqrt(dot(v, v)));
    EXPECT_NEAR(w.rate, 0.0, 1e-14 * dot(v, v));
  }
}

TEST(Transverse, FlightsAreThoseOfTheWholeMap) {
  Dice dice(2);
  for (int i = 0; i < 1000; ++i) {
    const double omega = omega_of(dice, i), t = dice.between(0, 4);
    const Vector v = dice.spread(0.3, 3) * dice.direction();
    const FlightTangent flight = flight_tangent(omega, t);
    const Deviation d = at_speed(dice, v), end = flight(d);
    const Vector after = flight.c * v + flight.s * right(v),
                 way = flight.a * v + flight.b * right(v);
    const Transverse expected = across(end, after, omega), before = across(d, v, omega);
    for (const Transverse& w : {flown(before, transverse_flight(flight, omega)),
                                flown(before, flight_over(way, v, 1.0 / dot(v, v), omega))}) {
      EXPECT_NEAR(w.place, expected.place, 1e-13) << i;
      EXPECT_NEAR(w.rate, expected.rate, 1e-13) << i;
    }
    if (omega == 0.0) {
      EXPECT_NEAR(flown(before, t).place, expected.place, 1e-13);
    }
  }
}

TEST(Transverse, ReflectionsAreThoseOfTheWholeMapButForOneSign) {
  Dice dice(3);
  const geometry::Curve curves[] = {geometry::Segment{{0.1, -0.3}, {0.7, 0.4}},
                                    geometry::Circle{{0.2, 0.1}, 0.7, true},
                                    geometry::Circle{{0.2, 0.1}, 0.7, false},
                                    geometry::CircularArc{{-0.5, 0.2}, {0.4, -0.1}, 0.3, true},
                                    geometry::Ellipse{{0.3, -0.2}, {0.4, 0.3}, 1.7, true},
                                    geometry::Ellipse{{0.3, -0.2}, {0.4, 0.3}, 0.6, false}};
  for (int i = 0; i < 1200; ++i) {
    const geometry::Curve& curve = curves[i % 6];
    const geometry::CurveFrame frame = geometry::frame_of(curve);
    const double omega = omega_of(dice, i);
    const double u = dice.between(0.05, 0.95) * geometry::end_parameter(curve);
    const Vector x = geometry::point_at(frame, u), n = geometry::normal_at(frame, u),
                 v = dice.spread(0.3, 3) *
                     (dice.between(-1, 1) * right(n) - dice.between(0.1, 1) * n);
    const ReflectionTangent map = reflection_tangent(n, geometry::curvature_at(frame, u), v, omega);
    const Vector after = map.mirrored(v);
    const Deviation d = at_speed(dice, v);
    const Transverse expected = across(map(d), after, omega), before = across(d, v, omega);
    const double size = 1.0 + std::fabs(expected.rate), square = dot(after, after);
    const WallForm<double> form = motion::wall_form(curve);
    const double g = transverse_kick(form, x, after, square, omega);
    const Transverse w = reflected(before, g);
    EXPECT_NEAR(-w.place, expected.place, 1e-13) << i;
    EXPECT_NEAR(-w.rate, expected.rate, 1e-12 * size) << i;
    if (i % 6 < 4) {
      EXPECT_EQ(
          kick_of_circle_or_line<double>({form.center_x, form.center_y}, form.xx,
                                         {form.normal_x, form.normal_y}, x, after, square, omega),
          g);
    }
  }
}

// The area of two deviations is that of the symplectic form, as none of them changes the energy.
TEST(Transverse, AreasAreKept) {
  Dice dice(4);
  for (int i = 0; i < 1000; ++i) {
    const double omega = omega_of(dice, i), t = dice.between(0, 4), g = dice.between(-9, 9);
    Transverse a{dice.between(-1, 1), dice.between(-1, 1)},
        b{dice.between(-1, 1), dice.between(-1, 1)};
    const double area = a.place * b.rate - a.rate * b.place;
    for (Transverse* w : {&a, &b})
      *w = reflected(flown(*w, transverse_flight(flight_tangent(omega, t), omega)), g);
    EXPECT_NEAR(a.place * b.rate - a.rate * b.place, area, 1e-12) << i;
  }
}

}  // namespace
}  // namespace carom
