// Steps that are halved where they fail: the same orbits in every engine, run and resumed, and the
// energies that they should have.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string>

#include "carom/analyses/escape.hpp"
#include "carom/analyses/lyapunov.hpp"
#include "carom/analyses/lyapunov/growth.hpp"
#include "carom/analyses/run.hpp"
#include "carom/files/system_file.hpp"

namespace carom {
namespace {

/// The start is in a bump that asks for short steps. So trial runs end before the second one, a
/// twentieth as wide, is met at t = 4.
std::string two_bumps(const std::string& integrator) {
  return "[[potential]]\nkind = \"expression\"\nexpression = \"0.1*exp(-(x^2+y^2)/(2*0.02^2)) + "
         "0.1*exp(-((x-4)^2+y^2)/(2*0.001^2))\"\n[initial]\nkind = \"point\"\n"
         "position = [0.01, 0]\nvelocity = [1, 0]\n" +
         integrator + "[run]\nt_max = 6\n";
}

SingleRunResult run_of(const System& system, bool state_error = false) {
  Observer observer;
  SingleRunOptions options;
  options.estimate_state_error = state_error;
  return run_single(system, observer, options);
}

TEST(HalvedSteps, AChosenStepThatFailsIsTakenInParts) {
  const System system = read_system(two_bumps(""), "bumps").system;
  ASSERT_TRUE(system.dynamics.integrator.step_chosen);
  const SingleRunResult run = run_of(system, true);
  const RunEnd& end = run.particles[0];
  EXPECT_EQ(end.progress.fate, Fate::survived) << end.report;
  EXPECT_GT(run.steps.halved, 0u);
  EXPECT_LT(run.steps.shortest_part, system.dynamics.integrator.step);
  EXPECT_GT(run.steps.shortest_part, 1e-5);
  const double speed = std::sqrt(1.0 + 0.2 * std::exp(-0.125));
  ASSERT_TRUE(run.state_error);
  EXPECT_NEAR(end.vx, speed, 1e-6);
  EXPECT_LE(std::fabs(end.vx - speed), run.state_error->velocity);
  EXPECT_LT(end.energy_error.largest, 1e-3);
}

TEST(HalvedSteps, AStepOfTheUsersStopsThere) {
  const System system = read_system(two_bumps("[integrator]\nstep = 0.01\n"), "bumps").system;
  EXPECT_EQ(run_of(system).particles[0].progress.fate, Fate::unresolved);
  const System chosen =
      read_system(two_bumps("[integrator]\nunresolved = \"stop\"\n"), "bumps").system;
  EXPECT_EQ(run_of(chosen).particles[0].progress.fate, Fate::unresolved);
}

/// The archive's system repeats the run.
TEST(HalvedSteps, AreWrittenIntoTheResolvedSystem) {
  const LoadedSystem loaded = read_system(two_bumps(""), "bumps");
  const LoadedSystem again = read_system(loaded.resolved_toml, "again");
  EXPECT_TRUE(again.system.dynamics.integrator.halve_unresolved);
  EXPECT_EQ(again.system.dynamics.integrator.step, loaded.system.dynamics.integrator.step);
  EXPECT_EQ(run_of(again.system).particles[0].vx, run_of(loaded.system).particles[0].vx);
}

TEST(HalvedSteps, GoOnAsIfUndisturbed) {
  System system = read_system(two_bumps(""), "bumps").system;
  const SingleRunResult whole = run_of(system);
  Observer observer;
  SingleRunOptions options;
  // Within the narrow bump, between the ends of two parts.
  system.run.t_max = 3.9500123;
  const SingleRunResult first = run_single(system, observer, options);
  options.resume = {first.particles[0].progress};
  options.steps = first.steps;
  system.run.t_max = 6.0;
  const SingleRunResult second = run_single(system, observer, options);
  EXPECT_EQ(second.particles[0].x, whole.particles[0].x);
  EXPECT_EQ(second.particles[0].vx, whole.particles[0].vx);
  EXPECT_EQ(second.steps.steps, whole.steps.steps);
  EXPECT_EQ(second.steps.halved, whole.steps.halved);
  EXPECT_EQ(second.steps.shortest_part, whole.steps.shortest_part);
}

/// No part of a step resolves a pole.
TEST(HalvedSteps, APoleEndsTheOrbit) {
  const System system = read_system(
                            "[[potential]]\nkind = \"expression\"\nexpression = "
                            "\"log(x^2+y^2)\"\n[initial]\nkind = \"point\"\nposition = [0.5, 0]\n"
                            "velocity = [-1, 0]\n[integrator]\nstep = 0.01\nunresolved = "
                            "\"halve\"\n[run]\nt_max = 1\n",
                            "pole")
                            .system;
  const SingleRunResult run = run_of(system);
  EXPECT_EQ(run.particles[0].progress.fate, Fate::unresolved);
  EXPECT_FALSE(run.particles[0].report.empty());
}

System narrow_bumps() {
  return read_system(R"toml(
[table]
shape = "rectangle"
width = 2
height = 2
[[table.hole]]
wall = "right"
center = 1
width = 0.2
[[potential]]
kind = "expression"
expression = "0.3*exp(-((x-1.3)^2+(y-1.1)^2)/(2*0.02^2)) - 0.2*exp(-((x-0.6)^2/(2*0.01^2)+(y-0.7)^2/(2*0.1^2)))"
[field]
B = 0.3
[integrator]
step = 0.1
unresolved = "halve"
[particles]
speed = 1
[initial]
kind = "rectangle"
min = [0.1, 0.1]
max = [1.9, 1.9]
[run]
t_max = 10
trajectories = 40
)toml",
                     "narrow")
      .system;
}

TEST(HalvedSteps, AreTheSameInLanes) {
  const System system = narrow_bumps();
  EscapeOptions how;
  how.threads = 1;
  how.lanes = std::nullopt;
  const EscapeResult scalar = run_escape(system, how);
  EXPECT_FALSE(scalar.lanes);
  EXPECT_EQ(scalar.counts.unresolved, 0u);
  EXPECT_GT(scalar.steps.halved, 0u);
  EXPECT_LT(scalar.energy_error.largest, 1e-3);
  for (const InstructionSet set : available_instruction_sets()) {
    how.lanes = set;
    how.threads = 2;
    how.block = 7;
    const EscapeResult lanes = run_escape(system, how);
    ASSERT_TRUE(lanes.lanes);
    EXPECT_EQ(lanes.digest, scalar.digest);
    EXPECT_EQ(lanes.counts.collisions, scalar.counts.collisions);
    EXPECT_EQ(lanes.steps.steps, scalar.steps.steps);
    EXPECT_EQ(lanes.steps.halved, scalar.steps.halved);
    EXPECT_EQ(lanes.steps.shortest_part, scalar.steps.shortest_part);
    EXPECT_EQ(lanes.steps.force_evaluations, scalar.steps.force_evaluations);
  }
}

/// Deviations take the same parts as their orbits, which are short enough here to be the same.
TEST(HalvedSteps, DeviationsTakeThem) {
  System system = narrow_bumps();
  system.run.trajectories = 20;
  system.run.t_max = 8.0;
  LyapunovOptions how;
  how.threads = 1;
  const LyapunovResult halved = run_lyapunov(system, how);
  EXPECT_EQ(halved.unresolved, 0u);
  EXPECT_GT(halved.steps.halved, 0u);
  system.dynamics.integrator.step = 0.0025;
  const LyapunovResult fine = run_lyapunov(system, how);
  const double a = mean_growth_of(halved.growth).per_time.value,
               b = mean_growth_of(fine.growth).per_time.value;
  EXPECT_GT(b, 0.05);
  EXPECT_NEAR(a, b, 0.05 * b);
}

}  // namespace
}  // namespace carom
