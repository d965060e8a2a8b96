// Bounds of forces over complex neighbourhoods: they hold at random places, and are not far above
// what is found there.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <random>
#include <string>

#include "carom/forces/typed_expression.hpp"
#include "forces/formula_bound.hpp"
#include "forces/potential.hpp"
#include "forces/resolution.hpp"

namespace carom {

using namespace forces;

namespace {

using geometry::Vector;
using Complex = std::complex<double>;
using Gradient = std::function<std::pair<Complex, Complex>(Complex x, Complex y)>;
using Kind = PotentialSpec::Kind;

/// The size of forces/force_bound.hpp.
double size(Complex x, Complex y) {
  const Complex i(0, 1);
  return std::max(std::abs(x + i * y), std::abs(x - i * y));
}

/// V' / r of a central potential gives its gradient.
Gradient central(std::function<Complex(Complex r)> slope) {
  return [slope](Complex x, Complex y) {
    const Complex r = std::sqrt(x * x + y * y), f = slope(r) / r;
    return std::pair{f * x, f * y};
  };
}

class Places {
 public:
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  /// The largest |grad V| at displacements of size rho (where an analytic function is largest) from
  /// points of the box.
  double largest(const Gradient& gradient, const Neighbourhood& n, int count = 400) {
    double most = 0.0;
    for (int k = 0; k < count; ++k) {
      const double x = uniform(n.low.x, n.high.x), y = uniform(n.low.y, n.high.y);
      const Complex p = std::polar(n.rho, uniform(-3.2, 3.2)),
                    q = std::polar(n.rho, uniform(-3.2, 3.2));
      const auto [gx, gy] = gradient(x + 0.5 * (p + q), y + Complex(0, -0.5) * (p - q));
      most = std::max(most, size(gx, gy));
    }
    return most;
  }
  Neighbourhood near(double reach, double rho) {
    const Vector low{uniform(-reach, reach), uniform(-reach, reach)};
    return {low, low + Vector{0.5 * rho, 0.5 * rho}, rho};
  }

