#include "carom/base/exact_number.hpp"

#include <gmpxx.h>
#include <gtest/gtest.h>
#include <mpfr.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <random>
#include <string>

namespace carom {
namespace {

ExactNumber number(const std::string& text) { return ExactNumber(text, Place{}); }

std::string rational(const std::string& text) {
  const auto r = number(text).to_rational();
  return r ? r->numerator + "/" + r->denominator : "irrational";
}

/// The error of a number at line 2, column 9, or one without a place.
InputError error_of(const std::string& text) {
  try {
    (void)ExactNumber(text, Place{"a.toml", 2, 9, "table.width"}).to_double();
  } catch (const InputError& error) {
    return error;
  }
  return InputError("no error");
}
bool is_refused(const std::string& text) { return error_of(text).place().line == 2; }

TEST(ExactNumber, ReadsWhatIsWritten) {
  EXPECT_EQ(rational("1/3"), "1/3");
  EXPECT_EQ(rational("0.1"), "1/10");
  EXPECT_EQ(rational("2^-10"), "1/1024");
  EXPECT_EQ(rational("-(1+2)*3"), "-9/1");
  EXPECT_EQ(rational("1e-3"), "1/1000");
  EXPECT_EQ(rational("-12.50e+2"), "-1250/1");
  EXPECT_EQ(rational(" 1 - 2 - 3 "), "-4/1");
  EXPECT_EQ(rational("8/4/2"), "1/1");
  EXPECT_EQ(rational("-2^2"), "-4/1");
  EXPECT_EQ(rational("2^3^2"), "512/1");
  EXPECT_EQ(rational("1_000.000_5"), "2000001/2000");
  EXPECT_EQ(rational("+.5"), "1/2");
  EXPECT_EQ(rational("0^0"), "1/1");
  EXPECT_EQ(rational("-0.0"), "0/1");
}

TEST(ExactNumber, KnowsRationalRootsAndWhatCancels) {
  EXPECT_EQ(rational("sqrt(9/16)"), "3/4");
  EXPECT_EQ(rational("sqrt(2)*sqrt(8)"), "4/1");
  EXPECT_EQ(rational("sqrt(12) - 2*sqrt(3)"), "0/1");
  EXPECT_EQ(rational("(sqrt(3)/2)^2"), "3/4");
  EXPECT_EQ(rational("(2*pi)/pi"), "2/1");
  EXPECT_EQ(rational("sqrt(pi^2) - pi"), "0/1");
  EXPECT_EQ(rational("sqrt(3)/2"), "irrational");
  EXPECT_EQ(rational("pi/4"), "irrational");
  EXPECT_EQ(rational("1 + sqrt(2)"), "irrational");
}

TEST(ExactNumber, RoundsToTheNearestDouble) {
  EXPECT_EQ(number("0.1").to_double(), 0.1);
  EXPECT_EQ(number("sqrt(3)/2").to_double(), 0x1.bb67ae8584caap-1);
  EXPECT_EQ(number("pi/4").to_double(), 0x1.921fb54442d18p-1);
  EXPECT_EQ(number("sqrt(2+sqrt(3))").to_double(), 0x1.ee8dd4748bf15p+0);
  EXPECT_EQ(number("2^53 + 1").to_double(), 0x1p53);  // a tie goes to the even neighbour
  EXPECT_EQ(number("2^53 + 3").to_double(), 0x1p53 + 4);
  EXPECT_EQ(number("2^53 + 1 + 1e-4000").to_double(), 0x1p53 + 2);
  EXPECT_EQ(number("(sqrt(2)+sqrt(3))^2 - 2*sqrt(6) - 5 + 2^53 + 1").to_double(), 0x1p53);
  EXPECT_EQ(number("1e5000 + pi - 1e5000").to_double(), number("pi").to_double());
  EXPECT_EQ(number("2^-1075").to_double(), 0.0);
  EXPECT_EQ(number("2^-1075 + 1e-5000").to_double(), 0x1p-1074);
  EXPECT_EQ(number("3*2^-1075").to_double(), 0x1p-1073);
  EXPECT_EQ(number("1.7976931348623158e308").to_double(), std::numeric_limits<double>::max());
  EXPECT_EQ(ExactNumber().to_double(), 0.0);
}

// strtod of glibc is correctly rounded, and written by others.
TEST(ExactNumber, RoundsDecimalsLikeTheCLibrary) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 20000; ++i) {
    std::string text = std::to_string(random() >> (random() % 60)) + "." + std::to_string(random());
    text.append("e").append(std::to_string(static_cast<int>(random() % 680) - 350));
    const double expected = std::strtod(text.c_str(), nullptr);
    if (std::isfinite(expected)) {
      ASSERT_EQ(number(text).to_double(), expected) << text;
    }
  }
}

