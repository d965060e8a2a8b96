// Derivatives of typed formulas: against closed forms, and against difference quotients with 40
// digits.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "forces/formulas.hpp"

namespace carom {
namespace {

using Real = FortyDigits;

double relative(double computed, const Real& truth) {
  return static_cast<double>(abs((Real(computed) - truth) / truth));
}

TEST(FormulaDerivatives, HenonHeilesHasItsDerivatives) {
  const TypedExpression v = formula("(x^2+y^2)/2 + x^2*y - y^3/3");
  std::mt19937_64 generator(2);
  std::uniform_real_distribution<double> uniform(0.05, 0.45);
  for (int i = 0; i < 2000; ++i) {
    const double a = uniform(generator), b = uniform(generator);
    const Real x = a, y = b;
    const ValueAndGradient at = gradient_at(v, a, b);
    EXPECT_LT(relative(at.value, (x * x + y * y) / 2 + x * x * y - y * y * y / 3), 1e-14);
    EXPECT_LT(relative(at.x, x + 2 * x * y), 1e-14);
    // y + x^2 - y^2 cancels: its error counts against its terms.
    EXPECT_LT(static_cast<double>(abs(at.y - (y + x * x - y * y)) / (y + x * x + y * y)), 1e-14);
  }
}

TEST(FormulaDerivatives, GaussianHasItsDerivatives) {
  const TypedExpression v = formula("h*exp(-(x^2+y^2)/(2*w^2))", {{"h", 1.3}, {"w", 0.7}});
  for (double a = -2.05; a < 2.0; a += 0.1) {
    const double b = 0.3 + 0.2 * a * a;
    const Real x = a, y = b, w = 0.7;
    const Real value = Real(1.3) * exp(-(x * x + y * y) / (2 * w * w));
    const ValueAndGradient at = gradient_at(v, a, b);
    EXPECT_LT(relative(at.value, value), 1e-14);
    EXPECT_LT(relative(at.x, -x / (w * w) * value), 1e-14);
    EXPECT_LT(relative(at.y, -y / (w * w) * value), 1e-14);
  }
}

TEST(FormulaDerivatives, YukawaHasItsDerivatives) {
  const std::vector<std::string> variables = {"r"};
  const TypedExpression w =
      TypedExpression::parse("g*exp(-r/l)/r", variables, {{"g", 2.5}, {"l", 0.8}}, {});
  for (double a = 0.01; a < 6.0; a *= 1.07) {
    const Real r = a, l = 0.8, value = Real(2.5) * exp(-r / l) / r;
    const double at[] = {a};
    double slope[1];
    EXPECT_LT(relative(w.value_and_gradient(at, slope), value), 1e-14) << a;
    EXPECT_LT(relative(slope[0], -value * (1 / l + 1 / r)), 1e-14) << a;
    EXPECT_EQ(w.value(at), w.value_and_gradient(at, slope));
  }
}

TEST(FormulaDerivatives, LennardJonesAndPowersHaveTheirDerivatives) {
  const TypedExpression v =
      formula("4*((x^2+y^2)^-6 - (x^2+y^2)^-3) + (x^2+y^2)^-0.5 + x^2.3*y^-1.5");
  for (double a = 0.6; a < 2.0; a += 0.037) {
    const double b = 0.9;
    const Real x = a, y = b, s = x * x + y * y;
    const ValueAndGradient at = gradient_at(v, a, b);
    const auto scale = [](const Real& p, const Real& q, const Real& r, const Real& t) {
      return abs(p) + abs(q) + abs(r) + abs(t);
    };
    const Real p = 4 * pow(s, -6), q = -4 * pow(s, -3), r = pow(s, Real(-0.5)),
               t = pow(x, Real(2.3)) * pow(y, Real(-1.5));
    EXPECT_LT(static_cast<double>(abs(at.value - (p + q + r + t)) / scale(p, q, r, t)), 1e-14);
    const Real px = -12 * x * p / s, qx = -6 * x * q / s, rx = -x * r / s, tx = Real(2.3) * t / x;
    EXPECT_LT(static_cast<double>(abs(at.x - (px + qx + rx + tx)) / scale(px, qx, rx, tx)), 1e-14);
  }
}

// Ulps between a double and the truth.
double ulps(double computed, const Real& truth) {
  const double size = std::fabs(static_cast<double>(truth));
  const double ulp = std::nextafter(size, INFINITY) - size;
  return static_cast<double>(abs(Real(computed) - truth) / ulp);
}

TEST(FormulaDerivatives, FunctionsAreAsAccurateAsStated) {
  struct Claim {
    const char* text;
    std::function<Real(Real)> value, slope;
    double bound, slope_bound, least, most;
  };
  const auto cosine_squared = [](Real x) { return Real(1 / (cosh(x) * cosh(x))); };
  const Claim claims[] = {
      {"tan(x)", [](Real x) { return Real(tan(x)); },
       [](Real x) { return Real(1 / (cos(x) * cos(x))); }, 3, 4, 1e-8, 30},
      {"sinh(x)", [](Real x) { return Real(sinh(x)); }, [](Real x) { return Real(cosh(x)); }, 4, 4,
       1e-8, 710.4},
      {"cosh(x)", [](Real x) { return Real(cosh(x)); }, [](Real x) { return Real(sinh(x)); }, 4, 4,
       1e-8, 710.4},
      {"tanh(x)", [](Real x) { return Real(tanh(x)); }, cosine_squared, 4, 6, 1e-8, 350},
      {"abs(x)", [](Real x) { return Real(abs(x)); }, [](Real x) { return Real(x < 0 ? -1 : 1); },
       0.0, 0.0, 1e-8, 10},
      {"x^7", [](Real x) { return Real(pow(x, 7)); }, [](Real x) { return Real(7 * pow(x, 6)); }, 7,
       8, 0.01, 100},
      {"x^-40", [](Real x) { return Real(pow(x, -40)); },
       [](Real x) { return Real(-40 * pow(x, -41)); }, 40, 44, 0.1, 100},
  };
  std::mt19937_64 generator(3);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (const Claim& claim : claims) {
    const TypedExpression f = formula(claim.text);
    double worst = 0.0, worst_slope = 0.0;
    for (int i = 0; i < 3000; ++i) {
      const double sign = i % 2 ? -1.0 : 1.0;
      const double x = sign * claim.least * std::pow(claim.most / claim.least, uniform(generator));
      const ValueAndGradient at = gradient_at(f, x, 0.0);
      worst = std::max(worst, ulps(at.value, claim.value(x)));
      worst_slope = std::max(worst_slope, ulps(at.x, claim.slope(x)));
    }
    EXPECT_LE(worst, claim.bound) << claim.text;
    EXPECT_LE(worst_slope, claim.slope_bound) << claim.text;
    RecordProperty(claim.text,
                   std::to_string(worst) + " ulp, slope " + std::to_string(worst_slope));
  }
}

// A random formula: its text, and the same with 40 digits. `largest` takes in every intermediate
// result.
struct RandomFormula {
  std::string text;
  std::function<Real(const Real&, const Real&)> value;
};

class Generator {
 public:
  explicit Generator(unsigned seed) : random_(seed) {}

