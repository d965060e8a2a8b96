#include "carom/base/elementary.hpp"

#include <gtest/gtest.h>
#include <mpfr.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <string>

#include "carom/base/digest.hpp"

namespace carom {
namespace {

// Arguments spread over decades, made by integer operations and exact multiplications only.
double argument(std::uint64_t i, int lowest, int highest) {
  const std::uint64_t a = mix(i);
  const double mantissa = 1.0 + static_cast<double>(a >> 12) * 0x1p-52;
  const int exponent = lowest + static_cast<int>((a & 0xfffu) % static_cast<unsigned>(highest - lowest));
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
    both = std::max({both, reference.ulps(mpfr_sin, x, sc.sin), reference.ulps(mpfr_cos, x, sc.cos)});
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

std::uint64_t hash_of_all_bits() {
  std::uint64_t hash = 0;
  const auto take = [&hash](double value) { hash = mix(hash ^ std::bit_cast<std::uint64_t>(value)); };
  for (std::uint64_t i = 0; i < 100000; ++i) {
    const double x = argument(i, -30, 40);
    const auto both = elementary::sincos(x);
    for (const double value : {elementary::sin(x), elementary::cos(x), both.sin, both.cos,
                               elementary::atan2(argument(i + 1000000, -30, 40), x),
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
  EXPECT_EQ(hash, 0x2d30154c679875b4u);
}

// glibc's own functions change their last bits when told to do without fused multiply-add.
TEST(Elementary, HasTheSameBitsWithoutFma) {
  const std::string command =
      "GLIBC_TUNABLES=glibc.cpu.hwcaps=-FMA,-AVX2,-FMA4,-FMA_Usable,-AVX2_Usable /proc/" +
      std::to_string(::getpid()) + "/exe --gtest_filter=Elementary.HasTheSameBitsOnEveryMachine 2>&1";
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
