#include "carom/base/elementary.hpp"

#include <gtest/gtest.h>
#include <mpfr.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <vector>

#include "base/angle.hpp"
#include "carom/base/digest.hpp"
#include "carom/base/fused_product.hpp"

namespace carom {
namespace {

// Arguments spread over decades, made by integer operations and exact multiplications only.
double argument(std::uint64_t i, int lowest, int highest) {
  const std::uint64_t a = mix(i);
  const double mantissa = 1.0 + static_cast<double>(a >> 12) * 0x1p-52;
  const int exponent =
      lowest + static_cast<int>((a & 0xfffu) % static_cast<unsigned>(highest - lowest));
  double power = 1.0;
  for (int k = 0; k < std::abs(exponent); ++k) power *= exponent < 0 ? 0.5 : 2.0;
  return ((mix(a) & 1u) != 0 ? mantissa : -mantissa) * power;
}

// MPFR at 300 digits, rounded to a double by one step: another way than the library's own, which
// asks MPFR for 53.
class Reference {
 public:
  Reference() { mpfr_inits2(300, x_, y_, result_, static_cast<mpfr_ptr>(nullptr)); }
  ~Reference() { mpfr_clears(x_, y_, result_, static_cast<mpfr_ptr>(nullptr)); }
  Reference(const Reference&) = delete;
  Reference& operator=(const Reference&) = delete;

  using Unary = int (*)(mpfr_ptr, mpfr_srcptr, mpfr_rnd_t);
  double of(Unary f, double x) {
    mpfr_set_d(x_, x, MPFR_RNDN);
    f(result_, x_, MPFR_RNDN);
    return mpfr_get_d(result_, MPFR_RNDN);
  }
  double atan2(double y, double x) {
    mpfr_set_d(x_, x, MPFR_RNDN);
    mpfr_set_d(y_, y, MPFR_RNDN);
    mpfr_atan2(result_, y_, x_, MPFR_RNDN);
    return mpfr_get_d(result_, MPFR_RNDN);
  }
  /// Distance of `value` from atan2(y, x) in units in the last place of the latter.
  double ulps_atan2(double y, double x, double value) {
    atan2(y, x);
    if (mpfr_zero_p(result_) != 0) return value == 0.0 ? 0.0 : 1e300;
    const mpfr_exp_t exponent = std::max<mpfr_exp_t>(mpfr_get_exp(result_) - 53, -1074);
    mpfr_sub_d(result_, result_, value, MPFR_RNDN);
    mpfr_mul_2si(result_, result_, -exponent, MPFR_RNDN);
    return std::fabs(mpfr_get_d(result_, MPFR_RNDN));
  }

