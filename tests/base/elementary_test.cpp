#include "carom/base/elementary.hpp"

#include <gtest/gtest.h>
#include <mpfr.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <string>

#include "base/angle.hpp"
#include "carom/base/digest.hpp"

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

class Reference {
 public:
  Reference() { mpfr_inits2(200, x_, y_, result_, static_cast<mpfr_ptr>(nullptr)); }
  ~Reference() { mpfr_clears(x_, y_, result_, static_cast<mpfr_ptr>(nullptr)); }
  Reference(const Reference&) = delete;
  Reference& operator=(const Reference&) = delete;

  using Unary = int (*)(mpfr_ptr, mpfr_srcptr, mpfr_rnd_t);
  // Distance of `value` from f(x) in units in the last place of the latter.
  double ulps(Unary f, double x, double value) {
    mpfr_set_d(x_, x, MPFR_RNDN);
    f(result_, x_, MPFR_RNDN);
    return distance(value);
  }
  double ulps_atan2(double y, double x, double value) {
    mpfr_set_d(x_, x, MPFR_RNDN);
    mpfr_set_d(y_, y, MPFR_RNDN);
    mpfr_atan2(result_, y_, x_, MPFR_RNDN);
    return distance(value);
  }

 private:
  double distance(double value) {
    if (mpfr_zero_p(result_) != 0) return value == 0.0 ? 0.0 : 1e300;
    const mpfr_exp_t exponent = std::max<mpfr_exp_t>(mpfr_get_exp(result_) - 53, -1074);
    mpfr_sub_d(result_, result_, value, MPFR_RNDN);
    mpfr_mul_2si(result_, result_, -exponent, MPFR_RNDN);
    return std::fabs(mpfr_get_d(result_, MPFR_RNDN));
  }
  mpfr_t x_, y_, result_;
};

TEST(Elementary, IsWithinOneUnitInTheLastPlace) {
  Reference reference;
  double sin = 0, cos = 0, both = 0, atan2 = 0, exp = 0, log = 0;
  for (std::uint64_t i = 0; i < 20000; ++i) {
    const double x = argument(i, -40, 30);
    sin = std::max(sin, reference.ulps(mpfr_sin, x, elementary::sin(x)));
    cos = std::max(cos, reference.ulps(mpfr_cos, x, elementary::cos(x)));
    const auto sc = elementary::sincos(x);
    both =
        std::max({both, reference.ulps(mpfr_sin, x, sc.sin), reference.ulps(mpfr_cos, x, sc.cos)});
    const double y = argument(i + 1000000, -40, 30);
    atan2 = std::max(atan2, reference.ulps_atan2(y, x, elementary::atan2(y, x)));
    const double z = argument(i, -20, 9);
    exp = std::max(exp, reference.ulps(mpfr_exp, z, elementary::exp(z)));
    const double positive = std::fabs(argument(i, -1000, 1000));
    log = std::max(log, reference.ulps(mpfr_log, positive, elementary::log(positive)));
  }
  for (const double error : {sin, cos, both, atan2, exp, log}) {
    EXPECT_LE(error, 1.0);
    EXPECT_GT(error, 0.4);  // else nothing was measured
  }
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

// The same number on every machine; a new one here means that orbits change.
TEST(Elementary, HasTheSameBitsOnEveryMachine) {
  const std::uint64_t hash = hash_of_all_bits();
  std::printf("elementary bits %016llx\n", static_cast<unsigned long long>(hash));
  EXPECT_EQ(hash, 0x6e96ca398545b41eu);
}

// glibc's own functions change their last bits when told to do without fused multiply-add.
TEST(Elementary, HasTheSameBitsWithoutFma) {
  const std::string command =
      "GLIBC_TUNABLES=glibc.cpu.hwcaps=-FMA,-AVX2,-FMA4,-FMA_Usable,-AVX2_Usable /proc/" +
      std::to_string(::getpid()) +
      "/exe --gtest_filter=Elementary.HasTheSameBitsOnEveryMachine 2>&1";
  FILE* pipe = ::popen(command.c_str(), "r");
  ASSERT_NE(pipe, nullptr);
  std::string output;
  char line[256];
  while (std::fgets(line, sizeof line, pipe) != nullptr) output += line;
  EXPECT_EQ(::pclose(pipe), 0) << output;
  EXPECT_NE(output.find("[  PASSED  ] 1 test"), std::string::npos) << output;
}

}  // namespace
}  // namespace carom
