// What a formula means, and what is said when it means nothing.
#include "carom/forces/typed_expression.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <regex>
#include <thread>

#include "carom/base/elementary.hpp"
#include "forces/formulas.hpp"

namespace carom {
namespace {

std::uint64_t bits(double x) { return std::bit_cast<std::uint64_t>(x); }

double constant(const std::string& text) { return value_at(formula(text), 0.0, 0.0); }

TEST(TypedExpression, BindsAsInMathematics) {
  const std::pair<const char*, double> table[] = {
      {"1+2*3", 7},      {"2*3+1", 7},    {"(1+2)*3", 9},    {"10-4-3", 3},    {"10-(4-3)", 9},
      {"16/4/2", 2},     {"16/(4/2)", 8}, {"12/2*3", 18},    {"-2^2", -4},     {"(-2)^2", 4},
      {"2^-2", 0.25},    {"2^3^2", 512},  {"(2^3)^2", 64},   {"2^-1^2", 0.5},  {"2*-3", -6},
      {"2--3", 5},       {"+-+-2", 2},    {"-2*-3", 6},      {"3*2^2", 12},    {"2^2*3", 12},
      {"1/2^2", 0.25},   {"-(1+2)", -3},  {"((((7))))", 7},  {" 1\t+\n1 ", 2}, {"0^0", 1},
      {"4^0.5", 2},      {"4^1.5", 8},    {"4^-0.5", 0.5},   {"min(2,3)", 2},  {"max(2,3)", 3},
      {"min(3,2)-1", 1}, {"abs(-3)", 3},  {"sqrt(16)/2", 2}, {"exp(0)", 1},    {"log(1)", 0},
      {"atan2(0,1)", 0}, {"1.5e2", 150},  {".5", 0.5},       {"5.", 5},        {"1E-2*100", 1},
  };
  for (const auto& [text, value] : table) EXPECT_EQ(constant(text), value) << text;
  // The same with a variable, where nothing is folded: x stands for a 2 that is no exponent.
  for (const auto& [text, value] : table) {
    const std::string with_variable =
        std::regex_replace(std::string(text), std::regex("(^|[^\\w^.-])2\\b"), "$1x");
    EXPECT_DOUBLE_EQ(value_at(formula(with_variable), 2.0, 0.0), value) << with_variable;
  }
}

TEST(TypedExpression, NumbersMeanWhatIsWritten) {
  EXPECT_EQ(constant("0.1"), 0.1);
  EXPECT_EQ(constant("0.1000000000000000055511151231257827021181583404541015625"), 0.1);
  EXPECT_EQ(constant("9007199254740993"), 9007199254740992.0);  // a tie, to even
  EXPECT_EQ(constant("9007199254740993.000001"), 9007199254740994.0);
  EXPECT_EQ(constant("1/3"), 1.0 / 3.0);
  EXPECT_EQ(constant("4.9e-324"), std::numeric_limits<double>::denorm_min());
  EXPECT_EQ(constant("pi"), 3.14159265358979323846);
  EXPECT_EQ(constant("e"), 2.71828182845904523536);
  EXPECT_EQ(value_at(formula("a*x+b_2", {{"a", 3.0}, {"b_2", 0.25}}), 2.0, 0.0), 6.25);
}

TEST(TypedExpression, PolynomialsHaveTheBitsOfTheSameLineOfCode) {
  const TypedExpression henon_heiles = formula("(x^2+y^2)/2 + x^2*y - y^3/3");
  const TypedExpression quartic =
      formula("a*(x^2+y^2)^2 - 0.3*x + y/7 - (1 - x)*(2 - y)", {{"a", 0.1}});
  const TypedExpression product = formula("x*x*x*x - y*y*y + x - y*y");
  std::mt19937_64 generator(1);
  std::uniform_real_distribution<double> uniform(-3.0, 3.0);
  for (int i = 0; i < 20000; ++i) {
    const double x = uniform(generator), y = uniform(generator);
    const double first = (x * x + y * y) / 2.0 + x * x * y - y * y * y / 3.0;
    EXPECT_EQ(bits(value_at(henon_heiles, x, y)), bits(first));
    const double s = x * x + y * y;
    const double second = 0.1 * (s * s) - 0.3 * x + y / 7.0 - (1.0 - x) * (2.0 - y);
    EXPECT_EQ(bits(value_at(quartic, x, y)), bits(second));
    EXPECT_EQ(bits(value_at(product, x, y)), bits(x * x * x * x - y * y * y + x - y * y));
    EXPECT_EQ(bits(gradient_at(quartic, x, y).value), bits(second));
  }
}

TEST(TypedExpression, ComputesWhatIsWrittenTwiceAlikeAndDropsWhatIsNotNeeded) {
  const TypedExpression f =
      formula("(x*y - 3)^0 + (x + y)*(x - y) + (x + y)^2 + (x + y)^3 + (y + x)^2.5");
  const double at[] = {1.25, 2.75};
  EXPECT_EQ(f.value(at), 1.0 + 4.0 * -1.5 + 16.0 + 64.0 + 32.0);
  EXPECT_EQ(gradient_at(f, 1.25, 2.75).x, (-1.5 + 4.0) + 8.0 + 48.0 + 20.0);
  EXPECT_EQ(gradient_at(f, 1.25, 2.75).y, (-1.5 - 4.0) + 8.0 + 48.0 + 20.0);
  EXPECT_EQ(gradient_at(formula("(x*y)^0"), 1.25, 2.75).x, 0.0);
  EXPECT_EQ(gradient_at(formula("y"), 1.25, 2.75).y, 1.0);
}

TEST(TypedExpression, ElementaryFunctionsAreThoseOfTheProject) {
  for (double x = -3.0; x < 3.0; x += 0.0371) {
    EXPECT_EQ(value_at(formula("exp(x)"), x, 0.0), elementary::exp(x));
    EXPECT_EQ(value_at(formula("log(3.5+x)"), x, 0.0), elementary::log(x + 3.5));
    EXPECT_EQ(value_at(formula("sin(x)"), x, 0.0), elementary::sincos(x).sin);
    EXPECT_EQ(value_at(formula("cos(x)"), x, 0.0), elementary::sincos(x).cos);
    EXPECT_EQ(value_at(formula("atan2(x, y)"), x, 0.3), elementary::atan2(x, 0.3));
    EXPECT_EQ(value_at(formula("sqrt(x^2)"), x, 0.0), std::sqrt(x * x));
  }
}

TEST(TypedExpression, HasNoFiniteValueWhereThereIsNone) {
  const auto never_finite = [](const std::string& text, double x) {
    const ValueAndGradient at = gradient_at(formula(text), x, 1.0);
    EXPECT_FALSE(std::isfinite(at.value)) << text;
    EXPECT_EQ(bits(at.value), bits(value_at(formula(text), x, 1.0))) << text;
  };
  never_finite("1/x", 0.0);
  never_finite("y/x", 0.0);
  never_finite("x/x", 0.0);
  never_finite("log(x)", 0.0);
  never_finite("log(x)", -1.0);
  never_finite("sqrt(x)", -1.0);
  never_finite("x^0.3", -1.0);
  never_finite("x^y^2.1", -1.0);
  never_finite("x^-2", 0.0);
  never_finite("x^-1.5", 0.0);
  never_finite("exp(x)", 1000.0);
  never_finite("cosh(x)", 1000.0);
  never_finite("min(log(x), 1)", -1.0);
  never_finite("min(1, log(x))", -1.0);
  never_finite("max(log(x), 1)", -1.0);
  never_finite("max(1, log(x))", -1.0);
  // A cusp has a value but no slope.
  EXPECT_EQ(gradient_at(formula("sqrt(x^2+y^2)"), 0.0, 0.0).value, 0.0);
  EXPECT_FALSE(std::isfinite(gradient_at(formula("sqrt(x^2+y^2)"), 0.0, 0.0).x));
  // A steep or smooth zero is none.
  for (const char* smooth : {"x^1.5", "x^2.7", "x^2", "(x^2+(y-1)^2)^1.5"}) {
    const ValueAndGradient at = gradient_at(formula(smooth), 0.0, 1.0);
    EXPECT_EQ(at.value, 0.0) << smooth;
    EXPECT_EQ(at.x, 0.0) << smooth;
  }
}

TEST(TypedExpression, CopiesShareOneFormulaAmongThreads) {
  const TypedExpression original = formula("sin(x)*exp(-y^2) + x^3");
  const double expected = gradient_at(original, 0.7, 0.2).x;
  std::vector<std::thread> threads;
  std::vector<int> wrong(4, 0);
  for (std::size_t t = 0; t < wrong.size(); ++t) {
    threads.emplace_back([copy = original, expected, &count = wrong[t]] {
      for (int i = 0; i < 2000; ++i) count += gradient_at(copy, 0.7, 0.2).x != expected;
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const int count : wrong) EXPECT_EQ(count, 0);
}

TEST(TypedExpression, WantsAsManyNumbersAsVariables) {
  const std::vector<std::string> r = {"r"};
  const TypedExpression w = TypedExpression::parse("exp(-r)/r", r, {}, {});
  const double one[] = {2.0}, two[] = {2.0, 3.0};
  double slope[1];
  EXPECT_EQ(w.value_and_gradient(one, slope), elementary::exp(-2.0) / 2.0);
  EXPECT_THROW(w.value(two), InternalError);
  EXPECT_THROW(w.value_and_gradient(two, slope), InternalError);
}

// Faults: the text starts at column 15 of line 7.
struct Fault {
  std::string text;
  int column;                             // of the text, from 1
  std::string blamed, expected, nearest;  // blamed: in quotes, or nothing
};

void expect_fault(const Fault& fault) {
  try {
    formula(fault.text, {{"alpha", 1.0}});
    ADD_FAILURE() << fault.text << ": no error";
  } catch (const InputError& error) {
    EXPECT_EQ(error.place().file, "a.toml") << fault.text;
    EXPECT_EQ(error.place().line, 7) << fault.text;
    EXPECT_EQ(error.place().column, 14 + fault.column) << fault.text << ": " << error.what();
    EXPECT_EQ(error.place().key, "potential[0].expression");
    EXPECT_NE(error.problem().find(fault.blamed), std::string::npos)
        << fault.text << ": " << error.what();
    EXPECT_NE(error.expected().find(fault.expected), std::string::npos)
        << fault.text << ": " << error.what();
    EXPECT_EQ(error.nearest(), fault.nearest) << fault.text;
  }
}

TEST(TypedExpression, PointsAtTheCharacterToBlame) {
  const Fault faults[] = {
      {"x^2 + z", 7, "'z'", "x, y, alpha, pi, e or a function", ""},
      {"x + alhpa", 5, "'alhpa'", "alpha", "alpha"},
      {"sqr(x)", 1, "'sqr'", "sqrt, exp", "sqrt"},
      {"1 + Sin(x)", 5, "'Sin'", "sin", "sin"},
      {"x + inf", 5, "'inf'", "", ""},
      {"", 1, "", "a formula in x, y", ""},
      {"   ", 1, "", "", ""},
      {"(x+1", 5, "", "')' for the one opened at character 1", ""},
      {"2*(x+(y-1)", 11, "", "')' for the one opened at character 3", ""},
      {"x+1)", 4, "')'", "", ""},
      {"x +", 4, "", "a number, a name or '('", ""},
      {"x^", 3, "", "a number", ""},
      {"* x", 1, "'*'", "a number", ""},
      {"x + * y", 5, "'*'", "a number", ""},
      {"x**2", 2, "'**'", "'^'", ""},
      {"2x", 2, "'x'", "* for a product", ""},
      {"2exp(x)", 2, "'e'", "* for a product", ""},
      {"x y", 3, "'y'", "* for a product", ""},
      {"(x)(y)", 4, "'('", "* for a product", ""},
      {"x(y)", 2, "'x'", "* for a product", ""},
      {"sin x", 5, "'x'", "'(' after sin", ""},
      {"x + sin", 8, "", "'(' after sin", ""},
      {"sin()", 5, "')'", "sin takes one argument", ""},
      {"sin(x, y)", 6, "','", "sin takes one argument", ""},
      {"min(x)", 6, "')'", "min takes two arguments", ""},
      {"min(x, y, 2)", 9, "','", "min takes two arguments", ""},
      {"max(x, y", 9, "", "')' for the one opened at character 4", ""},
      {"x, y", 2, "','", "an operator", ""},
      {"()", 2, "')'", "a number", ""},
      {"1.2.3", 4, "'.'", "an operator", ""},
      {".", 1, "'.'", "a number", ""},
      {"x = 1", 3, "'='", "an operator", ""},
      {"x·y", 2, "'·'", "an operator", ""},
      {"x·y + z", 2, "'·'", "", ""},
      {"x + β", 5, "'β'", "a number, a name", ""},
      {"1 + 1/0", 6, "", "", ""},
      {"x + log(-1)", 5, "", "", ""},
      {"x^(1/(alpha-1))", 5, "", "", ""},
      {"x^20000", 3, "", "at most 10000", ""},
      {"1e999*x", 1, "'1e999'", "", ""},
  };
  for (const Fault& fault : faults) expect_fault(fault);
}

TEST(TypedExpression, CountsLinesOfLongFormulasAndLeavesOutUnknownPlaces) {
  try {
    formula("x^2 +\n  y +\n αβ");
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_EQ(error.place().line, 9);
    EXPECT_EQ(error.place().column, 2);
  }
  const std::vector<std::string> r = {"r"};
  try {
    TypedExpression::parse("1/q", r, {}, Place{"command line", 0, 0, "interaction.expression"});
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_EQ(error.place().key, "interaction.expression");
    EXPECT_NE(error.problem().find("'q'"), std::string::npos);
  }
}

TEST(TypedExpression, BoundsWhatItReads) {
  EXPECT_THROW(formula(std::string(5000, ' ') + "x"), InputError);
  EXPECT_THROW(formula(std::string(1000, '(') + "x" + std::string(1000, ')')), InputError);
  std::string tower = "x";
  for (int i = 0; i < 1000; ++i) tower += "^x";
  EXPECT_THROW(formula(tower), InputError);
  std::string nested = "x";  // every sign an operation
  for (int i = 0; i < 150; ++i) nested = "-(1+" + nested + ")";
  EXPECT_EQ(value_at(formula(nested), 0.0, 0.0), 0.0);
  std::string sum = "x";  // 1000 terms: more slots than the short array has
  for (int i = 0; i < 1000; ++i) sum += "+x";
  EXPECT_EQ(gradient_at(formula(sum), 2.0, 0.0).value, 2002.0);
  EXPECT_EQ(gradient_at(formula(sum), 2.0, 0.0).x, 1001.0);
  std::string product = "x";  // 2047 operations and two variables: one slot too many
  for (int i = 0; i < 2047; ++i) product += "*x";
  expect_fault({product, 4094, "the formula has too many operations", "at most 2048", ""});
  EXPECT_NO_THROW(formula(product.substr(2)));
}

TEST(TypedExpression, RefusesParametersThatMeanTwoThings) {
  for (const char* name : {"x", "pi", "e", "sin", "", "2a", "a b", "ω"})
    EXPECT_THROW(formula("x", {{name, 1.0}}), InputError) << name;
  EXPECT_THROW(formula("x", {{"a", std::numeric_limits<double>::infinity()}}), InputError);
}

}  // namespace
}  // namespace carom
