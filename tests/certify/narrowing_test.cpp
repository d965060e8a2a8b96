// A bracket of a root made narrow stays inside itself.
#include <gtest/gtest.h>

#include "certify/flight/larmor_quartic.hpp"
#include "random_tables.hpp"

namespace carom::certify {
namespace {

// (r - s)(1 + c (s - e)^2), which falls from 0 to 1; the slope is enclosed there, beyond it may be
// anything.
TEST(Narrowing, StaysInItsBracket) {
  tests::Dice dice(7);
  const Precision precision(200);
  for (int k = 0; k < 2000; ++k) {
    const Ball r(dice.between(0.0, 0.2) * dice.between(0.0, 1.0));
    const Ball c(dice.between(-1.0, 3.0)), e(dice.between(-0.5, 1.5));
    const Ball q0 = Ball(1) + c * e * e, q1 = Ball(-2) * c * e;
    Powers<Ball> f;
    f.degree = 3;
    f.c = {r * q0, r * q1 - q0, r * c - q1, -c, Ball(0)};
    LarmorExit<Ball> exit;
    exit.certain = true;
    exit.low = Ball(0);
    exit.high = Ball(1);
    Ball all = f.slope_at(Ball(0));
    for (int i = 0; i < 64; ++i) {
      const Ball piece = Ball((i + 0.5) / 64.0).widened(Bound(0x1p-7));
      all = union_of(all, f.slope_at(piece));
    }
    if (sign(all) != Sign::negative) continue;
    exit.slope = all;
    const Ball s = narrowed(f, exit);
    EXPECT_TRUE(s.contains(r)) << k;
    // But for the rounding of a radius, which has thirty bits.
    EXPECT_EQ(sign(s + Ball(0x1p-25)), Sign::positive) << k;
    EXPECT_EQ(sign(Ball(1.0 + 0x1p-25) - s), Sign::positive) << k;
  }
}

}  // namespace
}  // namespace carom::certify
