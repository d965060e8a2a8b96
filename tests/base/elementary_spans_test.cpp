// Functions of many numbers at once have the bits of one at a time.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

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

}  // namespace
}  // namespace carom