  RandomFormula tree(int depth) {
    if (depth == 0 || pick(6) == 0) return leaf();
    const auto a = tree(depth - 1);
    if (pick(2) == 0) return unary(a);
    return binary(a, tree(depth - 1));
  }
  double coordinate() { return std::uniform_real_distribution<double>(-1.5, 1.5)(random_); }

 private:
  int pick(int n) { return std::uniform_int_distribution<int>(0, n - 1)(random_); }

  RandomFormula leaf() {
    switch (pick(4)) {
      case 0:
        return {"x", [](const Real& x, const Real&) { return x; }};
      case 1:
        return {"y", [](const Real&, const Real& y) { return y; }};
      case 2:
        return {"0.75", [](const Real&, const Real&) { return Real(0.75); }};
      default:
        return {"2", [](const Real&, const Real&) { return Real(2); }};
    }
  }

  // Where a function has poles or edges its argument is kept away from them.
  RandomFormula unary(const RandomFormula& a) {
    const std::string t = "(" + a.text + ")";
    const auto of = [&](const std::string& text, std::function<Real(const Real&)> f) {
      return RandomFormula{text, [a, f](const Real& x, const Real& y) { return f(a.value(x, y)); }};
    };
    switch (pick(16)) {
      case 0:
        return of("-" + t, [](const Real& v) { return Real(-v); });
      case 1:
        return of("sqrt(1+" + t + "^2)", [](const Real& v) { return Real(sqrt(1 + v * v)); });
      case 2:
        return of("exp(-" + t + "^2)", [](const Real& v) { return Real(exp(-v * v)); });
      case 3:
        return of("log(2+" + t + "^2)", [](const Real& v) { return Real(log(2 + v * v)); });
      case 4:
        return of("sin" + t, [](const Real& v) { return Real(sin(v)); });
      case 5:
        return of("cos" + t, [](const Real& v) { return Real(cos(v)); });
      case 6:
        return of("tan(sin" + t + ")", [](const Real& v) { return Real(tan(sin(v))); });
      case 7:
        return of("sinh(sin" + t + "*2)", [](const Real& v) { return Real(sinh(sin(v) * 2)); });
      case 8:
        return of("cosh(2*cos" + t + ")", [](const Real& v) { return Real(cosh(2 * cos(v))); });
      case 9:
        return of("tanh" + t, [](const Real& v) { return Real(tanh(v)); });
      case 10:
        return of("abs(3-tanh" + t + ")", [](const Real& v) { return Real(abs(3 - tanh(v))); });
      case 11:
        return of(t + "^3", [](const Real& v) { return Real(v * v * v); });
      case 12:
        return of("(2+sin" + t + ")^-4", [](const Real& v) { return Real(pow(2 + sin(v), -4)); });
      case 13:
        return of("(2+sin" + t + ")^2.5",
                  [](const Real& v) { return Real(pow(2 + sin(v), Real(2.5))); });
      case 14:
        return of("(2+sin" + t + ")^-1.25",
                  [](const Real& v) { return Real(pow(2 + sin(v), Real(-1.25))); });
      default:
        return of("1/(2-sin" + t + ")", [](const Real& v) { return Real(1 / (2 - sin(v))); });
    }
  }