 private:
  mpfr_t x_, y_, result_;
};

std::uint64_t bits(double x) { return std::bit_cast<std::uint64_t>(x); }

class ElementaryRounding : public testing::Test {
 protected:
  void angle(double x) {
    const double sine = reference_.of(mpfr_sin, x), cosine = reference_.of(mpfr_cos, x);
    const auto both = elementary::sincos(x);
    EXPECT_EQ(bits(elementary::sin(x)), bits(sine)) << x;
    EXPECT_EQ(bits(elementary::cos(x)), bits(cosine)) << x;
    EXPECT_EQ(bits(both.sin), bits(sine)) << x;
    EXPECT_EQ(bits(both.cos), bits(cosine)) << x;
  }
  void exponential(double x) {
    EXPECT_EQ(bits(elementary::exp(x)), bits(reference_.of(mpfr_exp, x))) << x;
  }
  void logarithm(double x) {
    EXPECT_EQ(bits(elementary::log(x)), bits(reference_.of(mpfr_log, x))) << x;
  }
  void direction(double y, double x) {
    EXPECT_EQ(bits(elementary::atan2(y, x)), bits(reference_.atan2(y, x))) << y << ' ' << x;
  }
  Reference reference_;
};

// CAROM_ARGUMENTS=100000000 in the environment: as many.
TEST_F(ElementaryRounding, GivesTheDoubleNextToTheTruth) {
  const char* wish = std::getenv("CAROM_ARGUMENTS");
  const std::uint64_t count = wish != nullptr ? std::strtoull(wish, nullptr, 10) : 20000;
  for (std::uint64_t i = 0; i < count && !HasFailure(); ++i) {
    const double x = argument(i, -40, 30), y = argument(i + 1000000, -40, 30);
    angle(x);
    angle(argument(i, -10, 10));
    direction(y, x);
    direction(argument(i, -4, 4), argument(i + 1, -4, 4));
    exponential(argument(i, -20, 9));
    exponential(-700.0 - std::fabs(argument(i, 0, 5)));  // where it becomes subnormal, and zero
    logarithm(std::fabs(argument(i, -1000, 1000)));
    logarithm(1.0 + argument(i, -40, -1));
  }
}

TEST_F(ElementaryRounding, HoldsAtTheEndsOfTheRange) {
  constexpr double least = std::numeric_limits<double>::denorm_min(),
                   normal = std::numeric_limits<double>::min(),
                   largest = std::numeric_limits<double>::max();
  const auto around = [](double x) {
    return std::array{std::nextafter(x, -largest), x, std::nextafter(x, largest)};
  };
  std::vector<double> sizes{least,   3 * least, normal, 1e-160, 0x1p-27,
                            0x1p-26, 1.0,       0x1p24, 1e22,   largest};
  for (const double size : std::vector(sizes))
    for (const double near : around(size))
      if (near > 0.0 && near <= largest) sizes.push_back(near);
  for (const double a : sizes) {
    angle(a), angle(-a), logarithm(a);
    for (const double b : sizes) direction(a, b), direction(-a, b), direction(a, -b);
  }
  for (const double end :
       {-745.1332191019412, -746.0, -708.3964185322641, -708.25, 709.75, 709.782712893384, 0.0})
    for (const double x : around(end)) exponential(x);
  for (int i = 0; i < 600; ++i) {  // where one row of a table ends and the next begins
    for (const double x : around(i * 0x1.921fb54442d18p-8)) angle(x);
    for (const double x : around(i * 0x1.62e42fefa39efp-6)) exponential(x), exponential(-x);
    for (const double x : around(1.0 + i * 0x1p-9)) logarithm(x);
    for (const double x : around((2 * i + 1) * 0x1p-7)) direction(x, 1.0), direction(1.0, x);
  }
}

// Arguments whose results are nearly half-way between two doubles: of the lists of Lefèvre and
// Muller (Worst cases for correct rounding of the elementary functions in double precision, 2001).
TEST_F(ElementaryRounding, HoldsWhereItIsHardest) {
  for (const double x :
       {0x1.005ae04256babp-1, 0x1.0122ef37212ebp-1, 0x1.1a39abbfca18ep+0, 0x1.6f45b53a45e68p-1,
        0x1.accfbe46b4ef0p-1, 0x1.60b3dcaab0558p-1, 0x1.fc97b3f78b512p-1})
    exponential(x);
  for (const double x :
       {0x1.1e852e6951306p+1, 0x1.a6ae5142326b5p+0, 0x1.c877cba59d0acp+0, 0x1.0cd2ceb02289p+3,
        0x1.0b4ee11fe0fd1p+20, 0x1.0092086ce40eap+27, 0x1.efcbe699decc2p+0})
    logarithm(x);
  for (const double x :
       {0x1.005023d32fee5p+1, 0x1.00874a5f9fc33p-13, 0x1.0192deafac33fp+0, 0x1.0202c01ab4668p-11,
        0x1.2e8439fd922dep+1, 0x1.184a0aa58191dp-24, 0x1.45dd7c26e54bdp-24, 0x1.921fb54442d18p+0,
        0x1.921fb54442d18p+1, 0x1.6ac5b262ca1ffp+849, 0x1.8cd13d3p+20})
    angle(x);
  direction(0x5.0c0913c304108p+52, 0xd.e8e7150878bbp+48);
  direction(0x3.fb515bccee34cp+52, 0x1.08b801e149ea1p+52);
  direction(0xf.d2d9034f224b8p+52, 0x3.0f08a84aad728p+52);
  direction(0x1.43a2619d9e519p+60, 0x2.2958260348d1ap+52);
  direction(0x1.0000000000001p-500, 0x1.8p+0);
  for (const double x : {0x1.921fb54442d18p+0, -0x1.921fb54442d18p+0}) angle(x);
  for (std::uint64_t i = 0; i < 5000; ++i)
    direction(argument(i, -960, -64), argument(i + 1000000, -2, 2));
  // The angle is below 3/2 of the least double by less than the reference's last digit.
  EXPECT_EQ(elementary::atan2(0x1.8p-1073, 2.0), 0x1p-1074);
}

TEST(Elementary, KnowsTheSpecialCases) {
  const double infinity = std::numeric_limits<double>::infinity();
  const double pi = 0x1.921fb54442d18p+1;
  EXPECT_EQ(elementary::sin(0.0), 0.0);
  EXPECT_TRUE(std::signbit(elementary::sin(-0.0)));
  EXPECT_EQ(elementary::cos(0.0), 1.0);
  EXPECT_EQ(elementary::atan2(0.0, -1.0), pi);
  EXPECT_EQ(elementary::atan2(-0.0, -1.0), -pi);
  EXPECT_EQ(elementary::atan2(1.0, 0.0), pi / 2);
  EXPECT_EQ(elementary::atan2(0.0, 0.0), 0.0);
  EXPECT_EQ(elementary::exp(0.0), 1.0);
  EXPECT_EQ(elementary::exp(-800.0), 0.0);
  EXPECT_EQ(elementary::exp(800.0), infinity);
  EXPECT_EQ(elementary::log(1.0), 0.0);
  EXPECT_EQ(elementary::log(0.0), -infinity);
  EXPECT_TRUE(std::isnan(elementary::log(-1.0)));
  EXPECT_TRUE(std::isnan(elementary::sin(infinity)));
}

TEST(Elementary, AngleIsWithinWhatItClaims) {
  Reference reference;
  double worst = 0.0, below = 0.0, above = 0.0, sum = 0.0;
  const auto look = [&](double x, double y) {
    const double error = reference.ulps_atan2(y, x, base::angle(x, y));
    worst = std::max(worst, error);
    // Below 7/16 the quotient's rounding may count twice.
    if (y < 0.43 * x) {
      below = std::max(below, error);
    } else {
      above = std::max(above, error);
    }
  };
  constexpr int count = 20000;
  for (std::uint64_t i = 0; i < count; ++i) {
    const double x = argument(i, -30, 30), y = std::fabs(argument(i + 1000000, -30, 30));
    look(x, y);
    // Near the places where another centre takes over, and where the result enters another binade.
    for (const double tangent :
         {7.0 / 16, 11.0 / 16, 16.0 / 11, 16.0 / 7, 0.2553419212210363, 0.5463024898437905}) {
      const double near =
          tangent *
          (1.0 + 0x1p-20 * static_cast<double>(static_cast<std::int64_t>(mix(i)) >> 12) * 0x1p-51);
      look(std::fabs(x), std::fabs(x) * near);
      look(-std::fabs(x), std::fabs(x) * near);
    }
    // Bias, in the middle of a binade's share of angles.
    const double z = 1.0 + 0x1p-20 * static_cast<double>(i & 0xfffff);
    sum += (base::angle(z, 1.25) - std::atan2(1.25, z)) * 0x1p53;
  }
  std::printf("angle: %.3f ulp below 7/16, %.3f above; mean %.1e\n", below, above, sum / count);
  EXPECT_LE(below, 1.6);
  EXPECT_LE(above, 1.1);
  EXPECT_GT(worst, 1.0);
  EXPECT_LT(std::fabs(sum / count), 0.05);
}

TEST(Elementary, AngleKnowsItsEnds) {
  const double pi = 0x1.921fb54442d18p+1;
  EXPECT_EQ(base::angle(0.0, 1.0), pi / 2);
  EXPECT_EQ(base::angle(-0.0, 3.0), pi / 2);
  EXPECT_EQ(base::angle(1.0, 1.0), pi / 4);
  EXPECT_EQ(base::angle(-2.0, 2.0), 3 * (pi / 4));
  EXPECT_EQ(base::angle(1e12, 1e-12), 1e-24);
  EXPECT_EQ(base::angle(-1e12, 1e-12), pi);
  // One angle after the other: no step back where another centre takes over.
  for (const double tangent : {7.0 / 16, 11.0 / 16, 16.0 / 11, 16.0 / 7})
    for (const double side : {1.0, -1.0})
      for (int i = -200; i < 200; ++i)
        EXPECT_LE(side * (base::angle(side, tangent + i * 0x1p-44) -
                          base::angle(side, tangent + (i + 1) * 0x1p-44)),
                  0.0);
}

std::uint64_t hash_of_all_bits() {
  std::uint64_t hash = 0;
  const auto take = [&hash](double value) {
    hash = mix(hash ^ std::bit_cast<std::uint64_t>(value));
  };
  for (std::uint64_t i = 0; i < 100000; ++i) {
    const double x = argument(i, -30, 40);
    const auto both = elementary::sincos(x);
    for (const double value :
         {elementary::sin(x), elementary::cos(x), both.sin, both.cos,
          elementary::atan2(argument(i + 1000000, -30, 40), x),
          base::angle(x, std::fabs(argument(i + 1000000, -30, 40))),
          elementary::exp(argument(i, -20, 9)), elementary::log(std::fabs(x))}) {
      take(value);
    }
  }
  return hash;
}

// The same number on every machine and with any library, whether the processor fuses products or
// not.
TEST(Elementary, HasTheSameBitsOnEveryMachine) {
  const bool before = detail::fuses;
  for (const bool fuses : {before, false}) {
    detail::fuses = fuses;
    EXPECT_EQ(hash_of_all_bits(), 0x481e57e66bbb14f1u);
  }
  detail::fuses = before;
}

}  // namespace
}  // namespace carom
