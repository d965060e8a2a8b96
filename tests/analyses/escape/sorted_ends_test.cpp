#include "analyses/escape/sorted_ends.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace carom::analyses {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(SortedEnds, FindsWhatASearchByHalvesFinds) {
  std::vector<double> dense, wide, from_zero{-1.0, 0.0};
  for (int i = 0; i < 1000; ++i) dense.push_back(500.0 + i);
  for (int i = -300; i <= 300; i += 25) wide.push_back(std::pow(10.0, i));
  for (int i = 1; i < 9; ++i) from_zero.push_back(0.125 * i);
  for (const std::vector<double>& ends :
       {dense, wide, from_zero, {1.0}, {-2.0, -1.0}, {}, {1.0, std::nextafter(1.0, 2.0), 1.5}}) {
    const SortedEnds sorted(ends);
    std::vector<double> numbers{-infinity, -1.5, -0.0, 0.0, 5e-324, 1e300, infinity};
    for (const double end : ends)
      for (const double number :
           {std::nextafter(end, -infinity), end, std::nextafter(end, infinity), 1.01 * end})
        numbers.push_back(number);
    for (const double number : numbers)
      EXPECT_EQ(sorted.first_from(number),
                static_cast<std::size_t>(std::lower_bound(ends.begin(), ends.end(), number) -
                                         ends.begin()))
          << number << " of " << ends.size();
  }
}

}  // namespace
}  // namespace carom::analyses