  RandomFormula binary(const RandomFormula& a, const RandomFormula& b) {
    const std::string s = "(" + a.text + ")", t = "(" + b.text + ")";
    const auto of = [&](const std::string& text, std::function<Real(const Real&, const Real&)> f) {
      return RandomFormula{text, [a, b, f](const Real& x, const Real& y) {
                             return f(a.value(x, y), b.value(x, y));
                           }};
    };
    switch (pick(9)) {
      case 0:
        return of(s + "+" + t, [](const Real& u, const Real& v) { return Real(u + v); });
      case 1:
        return of(s + "-" + t, [](const Real& u, const Real& v) { return Real(u - v); });
      case 2:
      case 3:
        return of(s + "*" + t, [](const Real& u, const Real& v) { return Real(u * v); });
      case 4:
        return of(s + "/(1+" + t + "^2)",
                  [](const Real& u, const Real& v) { return Real(u / (1 + v * v)); });
      case 5:
        return of("(2+sin" + s + ")^sin" + t,
                  [](const Real& u, const Real& v) { return Real(pow(2 + sin(u), sin(v))); });
      case 6:
        return of("atan2(" + s + ",2+sin" + t + ")",
                  [](const Real& u, const Real& v) { return Real(atan2(u, 2 + sin(v))); });
      case 7:
        return of("min(" + s + "," + t + ")",
                  [](const Real& u, const Real& v) { return u < v ? u : v; });
      default:
        return of("max(" + s + "," + t + ")",
                  [](const Real& u, const Real& v) { return u > v ? u : v; });
    }
  }

  std::mt19937 random_;
};

TEST(FormulaDerivatives, RandomFormulasAgreeWithFortyDigits) {
  const Real h("1e-12");
  int compared = 0;
  for (unsigned seed = 0; seed < 1500; ++seed) {
    Generator generator(seed);
    const RandomFormula random = generator.tree(4);
    const double a = generator.coordinate(), b = generator.coordinate();
    const Real x = a, y = b;
    const Real value = random.value(x, y);
    const Real slope_x = (random.value(x + h, y) - random.value(x - h, y)) / (2 * h);
    const Real slope_y = (random.value(x, y + h) - random.value(x, y - h)) / (2 * h);
    // Conditions amplify rounding; formulas with large ones prove nothing.
    const Real bend_x = (random.value(x + h, y) - 2 * value + random.value(x - h, y)) / (h * h);
    const Real bend_y = (random.value(x, y + h) - 2 * value + random.value(x, y - h)) / (h * h);
    const Real size = 1 + abs(value) + abs(slope_x) + abs(slope_y) + abs(bend_x) + abs(bend_y);
    if (size > 1000) continue;
    ++compared;
    const ValueAndGradient at = gradient_at(formula(random.text), a, b);
    EXPECT_LT(static_cast<double>(abs(at.value - value) / size), 1e-13) << random.text;
    EXPECT_LT(static_cast<double>(abs(at.x - slope_x) / size), 1e-13) << random.text;
    EXPECT_LT(static_cast<double>(abs(at.y - slope_y) / size), 1e-13) << random.text;
    EXPECT_EQ(at.value, value_at(formula(random.text), a, b)) << random.text;
  }
  EXPECT_GT(compared, 1200);
}

}  // namespace
}  // namespace carom
