// Adaptive schemes do not step over bumps that are narrow for the way of a particle.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "carom/events/energy.hpp"
#include "carom/events/world.hpp"
#include "carom/files/system_file.hpp"
#include "carom/starts/sampler.hpp"

namespace carom {
namespace {

State end_of(const System& system, bool everywhere) {
  Dynamics dynamics = system.dynamics;
  dynamics.everywhere = everywhere;
  World world(*system.table, dynamics);
  world.add(system.particles[0], Sampler(system).draw(world, 1, 0));
  Observer silent;
  world.run_until(12.0, silent);
  EXPECT_EQ(world.fate(0), Fate::survived) << world.report(0);
  const State end = world.state_at(0, 12.0);
  const double energy =
      energy_of({system.particles.data(), 1}, {&end, 1}, dynamics, *system.table).total();
  EXPECT_NEAR(energy, 0.5, 1e-8);
  return end;
}

TEST(NarrowBumps, AreMetByAdaptiveSchemes) {
  for (const char* bump : {"kind = \"gaussian\"\nheight = 2\nwidth = 0.01\n",
                           "kind = \"fermi\"\nheight = 2\nradius = 0.1\nsoftness = 0.001\n"}) {
    const auto with = [&](const std::string& integrator) {
      return read_system(
          std::string("[table]\nshape = \"rectangle\"\nwidth = 20\nheight = 10\n[[potential]]\n") +
              bump + "center = [15, 5]\n[particles]\nspeed = 1\n[initial]\nkind = \"point\"\n" +
              "position = [10, 5.002]\nvelocity = [1, 0]\n[integrator]\n" + integrator +
              "\n[run]\nt_max = 12\n",
          "narrow");
    };
    const State expected = end_of(with("step = 0.0005").system, false);
    EXPECT_LT(expected.velocity.x, 0.0);  // it was turned back
    for (const char* scheme : {"scheme = \"arkode\"", "scheme = \"cvode\""})
      for (const bool everywhere : {false, true}) {
        const State end = end_of(with(scheme).system, everywhere);
        EXPECT_NEAR(end.position.x, expected.position.x, 1e-5) << bump << scheme << everywhere;
        EXPECT_NEAR(end.position.y, expected.position.y, 1e-5) << bump << scheme << everywhere;
      }
  }
}

// Samples without an end of a particle that is not there any more would take for ever.
TEST(NarrowBumps, SamplesEndWithTheParticleThatMissedOne) {
  const LoadedSystem loaded = read_system(
      "[table]\nshape = \"rectangle\"\nwidth = 2\nheight = 2\n[[potential]]\n"
      "kind = \"gaussian\"\nheight = 50\nwidth = 0.03\ncenter = [1, 1]\n[particles]\nspeed = 1\n"
      "[initial]\nkind = \"point\"\nposition = [0.3, 0.4]\nvelocity = [0.6, 0.8]\n"
      "[integrator]\nscheme = \"velocity-verlet\"\nstep = 0.5\n[run]\nt_max = 20\n",
      "narrow");
  const System& system = loaded.system;
  World world(*system.table, system.dynamics);
  world.sample_every(0.25);
  world.add(system.particles[0], Sampler(system).draw(world, 0, 0));
  struct : Observer {
    void sample(int, Time time, const State&) override { last = time.value(); }
    double last = 0.0;
  } samples;
  world.run_until(1e300, samples);
  EXPECT_EQ(world.fate(0), Fate::unresolved);
  EXPECT_LE(samples.last, world.state(0).time.value() + 0.25);
}

}  // namespace
}  // namespace carom
