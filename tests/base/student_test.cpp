// Quantiles and tails against closed formulas of few degrees of freedom.
#include "base/student.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace carom::base {
namespace {

constexpr double pi = std::numbers::pi;

TEST(Student, QuantilesOfOneAndTwoDegrees) {
  for (const double p : {0.001, 0.025, 0.3, 0.9, 0.975, 0.99999}) {
    const double cauchy = std::tan(pi * (p - 0.5)),
                 two = (2.0 * p - 1.0) / std::sqrt(2.0 * p * (1.0 - p));
    EXPECT_NEAR(student_quantile(p, 1.0) / cauchy, 1.0, 1e-11) << p;  // of p itself, near 1
    EXPECT_NEAR(student_quantile(p, 2.0) / two, 1.0, 1e-11) << p;
  }
  EXPECT_EQ(student_quantile(0.5, 7.0), 0.0);
}

TEST(Student, TailsOfBothSides) {
  for (const double t : {0.1, 1.0, 3.0, 50.0, 1e6}) {
    EXPECT_NEAR(student_beyond(t, 1.0) / (2.0 * std::atan(1.0 / t) / pi), 1.0, 1e-14) << t;
    EXPECT_EQ(student_beyond(-t, 1.0), student_beyond(t, 1.0));
  }
}

TEST(Student, ChiSquaredOfTwoAndFourDegrees) {
  for (const double x : {0.01, 1.0, 7.0, 80.0, 600.0}) {
    const double tail = std::exp(-0.5 * x);
    EXPECT_NEAR(chi_squared_beyond(x, 2.0) / tail, 1.0, 1e-13) << x;
    EXPECT_NEAR(chi_squared_beyond(x, 4.0) / (tail * (1.0 + 0.5 * x)), 1.0, 1e-13) << x;
  }
}

}  // namespace
}  // namespace carom::base
