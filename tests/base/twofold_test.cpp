// Twofold numbers against four-fold arithmetic.
#include "carom/base/twofold.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/quad.hpp"
#include "random_tables.hpp"

namespace carom::tests {
namespace {

Quad quad(const Twofold& x) { return Quad(x.high) + Quad(x.low); }

double relative(const Twofold& x, const Quad& truth) {
  return std::fabs(double((quad(x) - truth) / truth));
}

TEST(Twofold, KeepsAHundredBits) {
  Dice dice(11);
  const auto number = [&] {
    const double high = dice.sign() * dice.spread(1e-6, 1e6);
    return Twofold::quick_sum(high, high * dice.between(-1e-17, 1e-17));
  };
  for (int i = 0; i < 20000; ++i) {
    const Twofold a = number(), b = number();
    const Quad x = quad(a), y = quad(b);
    ASSERT_LT(relative(a * b, x * y), 0x1p-100);
    ASSERT_LT(relative(a / b, x / y), 0x1p-98);
    // Against the larger operand: a difference may cancel.
    ASSERT_LT(std::fabs(double(quad(a + b) - (x + y))),
              0x1p-102 * (std::fabs(a.high) + std::fabs(b.high)));
    ASSERT_LT(std::fabs(double(quad(a - b) - (x - y))),
              0x1p-102 * (std::fabs(a.high) + std::fabs(b.high)));
  }
}

TEST(Twofold, SumsAndProductsOfDoublesAreExact) {
  // With the processor's fused product and without.
  const bool both[] = {detail::fuses, false};
  const bool before = detail::fuses;
  for (const bool fuses : both) {
    detail::fuses = fuses;
    Dice dice(12);
    for (int i = 0; i < 20000; ++i) {
      const double a = dice.sign() * dice.spread(1e-5, 1e5);
      const double b = dice.sign() * dice.spread(1e-5, 1e5);
      EXPECT_EQ(double(quad(Twofold::product(a, b)) - Quad(a) * Quad(b)), 0.0);
      EXPECT_EQ(double(quad(Twofold::sum(a, b)) - (Quad(a) + Quad(b))), 0.0);
    }
  }
  detail::fuses = before;
}

}  // namespace
}  // namespace carom::tests