TEST(ExactNumber, RoundsIrrationalsLikeMpfr) {
  std::mt19937_64 random(2);
  mpfr_t value, part;
  mpfr_inits2(400, value, part, static_cast<mpfr_ptr>(nullptr));
  for (int i = 0; i < 2000; ++i) {
    const unsigned long a = random() % 1000000 + 1, b = random() % 1000000 + 1,
                        c = random() % 1000 + 1;
    const std::string text = "(sqrt(" + std::to_string(a) + ")-sqrt(" + std::to_string(b) +
                             ")/pi)^3/" + std::to_string(c);
    mpfr_sqrt_ui(part, b, MPFR_RNDN);
    mpfr_const_pi(value, MPFR_RNDN);
    mpfr_div(part, part, value, MPFR_RNDN);
    mpfr_sqrt_ui(value, a, MPFR_RNDN);
    mpfr_sub(value, value, part, MPFR_RNDN);
    mpfr_pow_ui(value, value, 3, MPFR_RNDN);
    mpfr_div_ui(value, value, c, MPFR_RNDN);
    ASSERT_EQ(number(text).to_double(), mpfr_get_d(value, MPFR_RNDN)) << text;
  }
  mpfr_clears(value, part, static_cast<mpfr_ptr>(nullptr));
}

TEST(ExactNumber, RationalArithmeticIsThatOfGmp) {
  std::mt19937_64 random(3);
  for (int i = 0; i < 2000; ++i) {
    mpq_class value = static_cast<unsigned long>(random() % 1000);
    std::string text = value.get_str();
    for (int k = 0; k < 6; ++k) {
      const unsigned long n = random() % 1000 + 1;
      const mpq_class operand(n);
      const char symbol = "+-*/"[random() % 4];
      if (symbol == '+') value += operand;
      if (symbol == '-') value -= operand;
      if (symbol == '*') value *= operand;
      if (symbol == '/') value /= operand;
      text = "(" + text + symbol + std::to_string(n) + ")";
    }
    ASSERT_EQ(rational(text), value.get_num().get_str() + "/" + value.get_den().get_str()) << text;
  }
}

TEST(ExactNumber, ADoubleIsTakenExactly) {
  const ExactNumber tenth(0.1);
  EXPECT_EQ(tenth.text(), "0.1");
  EXPECT_EQ(tenth.to_rational()->numerator, "3602879701896397");
  EXPECT_EQ(tenth.to_rational()->denominator, "36028797018963968");
  std::mt19937_64 random(4);
  for (int i = 0; i < 20000; ++i) {
    const double x = std::bit_cast<double>(random());
    if (!std::isfinite(x)) continue;
    const ExactNumber exact(x);
    ASSERT_EQ(exact.to_double(), x);
    ASSERT_EQ(number(exact.text()).to_double(), x) << exact.text();
  }
  EXPECT_THROW(ExactNumber{std::numeric_limits<double>::infinity()}, InputError);
  EXPECT_THROW(ExactNumber{std::numeric_limits<double>::quiet_NaN()}, InputError);
}

// The messages are in tests/cli/messages.txt.
TEST(ExactNumber, RefusesWhatIsNoNumberAtItsPlace) {
  for (const char* text :
       {"1/0", "0^-1", "1/(sqrt(2)+1-sqrt(2)-1)", "2*sqrt(1-2)", "1+*2", "2pi", "1 2",
        "2*\xcf\x80?", "1e+x", "(1", "1)", "-inf", "nan", "2^(1/2)", " ", "1e400", "1\n"}) {
    const InputError error = error_of(text);
    EXPECT_EQ(error.place().key, "table.width") << text;
    EXPECT_EQ(error.place().line, 2) << text;
    EXPECT_EQ(error.place().column, 9) << text;
  }
  EXPECT_EQ(error_of("Sqrt(2)").nearest(), "sqrt");
}

TEST(ExactNumber, NumbersThatCostTooMuchTimeOrMemoryAreRefused) {
  EXPECT_TRUE(is_refused("1e999999999"));
  EXPECT_TRUE(is_refused("1e99999999999999999999"));
  EXPECT_TRUE(is_refused("9^9^9^9"));
  EXPECT_TRUE(is_refused("(1e5000)^10000"));
  EXPECT_TRUE(is_refused("(((1+pi)^10000)^10000)^10000"));
  EXPECT_TRUE(is_refused(std::string(100000, '1')));
  EXPECT_TRUE(is_refused(std::string(4000, '(')));
  std::string tower = "1";
  for (int i = 0; i < 1000; ++i) tower += "^-1";
  EXPECT_TRUE(is_refused(tower));
  EXPECT_EQ(rational(std::string(4000, '-') + "1"), "1/1");
  std::string chain = "pi";
  for (int i = 0; i < 190; ++i) chain = "1/(1+" + chain + ")";
  EXPECT_FALSE(is_refused(chain));
}

// Random bytes and random words of the grammar: a value or an InputError, nothing else.
TEST(ExactNumber, SurvivesAnyText) {
  const std::vector<std::string> words = {"1",    "0", ".",   "e",    "-",     "+",  "*",
                                          "/",    "^", "(",   ")",    "sqrt(", "pi", " ",
                                          "9999", "_", "1e9", "\xff", "sqrt"};
  std::mt19937_64 random(5);
  int values = 0;
  for (int i = 0; i < 20000; ++i) {
    std::string text;
    const std::uint64_t length = random() % 12 + 1;
    for (std::uint64_t k = 0; k < length; ++k) text += words[random() % words.size()];
    try {
      (void)number(text).to_double();
      ++values;
    } catch (const InputError&) {
    }
  }
  EXPECT_GT(values, 100);
}

}  // namespace
}  // namespace carom