 private:
  std::mt19937_64 random_{20261};
};

/// Of 300 neighbourhoods with bounds: none may be exceeded. Returns the share of those that are
/// within a factor of it.
double check(const std::function<ForceBound(const Neighbourhood&)>& bound, const Gradient& gradient,
             double reach, double factor, const std::string& name) {
  Places places;
  int bounded = 0, close = 0;
  for (int k = 0; k < 300; ++k) {
    const Neighbourhood n = places.near(reach, reach * std::pow(2.0, -k % 8));
    const ForceBound b = bound(n);
    if (!std::isfinite(b.force) || b.jump > 0.0) continue;
    ++bounded;
    const double found = places.largest(gradient, n);
    EXPECT_LE(found, b.force * (1.0 + 1e-9))
        << name << " near " << n.low.x << ", " << n.low.y << ", rho " << n.rho;
    close += b.force < factor * found;
  }
  EXPECT_GT(bounded, 60) << name;
  return static_cast<double>(close) / bounded;
}

struct Named {
  std::string name;
  PotentialSpec spec;
  Gradient gradient;
};

std::vector<Named> named() {
  std::vector<Named> list;
  const auto add = [&](const char* name, Kind kind, Gradient gradient) {
    PotentialSpec s;
    s.kind = kind;
    s.height = 1.3;
    s.radius = 0.4;
    s.softness = 0.15;
    s.width = 0.3;
    s.omega_x = 0.8;
    s.omega_y = 1.4;
    s.strength = 0.9;
    s.exponent = 4.0;
    s.charge = 2.5;
    s.force = {0.3, -1.2};
    list.push_back({name, s, std::move(gradient)});
  };
  add("harmonic", Kind::harmonic, [](Complex x, Complex y) {
    return std::pair{0.64 * x, 1.96 * y};
  });
  add("quartic", Kind::quartic, central([](Complex r) { return 3.6 * r * r * r; }));
  add("power", Kind::power, central([](Complex r) { return 3.6 * r * r * r; }));
  add("coulomb", Kind::coulomb, central([](Complex r) { return 2.5 / (r * r); }));
  add("gaussian", Kind::gaussian,
      central([](Complex r) { return 1.3 * r / 0.09 * std::exp(-r * r / 0.18); }));
  add("henon-heiles", Kind::henon_heiles, [](Complex x, Complex y) {
    return std::pair{x + 2.0 * x * y, y + x * x - y * y};
  });
  add("linear", Kind::linear, [](Complex, Complex) {
    return std::pair{Complex(0.3), Complex(-1.2)};
  });
  const auto fermi = [](double sign) {
    return central([sign](Complex r) {
      const Complex e = std::exp(sign * (r - 0.4) / 0.15), one = 1.0 + e;
      return 1.3 / 0.15 * e / (one * one);
    });
  };
  add("fermi", Kind::fermi, fermi(1.0));
  add("soft-circle", Kind::soft_circle, fermi(-1.0));
  return list;
}

TEST(ForceBounds, HoldForNamedPotentials) {
  const Particle p;
  for (const Named& n : named()) {
    const auto potential = make_potential(n.spec, {});
    const double close = check([&](const Neighbourhood& at) { return potential->bound(p, at); },
                               n.gradient, 2.0, 30.0, n.name);
    EXPECT_GT(close, 0.6) << n.name;
  }
}

TEST(ForceBounds, HoldForTypedPotentials) {
  struct Typed {
    const char* text;
    Gradient gradient;
  };
  const Typed list[] = {
      {"50*exp(-((x-1)^2+(y-1)^2)/(2*0.3^2))",
       [](Complex x, Complex y) {
         const Complex u = x - 1.0, v = y - 1.0,
                       e = 50.0 * std::exp(-(u * u + v * v) / 0.18) / 0.09;
         return std::pair{-u * e, -v * e};
       }},
      {"1.3/(1+exp((sqrt(x^2+y^2)-0.4)/0.15))", central([](Complex r) {
         const Complex e = std::exp((r - 0.4) / 0.15), one = 1.0 + e;
         return 1.3 / 0.15 * e / (one * one);
       })},
      {"cos(3*x)*sin(2*y)+tanh(x)",
       [](Complex x, Complex y) {
         const Complex c = std::cosh(x);
         return std::pair{-3.0 * std::sin(3.0 * x) * std::sin(2.0 * y) + 1.0 / (c * c),
                          2.0 * std::cos(3.0 * x) * std::cos(2.0 * y)};
       }},
      {"1/(x^2+y^2)", central([](Complex r) { return -2.0 / (r * r * r); })},
      {"log(x^2+y^2+1)+x^3*y-(x^2+1)^1.5",
       [](Complex x, Complex y) {
         const Complex s = x * x + y * y + 1.0;
         return std::pair{2.0 * x / s + 3.0 * x * x * y - 3.0 * x * std::sqrt(x * x + 1.0),
                          2.0 * y / s + x * x * x};
       }},
      {"cosh(x)*exp(-y)",
       [](Complex x, Complex y) {
         return std::pair{std::sinh(x) * std::exp(-y), -std::cosh(x) * std::exp(-y)};
       }},
  };
  const std::string variables[] = {"x", "y"};
  for (const Typed& t : list) {
    const TypedExpression v = TypedExpression::parse(t.text, variables, {}, {});
    const double close = check([&](const Neighbourhood& n) { return bound_of(v, n); }, t.gradient,
                               2.0, 100.0, t.text);
    EXPECT_GT(close, 0.5) << t.text;
  }
}

// There half turns cannot be counted any more.
TEST(ForceBounds, HoldWhereAnglesHaveNoDigitsLeft) {
  const std::string variables[] = {"x", "y"};
  for (const char* text : {"sin(x)", "cos(3*x)", "sin(1e21*x)*cos(y)"})
    for (const double x : {1e17, 1e21, 1e100, 1e300})
      EXPECT_GE(
          bound_of(TypedExpression::parse(text, variables, {}, {}), {{x, 0.0}, {x, 0.0}, 1e-30})
              .force,
          1.0)
          << text << x;
}

TEST(ForceBounds, KinksHaveAJumpAndNoMoreThanThat) {
  const std::string variables[] = {"x", "y"};
  const auto at = [&](const char* text, Vector x, double rho) {
    return bound_of(TypedExpression::parse(text, variables, {}, {}), {x, x, rho});
  };
  EXPECT_EQ(at("abs(x)", {0.5, 0.0}, 0.25).jump, 0.0);
  EXPECT_EQ(at("abs(x)", {0.5, 0.0}, 1.0).jump, 2.0);
  EXPECT_EQ(at("abs(x)", {0.5, 0.0}, 1.0).force, 1.0);
  EXPECT_EQ(at("max(x,-3*x)", {0.0, 0.0}, 0.1).jump, 4.0);
  EXPECT_LE(at("sqrt(x^2+y^2)", {0.0, 0.0}, 0.1).jump, 2.0 * std::sqrt(2.0));
  EXPECT_TRUE(std::isinf(at("1/x", {0.0, 0.0}, 0.1).force));
  EXPECT_TRUE(std::isinf(at("log(x)", {0.05, 0.0}, 0.1).force));
}

TEST(ForceBounds, HoldForPairs) {
  struct Pair {
    InteractionSpec::Kind kind;
    std::function<Complex(Complex r)> slope;
  };
  const Pair list[] = {
      {InteractionSpec::Kind::coulomb, [](Complex r) { return 1.5 / (r * r); }},
      {InteractionSpec::Kind::yukawa,
       [](Complex r) { return 1.5 * std::exp(-r / 0.7) * (1.0 / (r * r) + 1.0 / (0.7 * r)); }},
      {InteractionSpec::Kind::lennard_jones,
       [](Complex r) {
         const Complex s6 = std::pow(0.9 / r, 6);
         return 24.0 * 1.1 * s6 * (2.0 * s6 - 1.0) / r;
       }},
      {InteractionSpec::Kind::soft_sphere,
       [](Complex r) { return 12.0 * 1.5 * std::pow(0.9 / r, 12) / r; }},
  };
  Places places;
  for (const Pair& pair : list) {
    InteractionSpec s;
    s.kind = pair.kind;
    s.strength = 1.5;
    s.range = 0.7;
    s.depth = 1.1;
    s.diameter = 0.9;
    const auto interaction = make_interaction(s);
    const Particle p;
    for (int k = 0; k < 200; ++k) {
      const double r = places.uniform(0.2, 3.0), rho = r * places.uniform(0.0, 0.9);
      const double found = places.largest(central(pair.slope), {{r, 0.0}, {r, 0.0}, rho});
      EXPECT_LE(found, interaction->bound(p, p, r, rho).force * (1.0 + 1e-9)) << r << " " << rho;
    }
    EXPECT_TRUE(std::isinf(interaction->bound(p, p, 1.0, 1.0).force));
  }
}

TEST(ForceMap, AWellIsResolvedByStepsShortAgainstItsPeriodAtAnyScale) {
  for (const double scale : {1e-9, 1.0, 1e9}) {
    ForceSpec spec;
    PotentialSpec well;
    well.kind = Kind::harmonic;
    spec.potentials.push_back(well);
    const auto forces = ForceField::build(spec, {Particle{}}, {});
    ForceMap map(*forces, Particle{});
    for (const double phase : {0.0, 0.7, 1.5, 3.0}) {
      const Vector x{scale * std::cos(phase), 0.0};
      const double speed = scale * std::sin(phase);
      const auto resolves = [&](double time) {
        const double way = 0.5 * scale * time * time + speed * time;
        return map.resolves(x, speed * speed, way * way, forces::resolution::span_of(time, 0.0));
      };
      EXPECT_TRUE(resolves(0.01)) << scale << " " << phase;
      EXPECT_TRUE(resolves(0.3)) << scale << " " << phase;
      EXPECT_FALSE(resolves(2.0)) << scale << " " << phase;
    }
  }
}

TEST(ForceMap, ANarrowBumpIsSeenHoweverWeakItIs) {
  for (const double height : {1e3, 1.0, 1e-3, 1e-6}) {
    ForceSpec spec;
    PotentialSpec bump;
    bump.kind = Kind::gaussian;
    bump.height = height;
    bump.width = 0.002;
    bump.centers = {{1.0, 0.0}};
    spec.potentials.push_back(bump);
    const auto forces = ForceField::build(spec, {Particle{}}, {});
    ForceMap map(*forces, Particle{});
    const auto resolves = [&](double x, double time) {
      return map.resolves({x, 0.0}, 1.0, time * time, forces::resolution::span_of(time, 0.0));
    };
    EXPECT_FALSE(resolves(0.99, 0.02)) << height;
    EXPECT_FALSE(resolves(0.95, 0.05)) << height;
    EXPECT_TRUE(resolves(0.99, 1e-5)) << height;
    EXPECT_TRUE(resolves(0.5, 0.05)) << height;  // far from it
  }
}

// Named potentials and typed ones ask meshes in another order.
class ForceMapOf : public testing::TestWithParam<Kind> {};

TEST_P(ForceMapOf, AnswersDoNotDependOnEarlierQuestions) {
  ForceSpec spec;
  PotentialSpec bump;
  bump.kind = GetParam();
  bump.width = 0.1;
  bump.centers = {{0.0, 0.0}, {0.7, 0.3}};
  const std::vector<std::string> variables = {"x", "y"};
  bump.expression = std::make_shared<TypedExpression>(TypedExpression::parse(
      "exp(-50*(x^2+y^2)) + exp(-50*((x-0.7)^2+(y-0.3)^2))", variables, {}, {}));
  spec.potentials.push_back(bump);
  const auto forces = ForceField::build(spec, {Particle{}}, {});
  ForceMap used(*forces, Particle{});
  Places places;
  int yes = 0, known = 0;
  for (int k = 0; k < 3000; ++k) {
    const Vector x{places.uniform(-1, 1), places.uniform(-1, 1)};
    const double speed = places.uniform(0, 2), time = std::pow(2.0, places.uniform(-9, -2));
    const double way = speed * time;
    const forces::resolution::Span span = forces::resolution::span_of(time, 0.0);
    ForceMap fresh(*forces, Particle{});
    const bool answer = used.resolves(x, speed * speed, way * way, span);
    EXPECT_EQ(answer, fresh.resolves(x, speed * speed, way * way, span));
    yes += answer;
    ForceMap::Motions one;
    one.count = 1;
    one.x = &x.x;
    one.y = &x.y;
    one.square_speed[0] = speed * speed;
    one.square_way[0] = way * way;
    bool by_kept_bounds = true;
    used.resolve_known(one, span, &by_kept_bounds);
    EXPECT_LE(by_kept_bounds, answer);
    known += by_kept_bounds;
  }
  EXPECT_GT(yes, 300);
  EXPECT_LT(yes, 2900);
  EXPECT_GT(known, yes / 2);
}
INSTANTIATE_TEST_SUITE_P(All, ForceMapOf, testing::Values(Kind::gaussian, Kind::expression));

}  // namespace
}  // namespace carom
