// How far a single run is trusted: across continuations, at its end, where there is no estimate.
#include <gtest/gtest.h>

#include "analyses/systems.hpp"
#include "carom/analyses/run.hpp"

namespace carom {
namespace {

const char* stadium = "[table]\nshape = \"stadium\"\nhalf_length = 1\nradius = 1\n";
const char* circle = "[table]\nshape = \"circle\"\nradius = 1\n[field]\nB = 0.3\n";

TEST(RunTrust, EndsAfterSomeFortyCollisionsInAStadium) {
  System system = make_system(stadium);
  system.run.t_max = 1000.0;
  Observer silent;
  for (std::uint64_t i = 0; i < 20; ++i) {
    SingleRunOptions options;
    options.trajectory = i;
    const SingleRunResult run = run_single(system, silent, options);
    const Trust& trust = run.particles[0].trust;
    EXPECT_TRUE(trust.known);
    EXPECT_FALSE(trust.open);
    EXPECT_GT(trust.hits, 10u);
    EXPECT_LT(trust.hits, 2000u);  // long ones bounce between the straight walls
    EXPECT_GT(trust.time.value(), 0.0);
    System demanding = system;
    demanding.run.trust_tolerance = 1e-9;
    const SingleRunResult strict = run_single(demanding, silent, options);
    EXPECT_LT(strict.particles[0].trust.hits, trust.hits);
  }
}

TEST(RunTrust, CoversAWholeRunWhereErrorsGrowSlowly) {
  System system = make_system(circle);
  system.run.t_max = 1000.0;
  Observer silent;
  const SingleRunResult run = run_single(system, silent);
  EXPECT_TRUE(run.particles[0].trust.open);
  EXPECT_EQ(run.particles[0].trust.hits, run.collisions);
  EXPECT_EQ(run.particles[0].trust.time, Time(1000.0));
}

TEST(RunTrust, IsThatOfTheUninterruptedRun) {
  for (const char* text : {stadium, circle, magnetic_square}) {
    System system = make_system(text);
    SingleRunOptions options;
    options.trajectory = 2;
    Observer silent;
    system.run.t_max = 150.0;
    const Trust whole = run_single(system, silent, options).particles[0].trust;
    for (const double stop : {0.0, 3.0, 11.5, 20.0, 150.0}) {
      system.run.t_max = stop;
      const SingleRunResult part = run_single(system, silent, options);
      options.resume = {part.particles[0].progress};
      if (stop < 150.0) continue;
      const Trust& parts = part.particles[0].trust;
      EXPECT_EQ(parts.hits, whole.hits);
      EXPECT_EQ(parts.time, whole.time);
      EXPECT_EQ(parts.open, whole.open);
      EXPECT_EQ(parts.error.velocity, whole.error.velocity);
    }
  }
}

TEST(RunTrust, IsUnknownWhereMotionIsIntegrated) {
  Observer silent;
  System system =
      make_system(std::string(circle) +
                  "[[potential]]\nkind = \"gaussian\"\nheight = 0.1\nwidth = 0.1\ncenter = [0, "
                  "0]\n[integrator]\nstep = 0.01\n");
  system.run.t_max = 1.0;
  EXPECT_FALSE(estimates_trust(system));
  EXPECT_FALSE(run_single(system, silent).particles[0].trust.known);
  System flown = make_system(circle);
  EXPECT_TRUE(estimates_trust(flown));
  flown.dynamics.everywhere = true;
  EXPECT_FALSE(estimates_trust(flown));
}

}  // namespace
}  // namespace carom
