// What goes wrong where forces act: a clear message or fate, never a silent NaN.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "carom/integrators/scheme.hpp"
#include "program.hpp"

namespace carom {
namespace {

bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

const char* const pair = R"(cat > pair.toml << 'END'
[interaction]
kind = "coulomb"
[particles]
count = 2
speed = 1
[integrator]
step = 0.01
[initial]
kind = "point"
position = [0.25, 0]
angle = 0
[run]
t_max = 1
END
)";

TEST(ForceFaults, ParticlesPlacedOnEachOtherAreRefused) {
  const Shell shell;
  shell(pair);
  for (const char* interaction : {"", "kind=yukawa --set interaction.range=1",
                                  "kind=lennard-jones --set interaction.diameter=1",
                                  "kind=soft-sphere --set interaction.diameter=1",
                                  "kind=expression --set 'interaction.expression=\"1/r\"'"}) {
    const std::string set = *interaction ? std::string(" --set interaction.") + interaction : "";
    for (const char* command : {"run", "escape --trajectories 3"})
      expect_refused(shell(std::string("$carom ") + command + " ./pair.toml" + set),
                     "./pair.toml, line 10, ");
  }
}

TEST(ForceFaults, AttractionWithoutBoundIsRefused) {
  const Shell shell;
  shell(std::string(pair) +
        "sed -i '1,2d; s/count = 2/count = 1/' pair.toml; printf '[[potential]]\\nkind = "
        "\"coulomb\"\\ncharge = 1\\n' >> pair.toml");
  EXPECT_EQ(shell("$carom run ./pair.toml").status, 0);
  for (const char* set : {"'potential[0].charge=-1'", "particles.charge=-1"})
    expect_refused(shell(std::string("$carom run ./pair.toml --set ") + set),
                   "./pair.toml, line 12, column 1: potential[0]: ");
  shell(pair);
  for (const char* set : {"interaction.strength=-1", "'particles.charge=[1,-2]'"})
    expect_refused(shell(std::string("$carom run ./pair.toml --set ") + set),
                   "./pair.toml, line 1, column 1: interaction: ");
}

TEST(ForceFaults, StepsThatAreNotPositiveAreRefused) {
  const Shell shell;
  for (const char* step : {"0", "-0.1", "nan", "inf", "1e-400"})
    expect_refused(shell(std::string("$carom run henon-heiles --set integrator.step=") + step),
                   "command line: integrator.step: ");
}

TEST(ForceFaults, UnknownSchemeListsTheKnownOnes) {
  const Shell shell;
  const std::string set = "$carom run henon-heiles --set integrator.scheme=";
  const Outcome near = shell(set + "velocity-verlett");
  expect_refused(near, "command line: integrator.scheme: ");
  EXPECT_TRUE(holds(near.err, "did you mean 'velocity-verlet'?")) << near.err;
  const Outcome o = shell(set + "unheard-of");
  expect_refused(o, "command line: integrator.scheme: ");
  for (const Scheme& scheme : schemes())
    EXPECT_TRUE(holds(o.err, std::string(scheme.name))) << scheme.name;
  for (const char* adaptive : {"arkode", "cvode"}) EXPECT_TRUE(holds(o.err, adaptive)) << o.err;
}

/// A particle in a box that flies towards x = 1.
void write_box(const Shell& shell, const std::string& expression) {
  shell(
      "cat > box.toml << 'END'\n[table]\nshape = \"rectangle\"\nwidth = 2\nheight = "
      "1\n[[potential]]\n"
      "kind = \"expression\"\nexpression = \"" +
      expression +
      "\"\n[particles]\nspeed = 1\n[integrator]\nstep = 0.01\n[initial]\nkind = \"point\"\n"
      "position = [0.5, 0.5]\nangle = 0.3\n[run]\nt_max = 20\nEND\n");
}

// A soft bump among walls, and a scheme that keeps its energy badly.
const char* const rough = R"(cat > rough.toml << 'END'
[table]
shape = "rectangle"
width = 1
height = 1
[[potential]]
kind = "gaussian"
height = 2
width = 0.2
centers = [[0.5, 0.5]]
[integrator]
scheme = "velocity-verlet"
step = 0.005
energy_tolerance = 1e-6
[run]
t_max = 5
trajectories = 200
END
)";

