// Comparison of long doubles: GoogleTest's NEAR rounds to double.
#pragma once

#include <gtest/gtest.h>

#include <cmath>

#define EXPECT_WITHIN(a, b, tolerance) \
  EXPECT_LE(std::abs((a) - (b)), tolerance) << #a " = " << (a) << ", " #b " = " << (b)
#define ASSERT_WITHIN(a, b, tolerance) \
  ASSERT_LE(std::abs((a) - (b)), tolerance) << #a " = " << (a) << ", " #b " = " << (b)
