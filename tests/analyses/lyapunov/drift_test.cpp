// Does a drift of exponents show where it is larger than their error, and else not?
#include "carom/analyses/lyapunov/drift.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace carom {
namespace {

constexpr double end = 1000.0, from = 200.0, noise = 1.5;
constexpr std::uint64_t orbits = 400;
// Of the mean over the window, whose growth has the variance noise^2 a unit of time.
const double error = noise / std::sqrt((end - from) * orbits);

// How many of 200 ensembles drift, whose deviations have grown by lambda t + `excess` until t, and
// by noise.
template <class Excess>
int seen(Excess excess) {
  int count = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    DriftSums sums;
    for (std::uint64_t i = 0; i < orbits; ++i) {
      DriftSums::Lengths lengths{};
      double length = 0.0, before = 0.0;
      for (std::size_t k = 0; k < lengths.size(); ++k) {
        const double t = end * std::pow(4.0, static_cast<double>(k) - 3.0);
        length += 0.4 * (t - before) + noise * std::sqrt(t - before) * normal(random);
        before = t;
        lengths[k] = length + excess(t);
      }
      sums.add(lengths, end);
    }
    const auto drift = drift_of(sums, {from, end}, {0.4, error});
    EXPECT_TRUE(drift.has_value());
    count += drift && drift->seen;
  }
  return count;
}

// The bias of the window is `errors` of its errors if the rate falls as t^-alpha.
auto power(double alpha, double errors) {
  const auto grown = [alpha](double t) {
    return alpha == 1.0 ? std::log(t) : std::pow(t, 1.0 - alpha) / (1.0 - alpha);
  };
  const double bias = (grown(end) - grown(from)) / (end - from);
  return [=](double t) { return errors * error / bias * grown(t); };
}

TEST(Drift, IsSeenWhereItIsLargerThanTheError) {
  EXPECT_LE(seen([](double) { return 0.0; }), 9);
  EXPECT_LE(seen([](double t) { return -50.0 * std::exp(-t / 2.0); }), 9);
  for (const double sign : {-1.0, 1.0}) {
    EXPECT_GE(seen(power(1.0, 3.0 * sign)), 190);
    EXPECT_GE(seen(power(2.0, 3.0 * sign)), 190);
    EXPECT_GE(seen(power(0.5, 7.0 * sign)), 190);
    EXPECT_GE(seen(power(0.5, 4.0 * sign)), 100);
  }
}

TEST(Drift, GivesTheBiasOfARateThatFallsAsOneOverT) {
  DriftSums sums, other;
  for (int i = 0; i < 400; ++i) {
    const double scatter = i % 2 == 0 ? 1e-3 : -1e-3;
    DriftSums::Lengths lengths{};
    for (std::size_t k = 0; k < lengths.size(); ++k) {
      const double t = end * std::pow(4.0, static_cast<double>(k) - 3.0);
      lengths[k] = 0.4 * t - 0.6 * std::log(t) + scatter * static_cast<double>(k % 2);
    }
    (i % 3 == 0 ? sums : other).add(lengths, end);
  }
  sums.merge(other);
  EXPECT_EQ(sums.orbits, 400u);
  const auto drift = drift_of(sums, {from, end}, {0.4, 1e-5});
  ASSERT_TRUE(drift && drift->seen);
  EXPECT_NEAR(drift->fast.value, -0.6 * std::log(5.0) / 800.0, 1e-9);
  EXPECT_LT(drift->slow.value, drift->fast.value);
}

TEST(Drift, IsNotTestedByFewOrbits) {
  DriftSums sums;
  for (int i = 0; i < 15; ++i) sums.add({1, 2, 3, 4}, end);
  EXPECT_FALSE(drift_of(sums, {from, end}, {0.4, 1e-3}));
  EXPECT_FALSE(drift_of({}, {from, end}, {0.4, 1e-3}));
}

}  // namespace
}  // namespace carom
