// Every operation of balls encloses: the exact answer for any rational numbers of the operands lies
// in the result.
#include <flint/fmpq.h>
#include <gmpxx.h>
#include <gtest/gtest.h>

#include <cmath>

#include "certify/number/exact_value.hpp"
#include "certify/number/interval.hpp"
#include "certify/systems.hpp"
#include "random_tables.hpp"

/// GMP's own streams are those of one standard library.
template <class T, class U>
void PrintTo(const __gmp_expr<T, U>& x, std::ostream* out) {
  *out << mpq_class(x).get_d();
}

namespace carom {
namespace {

using certify::Ball;
using certify::Bound;
using certify::Interval;
using certify::Precision;
using tests::exactly;

mpq_class power_of_two(long e) {
  mpq_class r = 1;
  if (e >= 0) return r << static_cast<unsigned long>(e);
  return r >> static_cast<unsigned long>(-e);
}
mpq_class rational(arf_srcptr x) {
  fmpq_t value;
  fmpq_init(value);
  arf_get_fmpq(value, x);
  mpq_class r;
  fmpq_get_mpq(r.get_mpq_t(), value);
  fmpq_clear(value);
  return r;
}
mpq_class rational(mag_srcptr x) {
  arf_t value;
  arf_init(value);
  arf_set_mag(value, x);
  mpq_class r = rational(value);
  arf_clear(value);
  return r;
}
mpq_class middle_of(const Ball& x) { return rational(arb_midref(x.raw())); }
mpq_class radius_of(const Ball& x) { return rational(x.radius().raw()); }
bool holds(const Ball& x, const mpq_class& exact) {
  return abs(exact - middle_of(x)) <= radius_of(x);
}

struct Enclosed {
  Ball ball;
  mpq_class inside;
};

// Of any bits, size and width, exact ones, whole numbers and balls about zero among them; the point
// inside is often an end.
Enclosed some_ball(tests::Dice& dice) {
  const long bits = dice.whole(1, 300);
  mpz_class mantissa = 0;
  for (long i = 0; i < bits; ++i) mantissa = 2 * mantissa + dice.whole(0, 1);
  const long exponent = dice.whole(0, 2) == 0 ? dice.whole(-600, 600) : dice.whole(-4, 4) - bits;
  mpq_class middle = mpq_class(mantissa) * power_of_two(exponent);
  if (dice.whole(0, 9) == 0) middle = dice.whole(-3, 3);
  if (dice.coin()) middle = -middle;
  Enclosed e;
  fmpq_t value;
  fmpq_init(value);
  fmpq_set_mpq(value, middle.get_mpq_t());
  arb_set_fmpq(e.ball.raw(), value, 2000);  // of these bits: exact
  fmpq_clear(value);
  if (dice.whole(0, 3) != 0) {
    const mpq_class size = middle == 0 ? mpq_class(1) : mpq_class(abs(middle));
    Bound width(size.get_d() > 0.0 && std::isfinite(size.get_d()) ? size.get_d() : 1.0);
    width = width * Bound(std::ldexp(dice.between(0.5, 1.0), dice.whole(-120, 2)));
    e.ball = e.ball.widened(width);
  }
  const mpq_class part =
      dice.whole(0, 3) == 0 ? mpq_class(dice.whole(-1, 1)) : mpq_class(dice.between(-1.0, 1.0));
  e.inside = middle + part * radius_of(e.ball);
  return e;
}

TEST(Arithmetic, EveryOperationOfBallsHoldsTheExactAnswer) {
  tests::Dice dice(34);
  int signs = 0;
  for (long k = 0; k < tests::cases(20'000, 1'000'000); ++k) {
    const Enclosed a = some_ball(dice), b = some_ball(dice);
    const mpq_class &p = a.inside, &q = b.inside;
    ASSERT_TRUE(holds(a.ball, p)) << k;
    const Precision bits(dice.whole(2, 250));
    ASSERT_TRUE(holds(a.ball + b.ball, p + q)) << k;
    ASSERT_TRUE(holds(a.ball - b.ball, p - q)) << k;
    ASSERT_TRUE(holds(-a.ball, -p)) << k;
    ASSERT_TRUE(holds(a.ball * b.ball, p * q)) << k;
    ASSERT_TRUE(holds(square(a.ball), p * p)) << k;
    ASSERT_TRUE(holds(a.ball.rounded(), p)) << k;
    ASSERT_TRUE(holds(a.ball.midpoint(), middle_of(a.ball))) << k;
    ASSERT_TRUE(holds(a.ball.midpoint().widened(a.ball.radius()), p)) << k;
    if (sgn(q) != 0) {
      const Ball quotient = a.ball / b.ball;  // not a number where the divisor may be zero
      if (arb_is_finite(quotient.raw()) != 0) {
        ASSERT_TRUE(holds(quotient, p / q)) << k;
      } else {
        ASSERT_LE(abs(middle_of(b.ball)), radius_of(b.ball)) << k;
      }
    }
    if (sgn(p) >= 0) {  // the root of p, by squares of the ends
      const Ball root = sqrt(a.ball);
      const mpq_class low = middle_of(root) - radius_of(root),
                      high = middle_of(root) + radius_of(root);
      ASSERT_TRUE(sgn(low) <= 0 || low * low <= p) << k;
      ASSERT_TRUE(sgn(high) >= 0 && high * high >= p) << k;
    }
    const Sign s = sign(a.ball);
    if (s != Sign::undecided) {
      ++signs;
      ASSERT_EQ(static_cast<int>(s), sgn(p)) << k;
    }
    const Interval around = certify::interval_of(a.ball, Bound(0x1p-30));
    const mpq_class beside = p + mpq_class(dice.between(-1.0, 1.0) * 0x1p-30);
    ASSERT_TRUE(!std::isfinite(around.low) || mpq_class(around.low) <= beside) << k;
    ASSERT_TRUE(!std::isfinite(around.high) || beside <= mpq_class(around.high)) << k;
  }
  EXPECT_GT(signs, 10'000);
}

// Sizes of errors round up, and are not rounded up by much.
TEST(Arithmetic, BoundsRoundUp) {
  tests::Dice dice(35);
  for (long k = 0; k < tests::cases(20'000, 1'000'000); ++k) {
    const double x = std::ldexp(dice.between(1.0, 2.0), dice.whole(-500, 500)),
                 y = std::ldexp(dice.between(1.0, 2.0), dice.whole(-500, 500));
    const Bound a(x), b(y);
    const mpq_class p(x), q(y);
    ASSERT_TRUE(rational(a.raw()) >= p) << k;
    ASSERT_TRUE(rational((a + b).raw()) >= p + q) << k;
    ASSERT_TRUE(rational((a * b).raw()) >= p * q) << k;
    ASSERT_TRUE(mpq_class(a.to_double()) >= rational(a.raw())) << k;
    ASSERT_TRUE(rational((a + b).raw()) <= (p + q) * mpq_class(1 + 0x1p-26)) << k;
    ASSERT_TRUE(rational((a * b).raw()) <= p * q * mpq_class(1 + 0x1p-26)) << k;
    ASSERT_NEAR(a.log2(), std::log2(x), 1e-6) << k;
  }
}

// Numbers as they are written, at few bits and at many.
TEST(Arithmetic, WrittenNumbersAreEnclosed) {
  for (const char* text : {"0.1", "1/3", "-7/10^20", "sqrt(2)", "sqrt(3)/2", "pi/4", "pi*1.1-1/20",
                           "2-2/10^20", "(1+sqrt(5))/2", "1e-300", "3^40"}) {
    const auto at = [&](long bits) {
      const Precision precision(bits);
      return certify::value_of(exactly(text));
    };
    const Ball exact = at(5000);
    for (const long bits : {53L, 64L, 100L, 333L, 2000L}) {
      const Ball few = at(bits);
      EXPECT_TRUE(few.contains(exact)) << text << " at " << bits;
      EXPECT_LT(radius_of(few), abs(middle_of(few)) * power_of_two(8 - bits))
          << text << " at " << bits;
    }
  }
  const Precision precision(200);
  EXPECT_TRUE(holds(certify::value_of(exactly("-7/10^20")),
                    mpq_class(-7) / mpq_class("100000000000000000000")));
  EXPECT_TRUE(holds(certify::value_of(exactly("0.1")), mpq_class(1, 10)));
  EXPECT_FALSE(
      holds(certify::value_of(exactly("0.1")), mpq_class(0.1)));  // the double is another number
}

// Directions from angles, against the identities they must fulfil.
TEST(Arithmetic, DirectionsAreEnclosed) {
  for (const char* text : {"0", "pi/2", "pi", "pi/3", "1", "-1/7", "100", "22/7"}) {
    const Precision precision(150);
    const certify::CosSin d = certify::direction_of(exactly(text)),
                          turned = certify::direction_of(exactly(text), 1, 4);
    EXPECT_TRUE((square(d.cos) + square(d.sin)).contains(Ball(1))) << text;
    EXPECT_TRUE(turned.cos.overlaps(-d.sin) && turned.sin.overlaps(d.cos)) << text;
    EXPECT_LT(radius_of(d.cos) + radius_of(d.sin), power_of_two(-130)) << text;
    const double angle = certify::value_of(exactly(text)).to_double();
    EXPECT_NEAR(d.cos.to_double(), std::cos(angle), 1e-13) << text;
    EXPECT_NEAR(d.sin.to_double(), std::sin(angle), 1e-13) << text;
  }
}

}  // namespace
}  // namespace carom
