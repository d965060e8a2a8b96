// a b + c rounded once, against MPFR: by the processor and by software.
#include "carom/base/fused_product.hpp"

#include <gtest/gtest.h>
#include <mpfr.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include "carom/base/fused_by_sums.hpp"
#include "soak.hpp"

namespace carom {
namespace {

std::uint64_t bits(double x) { return std::bit_cast<std::uint64_t>(x); }

/// In the range and the precision of doubles, subnormal ones too.
class Exactly {
 public:
  Exactly() {
    mpfr_set_emin(-1073);
    mpfr_set_emax(1024);
    for (mpfr_t& x : x_) mpfr_init2(x, 53);
  }
  ~Exactly() {
    for (mpfr_t& x : x_) mpfr_clear(x);
  }
  double operator()(double a, double b, double c) {
    mpfr_set_d(x_[0], a, MPFR_RNDN);
    mpfr_set_d(x_[1], b, MPFR_RNDN);
    mpfr_set_d(x_[2], c, MPFR_RNDN);
    const int how = mpfr_fma(x_[3], x_[0], x_[1], x_[2], MPFR_RNDN);
    mpfr_subnormalize(x_[3], how, MPFR_RNDN);
    return mpfr_get_d(x_[3], MPFR_RNDN);
  }

 private:
  mpfr_t x_[4];
};

struct Operands {
  double a, b, c;
};

constexpr int kinds = 14;  // of operands
class Dice {
 public:
  double significand() { return static_cast<double>(engine_() >> 11 | std::uint64_t{1} << 52); }
  /// Of either sign, its size between 2^low and 2^high.
  double number(int low, int high) {
    const int exponent = low + static_cast<int>(engine_() % static_cast<unsigned>(high - low + 1));
    return std::ldexp((engine_() & 1) != 0 ? significand() : -significand(), exponent - 52);
  }
  int whole(int n) { return static_cast<int>(engine_() % static_cast<unsigned>(n)); }

  Operands operands(int kind) {
    Operands o{number(-30, 30), number(-30, 30), 0.0};
    switch (kind) {
      case 0:
        o.c = number(-120, 120);
        break;
      case 1:
        o.c = -o.a * o.b;
        break;  // what the product rounds
      case 2:
        o.c = std::nextafter(-o.a * o.b, number(0, 0));
        break;
      case 3:  // about the middle of two doubles: the third number tells
        o = {1.0 + std::ldexp(1.0, -27), 1.0 + std::ldexp(1.0, -26),
             std::ldexp(whole(2) ? 1.0 : -1.0, -106 + whole(60))};
        break;
      case 8:  // beside the middle of two doubles by a little
        o = {number(-3, 3), number(-3, 3), 0.0};
        o.c = std::ldexp(o.a * o.b, 52 + whole(3)) + std::ldexp(number(0, 0), whole(6));
        break;
      case 9:  // an odd multiple of half a last digit, and the rest of the product
        o = {1.0 + std::ldexp(1.0, -1 - whole(52)), 1.0 + std::ldexp(1.0, -1 - whole(52)),
             std::ldexp(1.0 + whole(8), 53 - whole(4))};
        if (whole(2)) o.a = -o.a;
        break;
      case 4:
        o = {number(-540, -500), number(-600, -500), number(-1074, -1000)};
        break;  // subnormal sums
      case 5:
        o = {number(-600, -500), number(-480, -440), number(-1080, -1060)};
        break;
      case 10:  // a zero, or the least numbers
        (whole(2) ? o.a : o.c) = std::copysign(whole(2) ? 0.0 : 0x1p-1074, o.b);
        break;
      case 11:  // where software passes from its usual way to that of the ends
        o = {number(-460, -440), number(-460, -440), number(-910, -880)};
        break;
      case 12:
        o = {number(490, 510), number(-3, 3), number(490, 510)};
        break;
      case 13:  // the sum cancels, and what is left needs digits of both errors
        o.c = std::nextafter(-o.a * o.b, 0.0) * (whole(2) ? 1.0 : 0.5);
        break;
      case 6:
        o = {number(500, 540), number(470, 490), number(1010, 1023)};
        break;  // up to infinity, or just below
      default:
        o.c = number(1000, 1023);
        o.a = number(480, 520);
        o.b = -o.c / o.a;
    }
    return o;
  }

 private:
  std::mt19937_64 engine_{20};
};

template <class Product>
void expect_exact(const Product& product) {
  Exactly exactly;
  Dice dice;
  for (int i = 0; i < 200'000; ++i) {
    const auto [a, b, c] = dice.operands(i % kinds);
    ASSERT_EQ(bits(product(a, b, c)), bits(exactly(a, b, c)))
        << i << std::hexfloat << ": " << a << " " << b << " " << c;
  }
}

TEST(FusedProduct, IsRoundedOnceByTheProcessor) {
  if (!detail::fuses) GTEST_SKIP() << "this processor has no such instruction";
  expect_exact(fused_product<double>);
}
TEST(FusedProduct, IsRoundedOnceBySoftware) { expect_exact(detail::fused_in_software); }

// 10^6 triples; with CAROM_SOAK 10^8.
TEST(FusedProduct, OfSoftwareIsThatOfTheLibrary) {
  Dice dice;
  const int all = tests::soak() ? 100'000'000 : 1'000'000;
  for (int i = 0; i < all; ++i) {
    const auto [a, b, c] = dice.operands(i % kinds);
    ASSERT_EQ(bits(detail::fused_by_sums(a, b, c)), bits(std::fma(a, b, c)))
        << i << std::hexfloat << ": " << a << " " << b << " " << c;
  }
}

TEST(FusedProduct, KnowsSignsOfZeroAndInfinity) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const bool both[] = {detail::fuses, false};
  const bool before = detail::fuses;
  for (const bool fuses : both) {
    detail::fuses = fuses;
    EXPECT_EQ(bits(fused_product(-1.0, 0.0, 0.0)), bits(0.0));
    EXPECT_EQ(bits(fused_product(-1.0, 0.0, -0.0)), bits(-0.0));
    EXPECT_EQ(bits(fused_product(3.0, -2.0, 6.0)), bits(0.0));
    EXPECT_EQ(fused_product(1e200, 1e200, -1.0), infinity);
    EXPECT_EQ(fused_product(1e200, 1e200, -1e300), infinity);
    EXPECT_EQ(fused_product(0x1p1000, 0x1p24, -0x1p1023),
              0x1p1023);  // the product alone has no double
    EXPECT_TRUE(std::isnan(fused_product(infinity, 1.0, -infinity)));
    EXPECT_TRUE(std::isnan(fused_product(infinity, 0.0, 1.0)));
  }
  detail::fuses = before;
}

// Of other numbers it is the product and the sum as they are.
struct Whole {
  int n;
  friend constexpr Whole operator*(Whole a, Whole b) { return {a.n * b.n}; }
  friend constexpr Whole operator+(Whole a, Whole b) { return {a.n + b.n}; }
};
static_assert(fused_product(Whole{2}, Whole{3}, Whole{4}).n == 10);

}  // namespace
}  // namespace carom
