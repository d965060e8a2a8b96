// Flights and reflections by themselves.
#include "motion/free_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace carom {

using namespace motion;

namespace {

using geometry::Vector;

TEST(FreeMotion, TurnsAPositiveChargeClockwise) {
  const double quarter = std::acos(0.0);
  const auto [x, v] = moved({0, 0}, {1, 0}, 1.0, quarter);
  EXPECT_NEAR(x.x, 1.0, 1e-15);
  EXPECT_NEAR(x.y, -1.0, 1e-15);
  EXPECT_NEAR(v.x, 0.0, 1e-15);
  EXPECT_NEAR(v.y, -1.0, 1e-15);
}

TEST(FreeMotion, SolvesTheEquationOfMotion) {
  // Newton's law by a central difference, and the Larmor circle's radius |v|/|omega|.
  for (const double omega : {0.3, -2.0, 1e-3}) {
    const Vector x0{0.25, -0.5}, v0{0.6, 0.8};
    const double h = 0x1p-12;
    for (const double t : {0.5, 2.0, 7.0}) {
      const auto [before, v1] = moved(x0, v0, omega, t - h);
      const auto [now, v] = moved(x0, v0, omega, t);
      const auto [after, v2] = moved(x0, v0, omega, t + h);
      EXPECT_NEAR((v2.x - v1.x) / (2 * h), omega * v.y, 1e-6);
      EXPECT_NEAR((v2.y - v1.y) / (2 * h), -omega * v.x, 1e-6);
      EXPECT_NEAR((after.x - before.x) / (2 * h), v.x, 1e-6);
      EXPECT_NEAR((after.y - before.y) / (2 * h), v.y, 1e-6);
      const Vector centre{x0.x + v0.y / omega, x0.y - v0.x / omega};
      const Vector d = now - centre;
      EXPECT_NEAR(dot(d, d) * omega * omega, 1.0, 1e-12);
    }
  }
}

TEST(FreeMotion, WeakFieldsKeepTheirDigits) {
  const auto [x, v] = moved({0, 0}, {1, 0}, 1e-12, 3.0);
  EXPECT_DOUBLE_EQ(x.x, 3.0);
  EXPECT_NEAR(x.y, -4.5e-12, 1e-26);
  EXPECT_NEAR(v.y, -3e-12, 1e-26);
}

TEST(FreeMotion, CornersHaveOneLimit) {
  // n reflections at an angle pi/n: whichever wall comes first, the velocity afterwards is the
  // same.
  for (int n = 1; n <= 6; ++n) {
    const double angle = std::acos(-1.0) / n;
    const Vector begins{0.0, 1.0};  // normal of the wall along +x
    const Vector ends{std::sin(angle),
                      -std::cos(angle)};  // of the wall that comes down to the corner
    const Vector v{-std::cos(0.5 * angle + 0.1), -std::sin(0.5 * angle + 0.1)};
    const Vector a = reflected_at_corner(v, ends, begins, n);
    const Vector b = reflected_at_corner(v, begins, ends, n);
    if (n > 1) {
      EXPECT_NEAR(a.x, b.x, 1e-14) << n;
      EXPECT_NEAR(a.y, b.y, 1e-14) << n;
    }
    EXPECT_NEAR(dot(a, a), 1.0, 1e-14);
    EXPECT_GT(dot(a, begins), 0.0) << n;
    EXPECT_GT(dot(a, ends), 0.0) << n;
  }
}

TEST(FreeMotion, TheEnergyShellAttracts) {
  Vector v{0.6 * (1 + 1e-9), 0.8 * (1 + 1e-9)};
  const double step = step_to_energy_shell(v, energy_shell(1.0));
  v = {v.x + step * v.x, v.y + step * v.y};
  EXPECT_NEAR(dot(v, v), 1.0, 4e-16);
}

}  // namespace
}  // namespace carom
