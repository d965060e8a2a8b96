// Adaptive schemes without a step among typed bumps: no bump is flown through.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "carom/events/energy.hpp"
#include "carom/events/world.hpp"
#include "carom/files/system_file.hpp"
#include "carom/starts/sampler.hpp"

namespace carom {
namespace {

struct End {
  State state;
  double energy_error = 0.0;
};

End end_of(const std::string& bump, const std::string& start, const std::string& integrator,
           double time) {
  const System system =
      read_system(
          "[table]\nshape = \"rectangle\"\nwidth = 2\nheight = 2\n[[potential]]\nkind = "
          "\"expression\"\nexpression = \"" +
              bump + "\"\n[particles]\nspeed = 1\n[initial]\nkind = \"point\"\n" + start +
              "\n[integrator]\n" + integrator + "\n[run]\nt_max = 30\n",
          "typed bump")
          .system;
  World world(*system.table, system.dynamics);
  world.add(system.particles[0], Sampler(system).draw(world, 1, 0));
  const auto energy = [&](const State& s) {
    return energy_of({system.particles.data(), 1}, {&s, 1}, system.dynamics, *system.table).total();
  };
  const double before = energy(world.state_at(0, 0.0));
  Observer observer;
  world.run_until(time, observer);
  EXPECT_EQ(world.fate(0), Fate::survived) << world.report(0);
  End end{world.state_at(0, time)};
  end.energy_error = std::fabs(energy(end.state) - before);
  return end;
}

TEST(TypedBumps, AreMetByAdaptiveSchemes) {
  const std::string bump = "50*exp(-((x-1)^2+(y-1)^2)/(2*0.03^2))";
  // They meet it within a time of 4; later small errors have grown.
  const char* starts[] = {"position = [0.3, 0.4]\nangle = 0.7", "position = [0.2, 1.01]\nangle = 0",
                          "position = [1.7, 0.98]\nangle = 3.1",
                          "position = [0.5, 0.5]\nangle = 0.8",
                          "position = [1.02, 0.1]\nangle = 1.55"};
  int turned = 0;
  for (const std::string start : starts) {
    const End expected = end_of(bump, start, "step = 0.0005", 4.0);
    for (const char* scheme : {"scheme = \"arkode\"", "scheme = \"cvode\""}) {
      const End end = end_of(bump, start, scheme, 4.0);
      EXPECT_LT(end.energy_error, 1e-8) << start << scheme;
      EXPECT_NEAR(end.state.position.x, expected.state.position.x, 1e-5) << start << scheme;
      EXPECT_NEAR(end.state.position.y, expected.state.position.y, 1e-5) << start << scheme;
    }
    turned += std::fabs(std::fabs(expected.state.velocity.x) -
                        std::cos(std::stod(start.substr(start.rfind(' '))))) > 0.01;
  }
  EXPECT_GE(turned, 3);  // others would not tell
}

TEST(TypedBumps, ReflectHeadOn) {
  const std::string bump = "1000*exp(-((x-1)^2+(y-1)^2)/(2*0.022^2))";
  for (const double x : {0.05, 0.1, 0.2, 0.3})
    for (const char* scheme : {"scheme = \"arkode\"", "scheme = \"cvode\""}) {
      const End end =
          end_of(bump, "position = [" + std::to_string(x) + ", 1]\nvelocity = [1, 0]", scheme, 1.0);
      EXPECT_NEAR(end.state.velocity.x, -1.0, 1e-8) << x << scheme;
      EXPECT_LT(end.state.position.x, 1.0) << x << scheme;
      EXPECT_LT(end.energy_error, 1e-8) << x << scheme;
    }
}

TEST(TypedBumps, AnEnergyThatJumpsEndsTheTrajectory) {
  // The angle about the centre, as a typed potential, jumps where no force tells.
  const System system = read_system(
                            "[table]\nshape = \"rectangle\"\nwidth = 2\nheight = "
                            "2\n[[potential]]\nkind = \"expression\"\n"
                            "expression = \"0.1*atan2(y-1,x-1)\"\n[particles]\nspeed = "
                            "1\n[initial]\nkind = \"point\"\n"
                            "position = [0.3, 1.3]\nvelocity = [0, -1]\n[run]\nt_max = "
                            "30\n[integrator]\nscheme = \"arkode\"\n",
                            "angle")
                            .system;
  for (const char* scheme : {"arkode", "cvode"}) {
    Dynamics dynamics = system.dynamics;
    dynamics.integrator.scheme = scheme;
    World world(*system.table, dynamics);
    world.add(system.particles[0], Sampler(system).draw(world, 1, 0));
    Observer observer;
    world.run_until(2.0, observer);
    EXPECT_EQ(world.fate(0), Fate::unresolved) << scheme;
    EXPECT_FALSE(world.report(0).empty());
  }
}

}  // namespace
}  // namespace carom
