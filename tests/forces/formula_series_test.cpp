// Series of a formula along a curve: Taylor's theorem, and the derivatives that dual numbers give.
#include "forces/formula_series.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace carom::forces {
namespace {

using complex_box::Range;

TypedExpression parsed(const char* text) {
  return TypedExpression::parse(text, std::vector<std::string>{"x", "y"}, {}, {});
}

SeriesOfRanges series_along(const TypedExpression& f, const SeriesOfRanges& x,
                            const SeriesOfRanges& y) {
  return forces::series_along(f, std::array{x, y});
}

/// a + b u + c u^2 about every u of [0, h].
SeriesOfRanges over(double h, double a, double b, double c) {
  const Range u{0.0, h};
  return {Range{a, a} + b * u + c * (u * u), Range{b, b} + 2.0 * c * u, Range{c, c}};
}

const char* const formulas[] = {
    "x^4 + y^4 - 1",   "x*y/(x + y)",   "exp(x - y)",      "log(x + 2*y)",        "sqrt(x^2 + y)",
    "sin(3*x)*cos(y)", "tan(x/2)",      "sinh(x)*cosh(y)", "tanh(x + y)",         "abs(x - 5)*y",
    "atan2(y, x)",     "min(x, y + 9)", "max(x, y - 9)",   "x^2.5 + y^(-3/2)",    "x^y",
    "2/(1 + x) - x/3", "3 - x - (-y)",  "x^(-3)",          "1.5*x^3 - y^2 + 2*x",
};

TEST(FormulaSeries, TaylorsTheoremHolds) {
  constexpr double h = 0.125;
  const auto x = [](double u) { return 0.5 + u - 0.25 * u * u; };
  const auto y = [](double u) { return 0.75 - 0.5 * u + 0.5 * u * u; };
  for (const char* text : formulas) {
    const TypedExpression f = parsed(text);
    const double end = f.value(std::array{x(h), y(h)});
    const auto series = [&](double length) {
      return series_along(f, over(length, 0.5, 1.0, -0.25), over(length, 0.75, -0.5, 0.5));
    };
    const SeriesOfRanges at = series(0.0), along = series(h);
    double sum = 0.0, power = 1.0;
    for (std::size_t k = 0; k < 7; ++k) {
      EXPECT_LE(at[k].high - at[k].low, 1e-11 * (1.0 + std::fabs(at[k].low))) << text << " " << k;
      // The rest of the series is its next coefficient somewhere on the way.
      const double rest = (end - sum) / power, error = 2e-15 / power;
      EXPECT_GE(rest, along[k].low - error) << text << " " << k;
      EXPECT_LE(rest, along[k].high + error) << text << " " << k;
      sum += power * at[k].low;
      power *= h;
    }
    EXPECT_LT(largest(along[6]), 1e8) << text;  // of use
  }
}

TEST(FormulaSeries, FirstCoefficientsAreTheDerivatives) {
  for (const char* text : formulas) {
    const TypedExpression f = parsed(text);
    std::array<double, 2> g{};
    std::array<double, 4> second{};
    const double v = f.value_gradient_and_hessian(std::array{0.5, 0.75}, g, second);
    const SeriesOfRanges s = series_along(f, over(0.0, 0.5, 1.0, 0.0), over(0.0, 0.75, -2.0, 0.0));
    EXPECT_NEAR(s[0].low, v, 1e-14 * (1.0 + std::fabs(v))) << text;
    EXPECT_NEAR(s[1].low, g[0] - 2.0 * g[1], 1e-13 * (1.0 + std::fabs(s[1].low))) << text;
    EXPECT_NEAR(s[2].low, 0.5 * (second[0] - 4.0 * second[1] + 4.0 * second[3]),
                1e-13 * (1.0 + std::fabs(s[2].low)))
        << text;
  }
}

TEST(FormulaSeries, WhatIsNotSmoothHasNoBound) {
  for (const char* text : {"abs(x - 0.6)", "min(x, y)", "1/(x - 0.6)", "log(x - 0.6)",
                           "sqrt(x - 0.6)", "(x - 0.6)^2.5"}) {
    const SeriesOfRanges s =
        series_along(parsed(text), over(0.375, 0.5, 1.0, 0.0), over(0.375, 0.75, -0.5, 0.0));
    EXPECT_FALSE(largest(s[6]) < 1e300) << text;
  }
}

}  // namespace
}  // namespace carom::forces
