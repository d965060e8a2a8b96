// Steps that the program chooses, and what it says of the error of a state.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "carom/analyses/run.hpp"
#include "carom/analyses/run/state_error.hpp"
#include "carom/engines/choose_step.hpp"
#include "carom/files/system_file.hpp"

namespace carom {
namespace {

System well(const std::string& omega, const std::string& integrator) {
  return read_system("[[potential]]\nkind = \"harmonic\"\nomega = " + omega +
                         "\n[initial]\nkind = \"point\"\nposition = [1, 0]\nvelocity = [0, "
                         "0.5]\n[run]\nt_max = 20\n" +
                         integrator,
                     "well")
      .system;
}

TEST(ChosenSteps, ScaleWithThePeriodAndKeepTheEnergy) {
  const double slow = well("1", "").dynamics.integrator.step,
               fast = well("1000", "").dynamics.integrator.step;
  EXPECT_TRUE(well("1", "").dynamics.integrator.step_chosen);
  EXPECT_GT(slow, 0.02);
  EXPECT_LT(slow, 1.0);
  EXPECT_NEAR(slow / fast, 1000.0, 600.0);
  EXPECT_FALSE(well("1", "[integrator]\nstep = 0.1\n").dynamics.integrator.step_chosen);
}

TEST(ChosenSteps, AreWrittenIntoTheResolvedSystem) {
  const LoadedSystem loaded = load_system("henon-heiles", {});
  EXPECT_FALSE(loaded.system.dynamics.integrator.step_chosen);
  std::string text = loaded.resolved_toml;
  const std::size_t from = text.find("step = 0.1\n");
  ASSERT_NE(from, std::string::npos) << text;
  text.erase(from, std::string("step = 0.1\n").size());
  const LoadedSystem chosen = read_system(text, "chosen");
  EXPECT_TRUE(chosen.system.dynamics.integrator.step_chosen);
  const LoadedSystem again = read_system(chosen.resolved_toml, "again");
  EXPECT_TRUE(again.system.dynamics.integrator.step_chosen);
  EXPECT_EQ(again.system.dynamics.integrator.step, chosen.system.dynamics.integrator.step);
}

TEST(ChosenSteps, SeeANarrowBumpThatNoPilotOrbitMeets) {
  const auto step = [](const std::string& width) {
    return read_system(
               "[table]\nshape = \"rectangle\"\nwidth = 2\nheight = 2\n[[potential]]\nkind = "
               "\"gaussian\"\nheight = 0.01\n"
               "width = " +
                   width +
                   "\ncenter = [1.7, 1.7]\n[particles]\nspeed = 1\n[initial]\nkind = \"point\"\n"
                   "position = [0.1, 0.1]\nvelocity = [1, 0]\n[run]\nt_max = 10\n",
               "bump")
        .system.dynamics.integrator.step;
  };
  EXPECT_LT(step("0.003"), 0.02);
  EXPECT_GT(step("0.3"), 0.03);
}

// The force presses the particle against the wall, which it hits 300 million times until t_max.
TEST(ChosenSteps, TrialRunsDoNotFollowWhatRollsAlongAWall) {
  const double step =
      read_system(
          "[table]\nshape = \"circle\"\nradius = 1\n[[potential]]\nkind = \"expression\"\n"
          "expression = \"-50*(x^2+y^2)\"\n[initial]\nkind = \"point\"\nposition = "
          "[\"1 - 1e-13\", 0]\nvelocity = [0, 1]\n[run]\nt_max = 10\n",
          "rolling")
          .system.dynamics.integrator.step;
  EXPECT_GT(step, 0.0);
  EXPECT_LT(step, 0.1);
}

TEST(ChosenSteps, AForceWithoutABoundIsRefused) {
  try {
    read_system(
        "[[potential]]\nkind = \"expression\"\nexpression = \"log(x^2+y^2)\"\n[initial]\nkind = "
        "\"point\"\n"
        "position = [0.5, 0]\nvelocity = [-1, 0]\n[run]\nt_max = 1\n",
        "pole");
    FAIL();
  } catch (const InputError& e) {
    EXPECT_EQ(e.place().key, "integrator.step");
  }
}

TEST(StateErrors, AreThoseOfTheClosedForm) {
  for (const char* integrator : {"[integrator]\nscheme = \"velocity-verlet\"\nstep = 0.05\n",
                                 "[integrator]\nscheme = \"forest-ruth-4\"\nstep = 0.1\n",
                                 "[integrator]\nscheme = \"arkode\"\ntolerance = 1e-6\n"}) {
    const System system = well("1", integrator);
    Observer observer;
    SingleRunOptions options;
    options.estimate_state_error = true;
    const SingleRunResult result = run_single(system, observer, options);
    ASSERT_TRUE(result.state_error);
    EXPECT_EQ(result.state_error->until, 20.0);
    const RunEnd& end = result.particles[0];
    const double error = std::hypot(end.x - std::cos(20.0), end.y - 0.5 * std::sin(20.0));
    EXPECT_GT(result.state_error->position / error, 1.4) << integrator;  // order 2 leaves a quarter
    EXPECT_LT(result.state_error->position / error, 6.0) << integrator;
  }
}

// Towards the top of a hill, where rounding has grown by e^20 at the end, and is all the error
// there is.
TEST(StateErrors, HoldWhatRoundingHasGrownTo) {
  for (int k = 1; k <= 20; ++k) {
    const double x = k / 32.0;
    const std::string at = std::to_string(x);
    const System system = read_system(
                              "[[potential]]\nkind = \"expression\"\nexpression = "
                              "\"-x^2/2\"\n[initial]\nkind = \"point\"\nposition = [" +
                                  at + ", 0]\nvelocity = [-" + at + ", 0]\n[integrator]\nstep = " +
                                  std::to_string(0.01 + 0.001 * k) + "\n[run]\nt_max = 20\n",
                              "hill")
                              .system;
    Observer observer;
    SingleRunOptions options;
    options.estimate_state_error = true;
    const SingleRunResult result = run_single(system, observer, options);
    ASSERT_TRUE(result.state_error);
    const double error = std::fabs(result.particles[0].x - x * std::exp(-20.0));
    EXPECT_GT(result.state_error->position, error) << k;
    EXPECT_LT(result.state_error->position, 1e-4) << k;
  }
}

TEST(StateErrors, ErrorsEndWhereChaosSeparatesTheRuns) {
  const System system = load_system("soft-lorentz", {}).system;
  const auto error = state_error(system, 0, 500.0);
  ASSERT_TRUE(error);
  EXPECT_LT(error->until, 200.0);
  EXPECT_GT(error->position, 0.01);
  EXPECT_FALSE(state_error(load_system("stadium", {}).system, 0, 10.0));
}

TEST(StateErrors, SayWhyThereIsNone) {
  System system = well("1", "[integrator]\nstep = 0.05\n");
  Observer observer;
  SingleRunOptions options;
  options.estimate_state_error = true;
  const SingleRunResult whole = run_single(system, observer, options);
  EXPECT_EQ(whole.no_state_error, "");
  system.run.t_max = 4.0;
  options.resume = {run_single(system, observer, options).particles[0].progress};
  system.run.t_max = 20.0;
  const SingleRunResult parts = run_single(system, observer, options);
  ASSERT_TRUE(parts.state_error);
  EXPECT_EQ(parts.state_error->position, whole.state_error->position);
  options.interrupted = [] { return true; };  // at once: while the start is drawn again
  EXPECT_NE(run_single(system, observer, options).no_state_error.find("interrupted"),
            std::string::npos);
  options.estimate_state_error = false;
  EXPECT_EQ(run_single(system, observer, options).no_state_error, "");
}

}  // namespace
}  // namespace carom
