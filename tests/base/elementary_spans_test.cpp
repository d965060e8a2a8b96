// Functions of many numbers at once have the bits of one at a time.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "base/kernel/elementary_kernel.hpp"
#include "carom/base/elementary.hpp"

namespace carom {
namespace {

TEST(ElementarySpans, ExponentialsHaveTheBitsOfOneByOne) {
  std::mt19937_64 generator(4);
  std::uniform_real_distribution<double> common(-40.0, 5.0), wide(-760.0, 720.0);
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (std::size_t n = 0; n < 70; ++n)
    for (int repeat = 0; repeat < 50; ++repeat) {
      // Any number may stand in any lane beside any other.
      std::vector<double> x(n + 1);
      for (double& one : x) one = repeat % 2 == 0 ? common(generator) : wide(generator);
      for (const double odd : {infinity, -infinity, 0.0, -0.0, 1e-310, 709.9, -745.5, std::nan("")})
        if (generator() % 4 == 0) x[generator() % x.size()] = odd;
      std::vector<double> at_once = x;
      elementary::exp(std::span(at_once.data(), n));  // the last is to stay
      for (std::size_t i = 0; i < n; ++i) {
        if (std::isnan(x[i])) {
          EXPECT_TRUE(std::isnan(at_once[i]));
          continue;
        }
        EXPECT_EQ(std::bit_cast<std::uint64_t>(at_once[i]),
                  std::bit_cast<std::uint64_t>(elementary::exp(x[i])))
            << x[i] << " at " << i << " of " << n;
      }
      EXPECT_EQ(std::bit_cast<std::uint64_t>(at_once[n]), std::bit_cast<std::uint64_t>(x[n]));
    }
}

TEST(ElementarySpans, AnglesHaveTheBitsOfOneByOne) {
  std::mt19937_64 generator(5);
  std::uniform_real_distribution<double> part(0.0, 1.0), wide(-1e3, 1e3);
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (std::size_t n = 0; n < 70; ++n)
    for (int repeat = 0; repeat < 50; ++repeat) {
      std::vector<double> y(n + 1);
      for (double& one : y) one = repeat % 2 == 0 ? part(generator) : wide(generator);
      for (const double odd : {infinity, -infinity, 0.0, -0.0, 1e-310, 1.0, -1.0, 1e300})
        if (generator() % 4 == 0) y[generator() % y.size()] = odd;
      const double x = repeat % 3 == 0 ? wide(generator) : 1.0;
      std::vector<double> at_once = y;
      elementary::atan2(std::span(at_once.data(), n), x);  // the last is to stay
      for (std::size_t i = 0; i <= n; ++i)
        EXPECT_EQ(std::bit_cast<std::uint64_t>(at_once[i]),
                  std::bit_cast<std::uint64_t>(i < n ? elementary::atan2(y[i], x) : y[i]))
            << y[i] << " at " << i << " of " << n;
    }
}

// Of 8, 4 and 2 numbers, as far as the processor has them.
TEST(ElementarySpans, EveryWidthOfRegistersHasTheBitsOfOneByOne) {
  using base::atan2_of_many;
  std::mt19937_64 generator(6);
  std::uniform_real_distribution<double> exponent(-760.0, 720.0), side(-1e3, 1e3);
  std::vector<void (*)(double*, double, std::size_t)> angles{atan2_of_many<2>};
#if defined(__x86_64__) && !defined(__clang__)
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
    angles.push_back(atan2_of_many<4>);
  if (__builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
    angles.push_back(atan2_of_many<8>);
#endif
  for (int repeat = 0; repeat < 500; ++repeat) {
    std::vector<double> x(136), y(136);
    for (double& one : x) one = exponent(generator);
    for (double& one : y) one = side(generator);
    for (const int width : {2, 4, 8}) {
      std::vector<double> at_once = x;
      elementary::exp_by(width)(at_once.data(), at_once.size());
      for (std::size_t i = 0; i < x.size(); ++i)
        EXPECT_EQ(std::bit_cast<std::uint64_t>(at_once[i]),
                  std::bit_cast<std::uint64_t>(elementary::exp(x[i])))
            << x[i] << " by " << width;
    }
    for (const auto of_many : angles) {
      std::vector<double> at_once = y;
      of_many(at_once.data(), 1.3, at_once.size());
      for (std::size_t i = 0; i < y.size(); ++i)
        EXPECT_EQ(std::bit_cast<std::uint64_t>(at_once[i]),
                  std::bit_cast<std::uint64_t>(elementary::atan2(y[i], 1.3)))
            << y[i];
    }
  }
}

}  // namespace
}  // namespace carom
