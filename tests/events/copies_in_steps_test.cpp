// Steps on a lattice meet all copies of walls and supports, however the lattice and the centres
// were written.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>

#include "carom/events/energy.hpp"
#include "carom/events/world.hpp"
#include "carom/files/system_file.hpp"
#include "carom/starts/sampler.hpp"

namespace carom {
namespace {

using geometry::Vector;

struct Recorder : Observer {
  std::vector<HitEvent> hits;
  void hit(const HitEvent& event) override { hits.push_back(event); }
};

Vector in_plane(const System& system, Vector position, const geometry::Cell& cell) {
  return position + system.table->lattice->translation(cell);
}
double distance(Vector a, Vector b) { return std::sqrt(dot(a - b, a - b)); }

Dynamics all_in_steps(const System& system) {
  Dynamics d = system.dynamics;
  d.everywhere = true;
  return d;
}

const char* const vectors[] = {"[[1, 0], [0, 1]]", "[[1, 0], [3, 1]]", "[[4, 1], [-7, -2]]",
                               "[[12, 1], [13, 1]]"};

// A flight is followed exactly, and in steps, until chaos has amplified rounding.
TEST(CopiesInSteps, StepsRepeatFlightsAmongTheSameDiscs) {
  for (const char* lattice : vectors)
    for (const char* second : {"[0.5, 0.5]", "[5.5, 0.5]", "[-3.5, 10.5]"})
      for (const char* start : {"[0.5, 0]", "[-20.53, 7.03]"}) {
        const LoadedSystem loaded = read_system(
            std::string("[table]\nshape = \"discs\"\ncenters = [[0, 0], ") + second +
                "]\nradius = 0.34\n[lattice]\n" + "vectors = " + lattice +
                "\n[initial]\nkind = \"point\"\nposition = " + start +
                "\nvelocity = [0.125, 1]\n[integrator]\nstep = 0.25\n[run]\nt_max = 10\n",
            "discs");
        const System& system = loaded.system;
        World exact(*system.table), stepped(*system.table, all_in_steps(system));
        const State begin = Sampler(system).draw(exact, 1, 0);
        Recorder a, b;
        exact.add(system.particles[0], begin);
        stepped.add(system.particles[0], begin);
        exact.run_until(3.0, a);
        stepped.run_until(3.0, b);
        ASSERT_GE(a.hits.size(), 9u);
        ASSERT_EQ(a.hits.size(), b.hits.size()) << lattice << second << start;
        for (std::size_t i = 0; i < a.hits.size(); ++i) {
          EXPECT_EQ(a.hits[i].wall, b.hits[i].wall);
          EXPECT_LT(distance(in_plane(system, a.hits[i].position, a.hits[i].cell),
                             in_plane(system, b.hits[i].position, b.hits[i].cell)),
                    1e-5)
              << lattice << second << start << i;
        }
      }
}

// Bumps between which particles fly: that gives what integrating everything gives.
TEST(CopiesInSteps, FlightsEndAtAllCopiesOfSupports) {
  for (const char* lattice : vectors)
    for (const char* centres :
         {"[[0, 0], [0.5, 0.5]]", "[[3, 0], [0.5, -1.5]]", "[[0, 0], [100.5, -40.5]]"})
      for (const char* start : {"[0.03, 0.02]", "[0.5, 0.45]", "[7.53, 0.48]"}) {
        const LoadedSystem loaded =
            read_system(std::string("[lattice]\nvectors = ") + lattice +
                            "\n[[potential]]\nkind = \"fermi\"\nheight = 2\n" +
                            "radius = 0.3\nsoftness = 0.0008\ncenters = " + centres +
                            "\nlattice = true\n[particles]\nspeed = 1\n" +
                            "[initial]\nkind = \"point\"\nposition = " + start +
                            "\nvelocity = [1, 0.25]\n[integrator]\nscheme = "
                            "\"velocity-verlet\"\nstep = 0.0001\n[run]\nt_max = 10\n",
                        "bumps");
        const System& system = loaded.system;
        ASSERT_FALSE(system.dynamics.forces->everywhere());
        World free(*system.table, system.dynamics), stepped(*system.table, all_in_steps(system));
        const State begin = Sampler(system).draw(free, 1, 0);
        Observer silent;
        Vector end[2];
        int k = 0;
        for (World* world : {&free, &stepped}) {
          world->add(system.particles[0], begin);
          world->run_until(0.7, silent);
          const State s = world->state_at(0, 0.7);
          end[k++] = in_plane(system, s.position, s.cell);
          EXPECT_EQ(world->fate(0), Fate::survived) << world->report(0);
        }
        EXPECT_LT(distance(end[0], end[1]), 1e-9) << lattice << centres << start;
      }
}

}  // namespace
}  // namespace carom
