// The checks of carom validate: they pass where they should, and can fail.
#include "validation/cases/checks.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <string>

#include "carom/files/system_file.hpp"

namespace carom::validation {
namespace {

System system_of(const std::string& toml) { return read_system(toml, "test").system; }

System closed_circle(const char* initial, const char* run) {
  return system_of(std::string("[table]\nshape = \"circle\"\nradius = 1\n[initial]\nkind = \"") +
                   initial + "\"\n[run]\nt_max = 1e12\n" + run);
}

TEST(Validation, ADiscHasItsMeanFlight) {
  const System system = closed_circle("boundary", "collisions = 100\ntrajectories = 2000\n");
  const Check c = check_mean_flight(system, 0.0);
  EXPECT_TRUE(c.passed);
  EXPECT_NEAR(c.expected, 1.5707963267948966, 1e-15);
  EXPECT_EQ(c.hits, 200000u);
  EXPECT_LT(c.error, 0.02);
  // A wrong area of centres is noticed.
  EXPECT_FALSE(check_mean_flight(system, 0.5).passed);
}

TEST(Validation, IsTheSameOnAnyNumberOfThreads) {
  const System system = closed_circle("boundary", "collisions = 20\ntrajectories = 500\n");
  const Check one = check_mean_flight(system, 0.0, {1, nullptr});
  const Check three = check_mean_flight(system, 0.0, {3, nullptr});
  EXPECT_EQ(one.value, three.value);
  EXPECT_EQ(one.error, three.error);
  EXPECT_EQ(three.threads, 3);
}

TEST(Validation, NothingIsLostInADisc) {
  const Check c =
      check_nothing_lost(closed_circle("uniform", "collisions = 1000\ntrajectories = 100\n"));
  EXPECT_TRUE(c.passed);
  EXPECT_EQ(c.hits, 100000u);
  EXPECT_EQ(c.lost, 0u);
  EXPECT_NE(c.digest, 0u);
}

TEST(Validation, TwoDiscsLoseByTheirMultiplier) {
  const System system = system_of(R"(
[table]
shape = "discs"
centers = [[0, 0], [6, 0]]
radius = 1
[initial]
kind = "line"
from = [3, -0.1]
to = [3, 0.1]
angle = 0
[run]
t_max = 1e12
collisions = 4
trajectories = 200000
)");
  const double multiplier = 5.0 + std::sqrt(24.0);
  const Check share = check_survival_per_hit(system, 1.0 / multiplier);
  EXPECT_TRUE(share.passed) << share.value;
  EXPECT_LT(share.error, 0.003);
  const Check rate = check_escape_rate(system, std::log(multiplier) / 4.0);
  EXPECT_TRUE(rate.passed) << rate.value;
  EXPECT_LT(rate.error, 0.01);
  EXPECT_FALSE(check_survival_per_hit(system, 1.2 / multiplier).passed);
  EXPECT_FALSE(check_escape_rate(system, std::log(multiplier) / 3.7).passed);
}

TEST(Validation, SurvivorsPassWithinTheirAllowance) {
  // No particle leaves a closed disc.
  const System system = closed_circle("uniform", "collisions = 10\ntrajectories = 1000\n");
  EXPECT_TRUE(check_survivors(system, 2.0, {2.0}, {}).passed);
  EXPECT_FALSE(check_survivors(system, 2.0, {1.8}, {}).passed);
  EXPECT_TRUE(check_survivors(system, 2.0, {1.8}, {0.0, 0.2}).passed);
  EXPECT_FALSE(check_survivors(system, 2.0, {1.8}, {0.2, 0.0}).passed);
}

TEST(Validation, BothErrorsCount) {
  const System system = closed_circle("uniform", "collisions = 10\ntrajectories = 1000\n");
  // All of a thousand survive: the own error is about 1e-3, and 0.1 is far away unless the
  // reference is as uncertain.
  EXPECT_FALSE(check_survivors(system, 1.0, {0.9, 0.001}, {}).passed);
  const Check c = check_survivors(system, 1.0, {0.9, 0.05}, {});
  EXPECT_TRUE(c.passed);
  EXPECT_EQ(c.expected_error, 0.05);
  EXPECT_NEAR(c.distance, 2.0, 1e-3);
}

TEST(Validation, FreeFlightHasItsDisplacement) {
  // Speed 2 in a lattice whose only disc is out of reach: |r(t) - r(0)| = 2 t for all.
  const System system = system_of(R"(
[table]
shape = "lorentz"
lattice = "square"
spacing = 10
radius = 0.1
[particles]
speed = 2
[initial]
kind = "rectangle"
min = [4.9, 4.9]
max = [5, 5]
[run]
t_max = 1.5
times = [0.5, 1.5]
trajectories = 300
)");
  const Check c = check_displacement(system, {9.0});
  EXPECT_TRUE(c.passed) << c.value;
  EXPECT_NEAR(c.value, 9.0, 1e-12);
  EXPECT_EQ(c.lost, 0u);
  EXPECT_FALSE(check_displacement(system, {9.01}).passed);
  EXPECT_TRUE(check_displacement(system, {9.01, 0.005}).passed);
}

TEST(Validation, OneOrbitEndsAtItsDistance) {
  const System system = system_of(R"(
[table]
shape = "rectangle"
width = 4
height = 4
[particles]
speed = 1
[initial]
kind = "point"
position = [3, 1]
velocity = [0, 1]
[run]
t_max = 3
)");
  // One reflection at most: at (3, 4), whose distance is 5.
  const Check c = check_distance(system, 5.0, {});
  EXPECT_TRUE(c.passed) << c.value;
  EXPECT_FALSE(check_distance(system, 5.1, {0.0, 1.0}).passed);
  EXPECT_TRUE(check_distance(system, 5.1, {0.2, 0.0}).passed);
}

TEST(Validation, AnInterruptedCheckHasNeitherPassedNorFailed) {
  const std::atomic<bool> interrupted{true};
  const Check c = check_mean_flight(
      closed_circle("boundary", "collisions = 100\ntrajectories = 2000\n"), 0.0, {2, &interrupted});
  EXPECT_FALSE(c.complete);
  EXPECT_FALSE(c.passed);
}

}  // namespace
}  // namespace carom::validation
