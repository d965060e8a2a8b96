// Contact times against closed forms and dense sampling; what contacts conserve.
#include "motion/contact.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "carom/base/random.hpp"
#include "motion/free_motion.hpp"

namespace carom::tests {

using namespace motion;

namespace {

using geometry::Vector;

double gap_at(const PairFlight& p, double reach, double t) {
  const Vector x = moved({}, p.first, p.first_omega, t).first,
               y = moved({}, p.second, p.second_omega, t).first;
  const Vector d = p.separation + (x - y);
  return std::sqrt(dot(d, d)) - reach;
}

/// The slow witness: looks every `step` for a change of sign, then halves.
double sampled_contact(const PairFlight& p, double reach, double until, double step) {
  double before = 0.0;
  for (double t = step; t < until; t += step) {
    if (gap_at(p, reach, before) > 0.0 && gap_at(p, reach, t) < 0.0) {
      double a = before, b = t;
      for (int i = 0; i < 100; ++i) {
        const double m = 0.5 * (a + b);
        (gap_at(p, reach, m) > 0.0 ? a : b) = m;
      }
      return a;
    }
    before = t;
  }
  return no_contact;
}

PairFlight random_pair(RandomStream& random, double first_omega, double second_omega) {
  PairFlight p;
  do {
    p.separation = {3.0 * random.symmetric(), 3.0 * random.symmetric()};
  } while (dot(p.separation, p.separation) < 1.05);
  p.first = {random.symmetric(), random.symmetric()};
  p.second = {random.symmetric(), random.symmetric()};
  p.first_omega = first_omega;
  p.second_omega = second_omega;
  return p;
}

TEST(Contact, StraightFlightsMeetHeadOnAndObliquely) {
  EXPECT_EQ(time_to_contact({-3, 0}, {1, 0}, 0.0, 1.0), 2.0);
  EXPECT_EQ(time_to_contact({-3, 0}, {-1, 0}, 0.0, 1.0), no_contact);
  // Impact parameter 3/5 of the reach: the centres are 4/5 along the flight at contact.
  EXPECT_DOUBLE_EQ(time_to_contact({-3, 0.6}, {2, 0}, 0.0, 1.0), (3 - 0.8) / 2);
  EXPECT_EQ(time_to_contact({-3, 1}, {2, 0}, 0.0, 1.0), no_contact);  // touches in passing
}

TEST(Contact, TouchingDiscsMeetNowOrHaveMet) {
  EXPECT_EQ(time_to_contact({1, 0}, {-1, 0}, 0.0, 1.0), 0.0);
  EXPECT_EQ(time_to_contact({1, 0}, {1, 0}, 0.0, 1.0), no_contact);
  const double inside = std::nextafter(1.0, 0.0);
  EXPECT_EQ(time_to_contact({inside, 0}, {-1, 0.5}, 0.0, 1.0), 0.0);
  // In a field they come back, but not at once: the relative flight closes after a turn.
  for (const double gap : {-1e-16, 0.0, 1e-16}) {
    const double t = time_to_contact({1 + gap, 0}, {0.5, 0.125}, 1.0, 1.0);
    EXPECT_GT(t, 1.0);
    EXPECT_LT(t, 6.28318);
    const PairFlight pair{{1 + gap, 0}, {0.5, 0.125}, {0, 0}, 1.0, 1.0};
    EXPECT_NEAR(t, enclosed_time_to_contact(pair, 1.0, 10.0), 1e-13);
    EXPECT_NEAR(gap_at(pair, 1.0, t), 0.0, 1e-15);
  }
}

TEST(Contact, EqualLarmorFlightsAgreeWithDenseSampling) {
  RandomStream random(3, Purpose::initial_state, 0);
  int contacts = 0;
  for (int i = 0; i < 300; ++i) {
    const double omega = 2.0 * random.symmetric();
    const PairFlight p = random_pair(random, omega, omega);
    const double turn = 6.283185307179586 / std::fabs(omega), until = std::min(turn, 50.0);
    const double t = time_to_contact(p, 1.0, until);
    const double seen = sampled_contact(p, 1.0, until, 2e-3);
    if (seen < no_contact) {
      ++contacts;
      EXPECT_NEAR(t, seen, 1e-12 * (1 + t)) << i;
      EXPECT_NEAR(gap_at(p, 1.0, t), 0.0, 1e-14);
    } else {
      EXPECT_GE(t, until) << i;
    }
    const double enclosed = enclosed_time_to_contact(p, 1.0, until);
    if (t < until) {
      EXPECT_NEAR(t, enclosed, 1e-10) << i;
    } else {
      EXPECT_GE(enclosed, until) << i;
    }
  }
  EXPECT_GT(contacts, 50);
}

TEST(Contact, UnequalLarmorFlightsAgreeWithDenseSampling) {
  RandomStream random(4, Purpose::initial_state, 0);
  int contacts = 0;
  for (int i = 0; i < 300; ++i) {
    const PairFlight p =
        random_pair(random, 2.0 * random.symmetric(), i % 3 == 0 ? 0.0 : 3.0 * random.symmetric());
    const double t = time_to_contact(p, 1.0, 20.0);
    const double seen = sampled_contact(p, 1.0, 20.0, 2e-3);
    contacts += seen < no_contact;
    if (seen < no_contact) {
      EXPECT_NEAR(t, seen, 1e-12 * (1 + t)) << i;
    } else {
      EXPECT_GE(t, 20.0) << i;
    }
    // How far one asks changes no bit.
    if (t < 20.0) {
      EXPECT_EQ(t, time_to_contact(p, 1.0, std::nextafter(t, 100.0)));
    }
  }
  EXPECT_GT(contacts, 50);
}

// The plain search looks at every stride.
TEST(Contact, BoundsLeaveOutNoContactOfThePlainSearch) {
  RandomStream random(11, Purpose::initial_state, 0);
  std::int64_t contacts = 0, strides = 0, plain = 0;
  for (int i = 0; i < 2000; ++i) {
    // Any two; one that flies straight; turns in nearly or exactly whole ratios.
    const double omega = std::ldexp(random.symmetric(), i % 7);
    double other = 3.0 * random.symmetric();
    if (i % 5 == 0) other = 0.0;
    if (i % 5 == 1) other = -omega;
    if (i % 5 == 2)
      other = 2.0 * omega * (1.0 + (i % 2) * std::ldexp(random.symmetric(), -(i % 40)));
    if (i % 5 == 3)
      other = 1.5 * omega * (1.0 + (i % 2) * std::ldexp(random.symmetric(), -(i % 40)));
    PairFlight p = random_pair(random, omega, other);
    if (i % 3 == 0) p.separation = std::ldexp(1.0, i % 11) * p.separation;
    if (i % 11 == 0) p.second = std::ldexp(1.0, -(i % 13)) * p.second;
    if (i % 17 == 0) p.second = {};
    const double until = 100.0, t = guided_time_to_contact(p, 1.0, until, &strides);
    const double expected = enclosed_time_to_contact(p, 1.0, until);
    plain += static_cast<std::int64_t>(std::min(expected, until) *
                                       std::max(std::fabs(omega), std::fabs(other)));
    if (expected < until) {
      ++contacts;
      EXPECT_EQ(t, expected) << i;
    } else {
      EXPECT_GE(t, until) << i;
    }
  }
  EXPECT_GT(contacts, 200);
  EXPECT_LT(strides, plain / 4);
}

TEST(Contact, IsFoundInAnyFieldInABoundedNumberOfStrides) {
  RandomStream random(12, Purpose::initial_state, 0);
  for (const double field : {1e3, 1e6, 1e9, 1e14, 1e20, 1e300}) {
    std::int64_t strides = 0;
    int contacts = 0;
    for (int i = 0; i < 400; ++i) {
      double omega = field,
             other = i % 4 == 0 ? 0.0 : (i % 4 == 1 ? -1.0 : (i % 4 == 2 ? 2.0 : 0.7)) * field;
      if (i % 8 > 3) std::swap(omega, other);
      PairFlight p = random_pair(random, omega, other);
      const bool straight = omega == 0.0 || other == 0.0;
      if (!straight) p.separation = (1.0 / field) * p.separation;  // as near as their circles are
      const double reach = straight ? 1.0 : 1.0 / field, until = 1e3;
      const double t = guided_time_to_contact(p, reach, until, &strides);
      // A circle that is so small is a point: the line meets it as one at rest.
      if (straight && field > 1e6) {
        (omega == 0.0 ? p.second : p.first) = {};
        const double at_rest = time_to_contact(p.separation, p.first - p.second, 0.0, reach);
        if (at_rest < no_contact) {
          EXPECT_NEAR(t, at_rest, 1e-4 * (1.0 + at_rest)) << field;
        } else {
          EXPECT_EQ(t, no_contact);
        }
      }
      contacts += t < until;
    }
    EXPECT_GT(contacts, 100) << field;
    EXPECT_LT(strides, 400 * 3000) << field;
  }
}

TEST(Contact, DoesNotDependOnWhoAsks) {
  RandomStream random(5, Purpose::initial_state, 0);
  for (int i = 0; i < 500; ++i) {
    const double omega = i % 2 ? random.symmetric() : 0.0;
    const PairFlight p = random_pair(random, omega, i % 4 ? omega : 2 * random.symmetric());
    const PairFlight q{-p.separation, p.second, p.first, p.second_omega, p.first_omega};
    EXPECT_EQ(time_to_contact(p, 1.0, 20.0), time_to_contact(q, 1.0, 20.0));
  }
}

TEST(Contact, ConservesMomentumAndEnergyForAnyMasses) {
  RandomStream random(6, Purpose::initial_state, 0);
  for (int i = 0; i < 1000; ++i) {
    const PairFlight p = random_pair(random, 0, 0);
    const double t = time_to_contact(p, 1.0, 0.0);
    if (!(t < no_contact)) continue;
    const Vector d = p.separation + t * (p.first - p.second);
    const double m = 0.1 + random.uniform(), n = i % 2 ? m : 10.0 * (0.1 + random.uniform());
    const ElasticContact c = elastic_contact(d, p.first, p.second, m, n);
    const auto momentum = [&](Vector v, Vector w) { return m * v + n * w; };
    const auto energy = [&](Vector v, Vector w) { return m * dot(v, v) + n * dot(w, w); };
    const Vector lost = momentum(c.first, c.second) - momentum(p.first, p.second);
    EXPECT_NEAR(lost.x, 0.0, 1e-14);
    EXPECT_NEAR(lost.y, 0.0, 1e-14);
    EXPECT_NEAR(energy(c.first, c.second), energy(p.first, p.second), 2e-14);
    EXPECT_GT(dot(d, c.first - c.second), 0.0);
    // The relative velocity along the line of centres is turned round.
    EXPECT_NEAR(dot(d, c.first - c.second), -dot(d, p.first - p.second), 1e-14);
    EXPECT_NEAR(geometry::cross(d, c.first - c.second), geometry::cross(d, p.first - p.second),
                1e-14);
    EXPECT_NEAR(c.transfer, m * std::sqrt(dot(c.first - p.first, c.first - p.first)), 1e-14);
  }
}

TEST(Contact, GrazingLeavesThePairMovingApart) {
  // The change of velocity is far below the velocities' last digits.
  for (const double slow : {1e-16, 1e-20, 1e-30, 1e-300}) {
    const ElasticContact c = elastic_contact({1.0, 0.0}, {-slow, 1.0}, {0.0, 0.9}, 1.0, 2.0);
    EXPECT_GT(dot(Vector{1.0, 0.0}, c.first - c.second), 0.0);
    const ElasticContact o =
        elastic_contact({0.6, 0.8}, {0.8 - 0.6 * slow, -0.6 - 0.8 * slow}, {0.0, 0.0}, 1.0, 1.0);
    EXPECT_GT(dot(Vector{0.6, 0.8}, o.first - o.second), 0.0);
    EXPECT_NEAR(dot(o.first, o.first) + dot(o.second, o.second), 1.0, 1e-15);
  }
}

}  // namespace
}  // namespace carom::tests
