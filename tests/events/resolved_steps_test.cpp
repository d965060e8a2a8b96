// No force is skipped: a step that leads over one ends the trajectory as unresolved, and says
// where.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "carom/events/world.hpp"
#include "carom/files/system_file.hpp"
#include "carom/integrators/scheme.hpp"
#include "carom/starts/sampler.hpp"

namespace carom {
namespace {

struct Outcome {
  Fate fate = Fate::survived;
  State state;
  std::string report;
  StepCounts counts;
};

Outcome end_of(const std::string& text, double t_end) {
  const System system = read_system(text, "resolved steps").system;
  World world(*system.table, system.dynamics);
  add_starts(world, Sampler(system), 0);
  Observer observer;
  world.run_until(t_end, observer);
  return {world.fate(0), world.finished(0) ? world.state(0) : world.state_at(0, t_end),
          world.report(0), world.step_counts()};
}

std::string in_a_box(const std::string& bump, const std::string& start,
                     const std::string& integrator) {
  return "[table]\nshape = \"rectangle\"\nwidth = 2\nheight = 2\n[[potential]]\n" + bump +
         "\n[particles]\nspeed = 1\n[initial]\nkind = \"point\"\n" + start + "\n[integrator]\n" +
         integrator + "\n[run]\nt_max = 100\n";
}
const std::string typed =
    "kind = \"expression\"\nexpression = \"H*exp(-((x-1)^2+(y-1)^2)/(2*w^2))\"\nparameters = ";
const std::string head_on = "position = [0.3, 1]\nvelocity = [1, 0]";

TEST(ResolvedSteps, EverySchemeStopsBeforeABumpThatItsStepLeadsOver) {
  for (const Scheme& scheme : schemes())
    for (const char* parameters :
         {"{H = 1000, w = 0.022}", "{H = 0.05, w = 0.005}", "{H = 1e-6, w = 0.002}"})
      for (const char* step : {"0.5", "0.1"}) {
        const Outcome o =
            end_of(in_a_box(typed + parameters, head_on,
                            "scheme = \"" + std::string(scheme.name) + "\"\nstep = " + step),
                   2.0);
        EXPECT_EQ(o.fate, Fate::unresolved) << scheme.name << parameters << step;
        EXPECT_NE(o.report, "");
      }
}

TEST(ResolvedSteps, ShortStepsReflectHeadOn) {
  for (const char* scheme : {"velocity-verlet", "blanes-moan-srkn11b", "spreiter-walter", "he-4"}) {
    const Outcome o = end_of(in_a_box(typed + "{H = 1000, w = 0.022}", head_on,
                                      "scheme = \"" + std::string(scheme) + "\"\nstep = 0.0005"),
                             1.0);
    EXPECT_EQ(o.fate, Fate::survived) << scheme << o.report;
    EXPECT_NEAR(o.state.velocity.x, -1.0, 1e-2) << scheme;
    EXPECT_LT(o.state.position.x, 1.0) << scheme;
  }
}

TEST(ResolvedSteps, NamedBumpsAndRidgesAreSeenAsTypedOnesAre) {
  const char* bumps[] = {
      "kind = \"gaussian\"\nheight = 100\nwidth = 0.01\ncenter = [1, 1]",
      "kind = \"fermi\"\nheight = 100\nradius = 0.05\nsoftness = 0.001\ncenter = [1, 1]",
      "kind = \"expression\"\nexpression = \"100*exp(-((x-1)/0.01)^2)\"",
      "kind = \"expression\"\nexpression = \"100/(1+exp((sqrt((x-1)^2+(y-1)^2)-0.05)/0.001))\"",
      "kind = \"coulomb\"\ncharge = 0.001\ncenter = [1, 1]"};
  for (const char* bump : bumps)
    EXPECT_EQ(end_of(in_a_box(bump, head_on, "step = 0.25"), 2.0).fate, Fate::unresolved) << bump;
}

TEST(ResolvedSteps, APassByABumpIsNoMeeting) {
  const Outcome o = end_of(in_a_box(typed + "{H = 1000, w = 0.01}",
                                    "position = [0.3, 0.3]\nvelocity = [1, 0]", "step = 0.1"),
                           2.0);
  EXPECT_EQ(o.fate, Fate::survived) << o.report;
}

TEST(ResolvedSteps, ASingularForceIsNamedWithItsPlace) {
  const std::string pole = "kind = \"expression\"\nexpression = \"0.001*log((x-1)^2+(y-1)^2)\"";
  const Outcome o =
      end_of(in_a_box(pole, "position = [0.3, 1]\nvelocity = [1, 0]", "step = 0.01"), 2.0);
  EXPECT_EQ(o.fate, Fate::unresolved);
  EXPECT_NEAR(o.state.position.x, 1.0, 0.05);
}

TEST(ResolvedSteps, AdaptiveSchemesEndWhereNoStepWillDo) {
  for (const char* scheme : {"cvode", "arkode"}) {
    const Outcome o = end_of(in_a_box("kind = \"expression\"\nexpression = \"sin(1e29*x)\"",
                                      head_on, "scheme = \"" + std::string(scheme) + "\""),
                             2.0);
    EXPECT_EQ(o.fate, Fate::unresolved) << scheme;
  }
}

// The search for a step that resolves a force is long where the force is a long formula.
TEST(ResolvedSteps, TheSearchForOneListens) {
  const System system =
      read_system(in_a_box("kind = \"expression\"\nexpression = \"1e-40*sin(1e29*x)\"", head_on,
                           "step = 0.1"),
                  "resolved steps")
          .system;
  World world(*system.table, system.dynamics);
  add_starts(world, Sampler(system), 0);
  Observer observer;
  int asked = 0;
  world.run_until(1.05, observer, [&] { return ++asked < 0; });
  EXPECT_EQ(world.fate(0), Fate::unresolved);
  EXPECT_GT(asked, 4);  // within the first step
}

TEST(ResolvedSteps, AreCountedWhereThatIsAskedFor) {
  const std::string integrator = "scheme = \"velocity-verlet\"\nstep = 0.5\nunresolved = \"count\"";
  const Outcome o = end_of(in_a_box(typed + "{H = 1000, w = 0.022}", head_on, integrator), 10.0);
  EXPECT_EQ(o.fate, Fate::survived) << o.report;
  EXPECT_GT(o.counts.unresolved, 0u);
  EXPECT_LT(o.counts.unresolved, o.counts.steps);
  EXPECT_EQ(o.counts.first_unresolved,
            0.0);  // the first step begins 0.7 before the bump and ends 0.2 before it
}

TEST(ResolvedSteps, KinksAreAllowedToStepsThatAreShortForTheirJump) {
  const std::string wedge = "kind = \"expression\"\nexpression = \"abs(x-1)\"";
  EXPECT_EQ(end_of(in_a_box(wedge, head_on, "step = 0.01"), 10.0).fate, Fate::survived);
  EXPECT_EQ(end_of(in_a_box(wedge, head_on, "step = 0.5"), 10.0).fate, Fate::unresolved);
}

TEST(ResolvedSteps, PairsThatMeetFasterThanTheStepEndThere) {
  const std::string pair =
      "[interaction]\nkind = \"coulomb\"\nstrength = 0.01\n[particles]\ncount = 2\nspeed = "
      "1\n[initial]\nkind = \"list\"\n"
      "starts = [[-1, 0, 1, 0], [1, 0, -1, 0]]\n[run]\nt_max = 10\n[integrator]\nstep = ";
  EXPECT_EQ(end_of(pair + "0.1\n", 3.0).fate, Fate::unresolved);
  const Outcome o = end_of(pair + "0.0005\n", 3.0);
  EXPECT_EQ(o.fate, Fate::survived) << o.report;
  EXPECT_NEAR(o.state.velocity.x, -1.0, 1e-2);
}

}  // namespace
}  // namespace carom
