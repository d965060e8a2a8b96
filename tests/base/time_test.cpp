#include "carom/base/time.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "carom/base/exact_sum.hpp"
#include "carom/base/random.hpp"

namespace carom {
namespace {

TEST(Time, AddsAMillionFlightsWithoutLoss) {
  RandomStream random(1, Purpose::initial_state, 0);
  Time time;
  ExactSum exact;
  for (int i = 0; i < 1000000; ++i) {
    const double flight = random.uniform();
    time = time + flight;
    exact.add(flight);
  }
  EXPECT_EQ(time.value(), exact.value());
  exact.add(-time.high);
  EXPECT_NEAR(time.low, exact.value(), 1e-20);  // a double alone is off by 1e-10 here
}

TEST(Time, ComparesBothParts) {
  const Time start(1e10);
  const Time later = start + 1e-12;
  EXPECT_EQ(start.high, later.high);
  EXPECT_LT(start, later);
  EXPECT_EQ(later - start, 1e-12);
  EXPECT_EQ(Time(3.0), Time(1.0) + 2.0);
}

TEST(Time, KeepsTheLowPartBelowHalfAnUlp) {
  RandomStream random(2, Purpose::initial_state, 0);
  Time time(1e-300);
  for (int i = 0; i < 10000; ++i) {
    time = time + random.uniform();
    ASSERT_EQ(time.high + time.low, time.high);
  }
}

}  // namespace
}  // namespace carom
