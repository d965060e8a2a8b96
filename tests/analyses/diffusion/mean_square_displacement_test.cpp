#include "carom/analyses/diffusion/mean_square_displacement.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace carom {
namespace {

const std::vector<double> times{0, 1, 2, 4, 8, 16, 32, 64};

// Every trajectory has the same displacement: f(t).
template <class F>
DisplacementMoments moments_of(F f, std::uint64_t trajectories = 300) {
  DisplacementSums sums(times);
  for (std::uint64_t i = 0; i < trajectories; ++i)
    for (std::size_t k = 0; k < times.size(); ++k) sums.add(i, k, {f(times[k])});
  return DisplacementMoments(sums);
}

TEST(Moments, ALineGivesItsSlope) {
  const auto fit =
      moments_of([](double t) { return t == 0 ? 0.0 : 4 * 0.25 * t - 0.5; }).fit({1, 64});
  ASSERT_TRUE(fit);
  EXPECT_EQ(fit->points, 7u);
  EXPECT_NEAR(fit->D.value, 0.25, 1e-12);
  EXPECT_NEAR(fit->offset.value, -0.5, 1e-10);
  EXPECT_NEAR(fit->exponent.value, 1.0, 1e-4);
  EXPECT_NEAR(fit->D.error, 0.0, 1e-12);
}

TEST(Moments, FindTheExponentBesideAnOffset) {
  for (const double a : {0.5, 1.5, 1.96}) {
    const auto fit = moments_of([a](double t) { return 3 * std::pow(t, a) + 7; }).fit({2, 64});
    ASSERT_TRUE(fit);
    EXPECT_NEAR(fit->exponent.value, a, 1e-4);
    EXPECT_LT(fit->local_exponent.value, a) << "the offset counts there";
  }
  const auto pure = moments_of([](double t) { return 3 * std::pow(t, 1.3); });
  EXPECT_NEAR(pure.fit({2, 64})->local_exponent.value, 1.3, 1e-12);
  for (const MomentPoint& p : pure.points()) {
    if (p.t > 1) {
      EXPECT_NEAR(p.exponent.value, 1.3, 1e-12);
    }
  }
}

TEST(Moments, WindowIsTheLastDecadeOrThreeTimes) {
  const auto moments = moments_of([](double t) { return t; });
  EXPECT_EQ(moments.default_window().from, 8.0);
  EXPECT_EQ(moments.default_window().to, 64.0);
  DisplacementSums few({0, 1, 30, 1000});
  EXPECT_EQ(DisplacementMoments(few).default_window().from, 1.0) << "three, but not t = 0";
  EXPECT_FALSE(moments.fit({3, 7})) << "one point has no slope";
}

TEST(Moments, DoNotDependOnTheOrderOfMerging) {
  std::mt19937 random(3);
  std::exponential_distribution<double> square(1.0);
  DisplacementSums whole(times), one(times), other(times);
  for (std::uint64_t i = 0; i < 500; ++i)
    for (std::size_t k = 0; k < times.size(); ++k) {
      const double d = square(random) * std::exp2(static_cast<double>(random() % 60));
      whole.add(i, k, {d});
      (random() % 2 ? one : other).add(i, k, {d});
    }
  DisplacementSums merged(times);
  merged.merge(other);
  merged.merge(one);
  const auto a = DisplacementMoments(whole).points(), b = DisplacementMoments(merged).points();
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_EQ(a[k].count, 500u);
    EXPECT_EQ(a[k].square.value, b[k].square.value);
    EXPECT_EQ(a[k].fourth.value, b[k].fourth.value);
    EXPECT_EQ(a[k].fourth.error, b[k].fourth.error);
  }
}

