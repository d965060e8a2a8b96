// Every operation encloses: the exact answer for any numbers of the operands lies in the result.
#include <gmpxx.h>
#include <gtest/gtest.h>

#include <cmath>

#include "certify/enclosure/error_set.hpp"
#include "certify/number/dual.hpp"
#include "certify/systems.hpp"
#include "random_tables.hpp"

namespace carom {
namespace {

using certify::Ball;
using certify::Bound;
using certify::Interval;
using certify::Precision;

// Of any size, the smallest included, and sometimes whole.
double some_double(tests::Dice& dice) {
  if (dice.whole(0, 9) == 0) return dice.whole(-3, 3);
  const int range = dice.whole(0, 1) == 0 ? 4 : 500;
  return dice.sign() * std::ldexp(dice.between(1.0, 2.0), dice.whole(-range, range));
}

struct Enclosed {
  Interval interval;
  double inside;
};
Enclosed some_interval(tests::Dice& dice) {
  const double a = some_double(dice),
               width = dice.coin() ? 0.0 : std::fabs(a) * std::ldexp(1.0, -dice.whole(0, 60));
  const Interval x{a, a + width};
  const double inside = std::min(x.high, a + width * dice.unit());
  switch (dice.whole(0, 29)) {  // ends may be unknown
    case 0:
      return {{a, HUGE_VAL}, inside};
    case 1:
      return {{-HUGE_VAL, x.high}, inside};
    case 2:
      return {{-HUGE_VAL, HUGE_VAL}, inside};
    default:
      return {x, inside};
  }
}

bool holds(const Interval& x, const mpq_class& exact) {
  const bool above = !std::isfinite(x.low) || mpq_class(x.low) <= exact;
  return above && (!std::isfinite(x.high) || exact <= mpq_class(x.high));
}
// Is the root of `exact` inside? Compared by squares.
bool holds_root(const Interval& x, const mpq_class& exact) {
  const auto below = [&exact](double root) { return mpq_class(root) * mpq_class(root) <= exact; };
  if (std::isfinite(x.low) && x.low > 0.0 && !below(x.low)) return false;
  return !std::isfinite(x.high) ||
         (x.high >= 0.0 && mpq_class(x.high) * mpq_class(x.high) >= exact);
}

TEST(Arithmetic, IntervalsHoldTheExactAnswer) {
  tests::Dice dice(31);
  for (long k = 0; k < tests::cases(200'000, 5'000'000); ++k) {
    const Enclosed a = some_interval(dice), b = some_interval(dice);
    const mpq_class p(a.inside), q(b.inside);
    ASSERT_TRUE(holds(a.interval + b.interval, p + q)) << k;
    ASSERT_TRUE(holds(a.interval - b.interval, p - q)) << k;
    ASSERT_TRUE(holds(-a.interval, -p)) << k;
    ASSERT_TRUE(holds(a.interval * b.interval, p * q)) << k;
    if (sgn(q) != 0) {
      ASSERT_TRUE(holds(a.interval / b.interval, p / q)) << k;
    }
    ASSERT_TRUE(holds(square(a.interval), p * p)) << k;
    if (a.inside >= 0.0) {
      ASSERT_TRUE(holds_root(sqrt(a.interval), p)) << k;
    }
    const Sign s = sign(a.interval);
    if (s != Sign::undecided) {
      ASSERT_EQ(static_cast<int>(s), sgn(p)) << k;
    }
  }
}

// Balls of few bits against the same at many.
TEST(Arithmetic, BallsHoldTheExactAnswer) {
  tests::Dice dice(32);
  for (long k = 0; k < tests::cases(20'000, 500'000); ++k) {
    const int bits = dice.whole(53, 200);
    const double size = some_double(dice), error = std::ldexp(std::fabs(size), -dice.whole(1, 80));
    const double other = some_double(dice);
    const double inside = size + error * dice.between(-0.999, 0.999);
    const auto formula = [](const auto& x, const auto& y) {
      using N = std::decay_t<decltype(x)>;
      return sqrt(square(x - y) + N(1)) * (x + y) / (square(y) + N(3)) - x;
    };
    const auto at = [&](int precision, const Ball& x) {
      const Precision bits_now(precision);
      return formula(x, Ball(other));
    };
    const Ball exact = at(4000, Ball(inside));
    ASSERT_TRUE(at(bits, Ball(inside)).contains(exact)) << k;
    ASSERT_TRUE(
        at(bits, Ball(size).widened(Bound(error + std::fabs(size) * 0x1p-51))).contains(exact))
        << k;
  }
}

// The set of errors holds the image of every point that was in it.
TEST(Arithmetic, ErrorSetsHoldEveryImage) {
  tests::Dice dice(33);
  for (long k = 0; k < tests::cases(300, 10'000); ++k) {
    certify::ErrorSet set;
    const double start = 1e-3;
    set.round(Bound(start), Bound(start));
    double x[4], time = start * dice.between(-1, 1);
    for (double& c : x) c = start * dice.between(-1, 1);
    for (int step = 0; step < 30; ++step) {
      certify::Jacobian J;
      std::array<Interval, 4> times;
      double image[4] = {0, 0, 0, 0};
      for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = 0; j < 4; ++j) {
          const double entry = dice.between(-2, 2), spread = dice.between(0, 1e-3);
          J[i][j] = {entry - spread, entry + spread};
          image[i] += (entry + spread * dice.between(-1, 1)) * x[j];
        }
      }
      for (std::size_t j = 0; j < 4; ++j) {
        const double entry = dice.between(-2, 2);
        times[j] = entry;
        time += entry * x[j];
      }
      set.move(J, times);
      const double rounding = start * dice.unit() * 0.1;
      set.round(Bound(rounding), Bound(rounding));
      for (std::size_t i = 0; i < 4; ++i) x[i] = image[i] + rounding * dice.between(-1, 1);
      time += rounding * dice.between(-1, 1);
      for (std::size_t i = 0; i < 4; ++i)
        ASSERT_LE(std::fabs(x[i]),
                  set.size(static_cast<certify::Direction>(i)).to_double() * (1 + 1e-12))
            << k << " " << step;
      ASSERT_LE(std::fabs(time), set.of_time().to_double() * (1 + 1e-12));
    }
  }
}

// A formula over duals is its derivative.
TEST(Arithmetic, DualsAreDerivatives) {
  tests::Dice dice(34);
  using D = certify::Dual<double>;
  for (int k = 0; k < 1000; ++k) {
    const double x = dice.between(0.5, 2), y = dice.between(0.5, 2), h = 1e-6;
    const auto formula = [](const auto& a, const auto& b) {
      return sqrt(a * a + b) / (a - b * 3.0 + 10.0) + (b - a) * a;
    };
    const auto plain = [&](double a, double b) {
      return std::sqrt(a * a + b) / (a - b * 3.0 + 10.0) + (b - a) * a;
    };
    const D f = formula(D{x, {1, 0, 0, 0}}, D{y, {0, 1, 0, 0}});
    EXPECT_NEAR(f.value, plain(x, y), 1e-14);
    EXPECT_NEAR(f.slope[0], (plain(x + h, y) - plain(x - h, y)) / (2 * h), 1e-7);
    EXPECT_NEAR(f.slope[1], (plain(x, y + h) - plain(x, y - h)) / (2 * h), 1e-7);
  }
}

}  // namespace
}  // namespace carom