TEST(ForceFaults, EnergyThatStepsLoseIsReported) {
  const Shell shell;
  shell(rough);
  const std::string run = "$carom run ./rough.toml --trajectory ";
  for (const std::string more : {"", " --set integrator.energy_tolerance=1"}) {
    const Outcome o = shell(run + "0 --json" + more), text = shell(run + "0" + more);
    const bool wrong = more.empty();
    EXPECT_EQ(o.status, wrong ? 3 : 0) << o.out << o.err;
    EXPECT_EQ(json_value(o.out, "energy_error").find("{\"end\": "), 0u) << o.out;
    EXPECT_EQ(json_value(o.out, "note") != "", wrong) << o.out;
    EXPECT_EQ(text.status, o.status);
  }
  EXPECT_EQ(json_value(shell("$carom run soft-lorentz --t-max 20 --json").out, "note"), "");
  // Of an ensemble, the largest: the same in lanes and by one, in parts, and after a pause.
  const std::string escape = "$carom escape ./rough.toml --json ";
  const Outcome one = shell(escape), scalar = shell(escape + "--isa baseline");
  shell(
      "$carom escape ./rough.toml --shard 1/2 -o a.h5; $carom escape ./rough.toml --shard 2/2 -o "
      "b.h5");
  const Outcome sum = shell("$carom merge all.h5 a.h5 b.h5 --json"),
                again = shell("$carom escape --resume all.h5 --json");
  for (const char* key : {"energy_change", "energy_error", "steps", "force_evaluations"}) {
    const std::string value = json_value(one.out, key);
    EXPECT_NE(value, "");
    EXPECT_EQ(json_value(scalar.out, key), value) << key;
    EXPECT_EQ(json_value(sum.out, key), value) << key;
    EXPECT_EQ(json_value(again.out, key), value) << key;
  }
  EXPECT_GT(std::stod(json_value(one.out, "energy_change")), 1e-7);
  for (const Outcome* o : {&one, &sum, &again}) EXPECT_EQ(o->status, 3);
  EXPECT_EQ(
      json_value(shell("$carom escape stadium --trajectories 10 --json").out, "energy_change"), "");
}

TEST(ForceFaults, AStepThatFailsIsNoInternalError) {
  const Shell shell;
  for (const char* command :
       {"escape --t-max 100 --trajectories 20", "diffusion --t-max 100 --trajectories 20",
        "section --on x=0 --t-max 100 --orbits 4"}) {
    const Outcome o = shell(std::string("$carom ") + command +
                            " henon-heiles --set particles.energy=2 --set integrator.step=0.01");
    EXPECT_EQ(o.status, 3) << command << o.out << o.err;
    EXPECT_TRUE(holds(o.out, "unresolved")) << o.out;
    EXPECT_FALSE(holds(o.out, "internal error")) << o.out;
  }
}

// Poles and ends of a formula's domain that orbits come to: the right answer, or the particle is
// unresolved and the reason said; never a number that is none, never a run without end.
TEST(ForceFaults, PolesEndARunWithAReason) {
  const Shell shell;
  for (const char* expression :
       {"0.1/(x - 1)", "-0.1/abs(x - 1)", "-1/((x - 1)^2 + (y - 0.6)^2)", "0.1*sqrt(1 - x)",
        "0.1*log(1 - x)", "0.1/(1 - x)^3", "0.1*(1 - x)^1.5", "-1000000*(x - 1)^6", "-exp(20*x)"}) {
    write_box(shell, expression);
    for (const char* scheme : {"blanes-moan-srkn11b", "velocity-verlet", "arkode", "cvode"}) {
      if (*expression == '-' && expression[1] != '0' && holds(scheme, "ode"))
        continue;  // right, and long
      const Outcome o =
          shell(std::string("timeout -s KILL 300 $carom run ./box.toml --set integrator.scheme=") +
                scheme);
      EXPECT_FALSE(holds(o.out, "nan")) << expression << " " << scheme << o.out;
      if (o.status == 0) continue;
      EXPECT_EQ(o.status, 3) << expression << " " << scheme << o.err;
      EXPECT_NE(o.err, "") << expression << " " << scheme;
    }
  }
}

// An adaptive scheme that shrinks its steps towards a singular point stops, and says at which
// limit.
TEST(ForceFaults, AdaptiveStepsStopAtASingularPoint) {
  const Shell shell;
  for (const char* expression : {"0.1/(x - 1)", "0.1*sqrt(1 - x)", "0.1*log(1 - x)"}) {
    write_box(shell, expression);
    const Outcome o =
        shell("timeout -s KILL 300 $carom run ./box.toml --set integrator.scheme=cvode");
    EXPECT_EQ(o.status, 3) << expression;
    EXPECT_NE(o.err, "") << expression;
  }
}

// Steps so long that walls could not be found on their way.
TEST(ForceFaults, StepsLongerThanTheTableEndTheRun) {
  const Shell shell;
  write_box(shell, "0.001*x");
  const Outcome o = shell("$carom run ./box.toml --set integrator.step=5000 --t-max 20000");
  EXPECT_EQ(o.status, 3);
  EXPECT_NE(o.err, "");
}

}  // namespace
}  // namespace carom
