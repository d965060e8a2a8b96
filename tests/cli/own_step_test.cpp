// Steps that the program chose and that keep the energy worse than integrator.energy_tolerance.
#include <gtest/gtest.h>

#include <string>

#include "cli/program.hpp"

namespace carom {
namespace {

/// In 200 units of time the chosen step keeps its energy to some 1e-11.
std::string well(const std::string& integrator) {
  return "cat > well.toml <<'END'\n[[potential]]\nkind = \"expression\"\nexpression = \"(x^2 + "
         "y^2)/2 + x^4/40\"\n[initial]\nkind = \"list\"\nstarts = [[1, 0, 0, 0.5], [0.5, 0.3, 0.3, "
         "0.4]]\n[integrator]\n" +
         integrator + "\n[run]\nt_max = 200\n[section]\non = \"x=0.25\"\nEND\n";
}
const std::string strict = "energy_tolerance = 1e-13";

const char* const commands[] = {"run", "escape", "diffusion", "section"};

TEST(OwnSteps, AreHalvedUntilTheEnergyHolds) {
  const Shell shell;
  shell(well(strict));
  for (const std::string command : commands) {
    const Outcome halved = shell("$carom " + command + " ./well.toml -o a.h5 --force --json");
    EXPECT_EQ(halved.status, 0) << command << halved.err;
    const std::string halvings = json_value(halved.out, "step_halvings");
    EXPECT_GE(std::stoi("0" + halvings), 1) << command;
    EXPECT_EQ(json_value(halved.out, "step_chosen"), "true") << command;
    const Outcome text = shell("$carom " + command + " ./well.toml");
    EXPECT_NE(text.out.find("halved"), std::string::npos) << command << text.out;
    const Outcome usual =
        shell("$carom " + command + " ./well.toml --set integrator.energy_tolerance=1e-3 --json");
    EXPECT_EQ(json_value(usual.out, "step_halvings"), "") << command;
    EXPECT_EQ(std::stod(json_value(usual.out, "step")),
              std::stod(json_value(halved.out, "step")) * (1 << std::stoi(halvings)))
        << command;
    // The same step of the user's gives the same bits.
    const Outcome same =
        shell("$carom " + command + " ./well.toml --json --set integrator.unresolved=halve --set " +
              "integrator.step=" + json_value(halved.out, "step"));
    EXPECT_EQ(same.status, 0) << same.err;
    for (const char* key : {"x", "digest", "points", "msd", "energy_error"})
      EXPECT_EQ(json_value(same.out, key), json_value(halved.out, key)) << command << key;
  }
}

TEST(OwnSteps, OfTheUserAreTakenAsTheyAre) {
  const Shell shell;
  shell(well("step = 0.2\nenergy_tolerance = 1e-13"));
  for (const std::string command : commands) {
    const Outcome o = shell("$carom " + command + " ./well.toml --json");
    EXPECT_EQ(o.status, 3) << command;
    EXPECT_EQ(json_value(o.out, "step"), "0.2") << command;
    EXPECT_EQ(json_value(o.out, "step_halvings"), "") << command;
  }
}

/// No step keeps an energy to less than its rounding.
TEST(OwnSteps, AreHalvedOnlyWhereThatHelps) {
  const Shell shell;
  shell(well("energy_tolerance = 1e-18"));
  const Outcome o = shell("$carom run ./well.toml --json");
  EXPECT_EQ(o.status, 3) << o.err;
  EXPECT_GE(std::stoi("0" + json_value(o.out, "step_halvings")), 1);
  EXPECT_LE(std::stoi(json_value(o.out, "step_halvings")), 6);
}

TEST(OwnSteps, StayHalvedInWhatGoesOn) {
  const Shell shell;
  shell(well(strict));
  shell("$carom run ./well.toml -o whole.h5");
  const Outcome whole = shell("$carom run --resume whole.h5 --json");
  EXPECT_EQ(json_value(whole.out, "step_halvings"), "") << whole.err;
  EXPECT_EQ(whole.status, 0) << whole.err;
  const Outcome escape = shell("$carom escape ./well.toml -o e.h5 --json");
  const Outcome again = shell("$carom escape ./well.toml --resume e.h5 --json");
  EXPECT_EQ(again.status, 0) << again.err;
  for (const char* key : {"step", "digest", "steps"})
    EXPECT_EQ(json_value(again.out, key), json_value(escape.out, key)) << key;
  const Outcome other =
      shell("$carom escape ./well.toml --resume e.h5 --json --set integrator.step=0.2");
  EXPECT_EQ(other.status, 1) << other.out;
}

TEST(OwnSteps, OfASweepAreEachItsOwn) {
  const Shell shell;
  shell(well(strict));
  const Outcome o = shell(
      "$carom escape ./well.toml --sweep run.t_max=list:2,200 -o s.h5 --json && $carom escape "
      "--resume "
      "s.h5 --json");
  EXPECT_EQ(o.status, 0) << o.err;
}

}  // namespace
}  // namespace carom
