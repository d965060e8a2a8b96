#include "carom/base/exact_sum.hpp"

#include <gtest/gtest.h>
#include <mpfr.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "carom/base/error.hpp"

namespace carom {
namespace {

constexpr double smallest = 0x1p-1074;
const double largest = std::numeric_limits<double>::max();
const double infinity = std::numeric_limits<double>::infinity();

ExactSum sum_of(const std::vector<double>& terms) {
  ExactSum sum;
  for (const double x : terms) sum.add(x);
  return sum;
}

// The sum in so many bits that nothing is rounded before the end.
double reference(const std::vector<double>& terms) {
  mpfr_t sum;
  mpfr_init2(sum, 2400);
  mpfr_set_zero(sum, 1);
  for (const double x : terms) EXPECT_EQ(mpfr_add_d(sum, sum, x, MPFR_RNDN), 0);
  const double rounded = mpfr_get_d(sum, MPFR_RNDN);
  mpfr_clear(sum);
  return rounded;
}

std::vector<double> random_terms(std::mt19937_64& random, std::size_t count, unsigned exponents) {
  std::vector<double> terms;
  while (terms.size() < count) {
    const std::uint64_t low = exponents >= 2047 ? 0 : 1023 - exponents / 2;
    const std::uint64_t bits = random();
    const std::uint64_t exponent = low + (bits >> 52) % exponents;
    const double x = std::bit_cast<double>((random() & 1u) << 63 |
                                           std::min<std::uint64_t>(exponent, 2040) << 52 |
                                           (bits & ((std::uint64_t{1} << 52) - 1)));
    terms.push_back(x);
    if (random() % 3 == 0) terms.push_back(-x);
  }
  return terms;
}

TEST(ExactSum, RoundsTheExactSumOnce) {
  std::mt19937_64 random(1);
  for (const unsigned exponents : {1u, 2u, 4u, 60u, 200u, 2047u}) {
    for (int i = 0; i < 300; ++i) {
      const auto terms = random_terms(random, 1 + random() % 40, exponents);
      ASSERT_EQ(sum_of(terms).value(), reference(terms));
    }
  }
}

TEST(ExactSum, RoundsTiesToEven) {
  EXPECT_EQ(sum_of({0x1p53, 1.0}).value(), 0x1p53);
  EXPECT_EQ(sum_of({0x1p53, 3.0}).value(), 0x1p53 + 4);
  EXPECT_EQ(sum_of({0x1p53, 1.0, smallest}).value(), 0x1p53 + 2);
  EXPECT_EQ(sum_of({0x1p53, 1.0, -smallest}).value(), 0x1p53);
  EXPECT_EQ(sum_of({-0x1p53, -1.0}).value(), -0x1p53);
  EXPECT_EQ(sum_of({-0x1p53, -1.0, -smallest}).value(), -0x1p53 - 2);
  EXPECT_EQ(sum_of({0x1.fffffffffffffp52, 0.5}).value(), 0x1p53);  // the carry raises the exponent
}

TEST(ExactSum, KeepsTheSmallestBesideTheLargest) {
  EXPECT_EQ(sum_of({largest, smallest, -largest}).value(), smallest);
  EXPECT_EQ(sum_of({1e300, 1.0, -1e300, smallest, -1.0}).value(), smallest);
  EXPECT_EQ(sum_of({smallest, smallest, smallest}).value(), 3 * smallest);
  EXPECT_EQ(sum_of({0x1p-1022, -smallest}).value(), 0x1p-1022 - smallest);
  EXPECT_EQ(sum_of({}).value(), 0.0);
  EXPECT_EQ(sum_of({-0.0}).value(), 0.0);
  EXPECT_FALSE(std::signbit(sum_of({-0.0, 1.0, -1.0}).value()));
}

TEST(ExactSum, OverflowsOnlyAtTheEnd) {
  EXPECT_EQ(sum_of({largest, largest, -largest}).value(), largest);
  EXPECT_EQ(sum_of({largest, largest}).value(), infinity);
  EXPECT_EQ(sum_of({-largest, -largest}).value(), -infinity);
  EXPECT_EQ(sum_of({largest, 0x1p970}).value(), infinity);  // the tie rounds up
  EXPECT_EQ(sum_of({largest, 0x1p970, -smallest}).value(), largest);
}

TEST(ExactSum, DoesNotDependOnTheOrderOfMerging) {
  std::mt19937_64 random(2);
  for (int i = 0; i < 200; ++i) {
    auto terms = random_terms(random, 60, i % 2 == 0 ? 2047u : 100u);
    const ExactSum whole = sum_of(terms);
    std::shuffle(terms.begin(), terms.end(), random);
    std::vector<ExactSum> parts(8);
    for (const double x : terms) parts[random() % parts.size()].add(x);
    while (parts.size() > 1) {  // merge two random parts, as a random tree
      std::shuffle(parts.begin(), parts.end(), random);
      const ExactSum last = parts.back();
      parts.pop_back();
      parts.back().merge(last);
    }
    ASSERT_EQ(parts.front().state(), whole.state());
    ASSERT_EQ(parts.front().value(), reference(terms));
  }
}

TEST(ExactSum, HoldsMoreTermsThanWillEverBeAdded) {
  ExactSum sum = sum_of({largest}), negative = sum_of({-largest});
  for (int i = 0; i < 100; ++i) {
    sum.merge(sum);
    negative.merge(ExactSum(negative));
  }
  EXPECT_EQ(sum.value(), infinity);
  sum.merge(negative);
  sum.add(1.5);
  EXPECT_EQ(sum.value(), 1.5);
}

TEST(ExactSum, ComesBackFromItsState) {
  std::mt19937_64 random(3);
  for (int i = 0; i < 50; ++i) {
    const auto terms = random_terms(random, 30, 300);
    const ExactSum sum = sum_of(terms);
    ExactSum back = ExactSum::from_state(sum.state());
    EXPECT_EQ(back.value(), sum.value());
    back.add(-1.0);
    EXPECT_EQ(back.state(), [&] {
      ExactSum s = sum;
      s.add(-1.0);
      return s.state();
    }());
  }
  auto broken = ExactSum().state();
  broken[3] = -1;
  EXPECT_THROW(ExactSum::from_state(broken), InputError);
}

TEST(ExactSum, RefusesWhatIsNotFinite) {
  ExactSum sum;
  EXPECT_THROW(sum.add(infinity), InternalError);
  EXPECT_THROW(sum.add(-infinity), InternalError);
  EXPECT_THROW(sum.add(std::numeric_limits<double>::quiet_NaN()), InternalError);
  EXPECT_EQ(sum.value(), 0.0);
}

}  // namespace
}  // namespace carom
