// Where certified orbits end, and what they ask of themselves: no number leaves with less than the
// digits asked for.
#include <gtest/gtest.h>

#include <cmath>

#include "carom/base/error.hpp"
#include "certify/attempt.hpp"
#include "certify/systems.hpp"

namespace carom {
namespace {

using tests::exactly;
using tests::Shaped;
using tests::task_of;

Shaped stadium(const std::string& size) {
  return tests::shaped("stadium", {{"half_length", size.c_str()}, {"radius", size.c_str()}}, "0",
                       "0");
}
ExactSystem flying(const Shaped& s, const char* speed) {
  ExactSystem system = tests::system_of(s, {exactly("0.6"), exactly("0.7")});
  system.speed = exactly(speed);
  return system;
}

void expect_digits(const CertifiedState& s, int digits) {
  for (const CertifiedNumber* x : {&s.t, &s.x, &s.y, &s.vx, &s.vy})
    EXPECT_LT(x->log2_error(), -static_cast<double>(digits) * std::log2(10.0) - 1.0);
}

TEST(CertifiedLimits, WithoutBitsTheEndIsTheLastHit) {
  const ExactSystem system = flying(stadium("1"), "1");
  for (const long most_bits : {60L, 150L, 300L, 1000L}) {
    CertifiedTask task = task_of(2000, 20);
    task.most_bits = most_bits;
    // The forecast asks for more: many hits by few attempts are had by those that grow.
    for (const std::uint64_t hits : {20u, 200u, 2000u}) {
      task.collisions = hits;
      CertifiedOrbit orbit(system, task);
      std::uint64_t given = 0;
      CertifiedHit last;
      for (const CertifiedHit& hit : orbit) {
        expect_digits(hit, task.digits);
        last = hit;
        ++given;
      }
      const CertifiedEnd& end = orbit.end_state();
      expect_digits(end, task.digits);
      EXPECT_EQ(end.collisions, given);
      if (end.fate == CertifiedFate::completed) continue;
      EXPECT_EQ(end.fate, CertifiedFate::undecided);
      if (given > 0) {
        EXPECT_EQ(end.x.text(20), last.x.text(20));
      }
    }
  }
}

// A hole that the pseudo-orbit leaves through and the true one misses, or a forecast that is too
// small by chance: then attempts end on their way.
TEST(CertifiedLimits, AnAttemptThatEndsOnItsWay) {
  int ended = 0;
  for (int k = 0; k < 40; ++k) {
    Shaped s = stadium("1");
    s.inside = {exactly("0." + std::to_string(10 + k)), exactly("0.1")};
    const ExactSystem system = flying(s, "1");
    CertifiedOrbit whole(system, task_of(150, 20));
    whole.finish();
    CertifiedTask task = task_of(150, 20);
    task.most_bits = whole.effort().bits - 1;  // of the last attempt
    if (whole.effort().attempts < 2) continue;
    CertifiedOrbit orbit(system, task);
    std::uint64_t given = 0;
    for (const CertifiedHit& hit : orbit) given = hit.number;
    ++ended;
    EXPECT_EQ(orbit.end_state().fate, CertifiedFate::undecided);
    EXPECT_EQ(orbit.end_state().collisions, given);
    expect_digits(orbit.end_state(), 20);
  }
  EXPECT_GT(ended, 0);
}

TEST(CertifiedLimits, SlowFastLargeAndSmallSystemsAreCertified) {
  for (const char* omega : {"0", "1"}) {
    for (const char* speed : {"1/10^30", "1/10^12", "1", "10^12", "10^30"}) {
      for (const char* size : {"1/10^12", "1", "10^30"}) {
        SCOPED_TRACE(std::string("speed ") + speed + ", size " + size + ", field " + omega);
        ExactSystem system = flying(stadium(size), speed);
        if (omega[0] != '0') system.omega = exactly(std::string("(") + speed + ")/(" + size + ")");
        CertifiedOrbit orbit(system, task_of(20, 20));
        std::uint64_t given = 0;
        while (orbit.next() && orbit.effort().attempts < 20) ++given;
        ASSERT_LE(orbit.effort().attempts, 4);
        EXPECT_EQ(given, 20u);
        EXPECT_EQ(orbit.end_state().fate, CertifiedFate::completed);
        expect_digits(orbit.end_state(), 20);
      }
    }
  }
}

// First order suffices for small parts of the table only: how few digits are asked for says nothing
// of that.
TEST(CertifiedLimits, ErrorsStaySmallParts) {
  for (const char* omega : {"0", "10^10"}) {
    ExactSystem system = flying(stadium("1/10^10"), "1");
    system.omega = exactly(omega);
    const CertifiedTask task = task_of(1000, 2);
    const certify::KnownTies ties;
    constexpr long bits = 80;
    certify::Attempt attempt(system, task, ties, bits, 96);
    certify::Outcome outcome = attempt.step();
    for (; outcome.kind == certify::Outcome::hit; outcome = attempt.step())
      ASSERT_LE(attempt.lost_bits() - static_cast<double>(bits), -20.0);
    EXPECT_EQ(outcome.kind, certify::Outcome::inaccurate);
    EXPECT_GT(attempt.hits(), 10u);
  }
}

// Nearly along the edge of the corridor between the discs, a little to its inside or outside:
// intervals do not know whether discs are met, balls do. Along y = 1/4 + 10^-25.
TEST(CertifiedLimits, AFlightBesideTheEdgeOfACorridorIsCertified) {
  Shaped s = tests::shaped("sinai", {{"side", "1"}, {"radius", "1/5"}}, "1/10", "3/10+1/10^25");
  const ExactSystem system = tests::system_of(s, {exactly("1"), exactly("0")});
  CertifiedOrbit meets(system, task_of(1, 20));
  const CertifiedEnd& end = meets.finish();
  EXPECT_EQ(end.fate, CertifiedFate::completed);
  EXPECT_EQ(end.collisions, 1u);
  EXPECT_TRUE(end.ties.empty());
  s.inside.y = exactly("3/10-1/10^25");
  CertifiedOrbit misses(tests::system_of(s, {exactly("1"), exactly("0")}), task_of(1, 20));
  EXPECT_EQ(misses.finish().fate, CertifiedFate::undecided);
  EXPECT_EQ(misses.finish().reason, "no wall within 10^5 lattice vectors");
}

TEST(CertifiedLimits, TooManyOrNoDigitsAreRefused) {
  const ExactSystem system = flying(stadium("1"), "1");
  for (const int digits : {0, -1, -1'000'000, 1'000'001, 1'000'000'000}) {
    try {
      CertifiedOrbit(system, task_of(5, digits));
      ADD_FAILURE() << digits;
    } catch (const InputError& error) {
      EXPECT_EQ(error.expected(), digits < 1 ? "at least 1" : "at most 1000000");
    }
  }
  Table many = *system.table;
  many.walls.resize(10'000, many.walls.front());
  try {
    check_digits(100'000, many);
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_EQ(error.expected(), "at most 60073");
  }
  CertifiedOrbit one(system, task_of(3, 1));
  EXPECT_EQ(one.finish().fate, CertifiedFate::completed);
}

// From inside a bounded table nothing is unbounded.
TEST(CertifiedLimits, StartsOutsideAreRefused) {
  const Shaped s =
      tests::shaped("rectangle", {{"width", "1"}, {"height", "1"}}, "1+1/10^40", "1/2");
  for (const char* speed : {"1", "7/3"}) {
    ExactSystem system = flying(s, speed);
    EXPECT_THROW(CertifiedOrbit(system, task_of(5, 20)), InputError);
  }
}

}  // namespace
}  // namespace carom