// Brownian paths with D = 1/2: estimates must scatter as their errors say, although the points of
// one path are correlated.
TEST(Moments, ErrorsAreTheScatterOfBrownianPaths) {
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  constexpr int ensembles = 300, paths = 400;
  double z_D = 0, z_exponent = 0, z_square = 0, z_correlation = 0, z_green_kubo = 0, sum_D = 0;
  for (int e = 0; e < ensembles; ++e) {
    DisplacementSums sums(times);
    for (std::uint64_t i = 0; i < paths; ++i) {
      double x = 0, y = 0;
      for (std::size_t k = 0; k < times.size(); ++k) {
        const double step = k == 0 ? 0 : std::sqrt(times[k] - times[k - 1]);
        x += step * normal(random);
        y += step * normal(random);
        sums.add(i, k, {x * x + y * y, 0.3 + normal(random), 2 + x});
      }
    }
    const DisplacementMoments moments(sums);
    const auto fit = moments.fit({4, 64});
    sum_D += fit->D.value;
    z_D += std::pow((fit->D.value - 0.5) / fit->D.error, 2);
    z_exponent += std::pow((fit->local_exponent.value - 1) / fit->local_exponent.error, 2);
    z_square += std::pow(
        (moments.points().back().square.value - 128) / moments.points().back().square.error, 2);
    const MomentPoint last = moments.points().back();
    z_correlation += std::pow((last.correlation.value - 0.3) / last.correlation.error, 2);
    z_green_kubo += std::pow((last.green_kubo.value - 1) / last.green_kubo.error, 2);
  }
  // Mean of 300 squares of normal numbers: 1 +- 0.08; the error's own error and skewness add to
  // that.
  EXPECT_NEAR(z_D / ensembles, 1.0, 0.3);
  EXPECT_NEAR(z_exponent / ensembles, 1.0, 0.3);
  EXPECT_NEAR(z_square / ensembles, 1.0, 0.3);
  EXPECT_NEAR(z_correlation / ensembles, 1.0, 0.3);
  EXPECT_NEAR(z_green_kubo / ensembles, 1.0, 0.3);
  EXPECT_NEAR(sum_D / ensembles, 0.5, 0.01);
}

TEST(Moments, OneTrajectoryGivesNoError) {
  const auto moments = moments_of([](double t) { return t; }, 1);
  EXPECT_TRUE(std::isnan(moments.points().back().square.error));
  EXPECT_TRUE(std::isnan(moments.fit({1, 64})->D.error));
  EXPECT_EQ(moments.points().back().count, 1u);
}

// Four particles that move as one say no more than one of them.
TEST(Moments, ErrorsCountTrajectoriesNotTheirParticles) {
  std::mt19937_64 random(5);
  std::exponential_distribution<double> square(1.0);
  DisplacementSums one(times), four(times);
  for (std::uint64_t i = 0; i < 1280; ++i)
    for (std::size_t k = 0; k < times.size(); ++k) {
      const double d = times[k] * square(random);
      one.add(i, k, {d});
      for (int particle = 0; particle < 4; ++particle) four.add(i, k, {d});
    }
  const auto a = DisplacementMoments(one).points(), b = DisplacementMoments(four, 4).points();
  for (std::size_t k = 1; k < times.size(); ++k) {
    EXPECT_NEAR(b[k].square.value, a[k].square.value, 1e-12 * a[k].square.value);
    // The jackknife over 128 groups has an error of 6 % of its own.
    EXPECT_NEAR(b[k].square.error, a[k].square.error, 0.25 * a[k].square.error);
  }
}

// Where the best exponent is at the edge of what is searched there is none.
TEST(Moments, HaveNoExponentAtTheEdgeOfTheSearch) {
  const auto steep = moments_of([](double t) { return std::pow(t, 6); }).fit({2, 64});
  ASSERT_TRUE(steep);
  EXPECT_TRUE(std::isnan(steep->exponent.value));
  EXPECT_NEAR(steep->local_exponent.value, 6, 1e-9);
  const auto flat = moments_of([](double t) { return 2 - std::pow(t + 1, -3); }).fit({2, 64});
  ASSERT_TRUE(flat);
  EXPECT_TRUE(std::isnan(flat->exponent.value));
}

}  // namespace
}  // namespace carom
