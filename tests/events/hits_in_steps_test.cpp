// Hits within steps that come together with something else: with another particle's, with the end
// of a step, or with a touch.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "carom/events/world.hpp"
#include "carom/files/system_file.hpp"
#include "carom/starts/sampler.hpp"

namespace carom {
namespace {

/// Runs the system and expects that no particle is lost; returns the hits of all.
std::uint64_t hits_of(const std::string& text, bool everywhere = false) {
  const LoadedSystem loaded = read_system(text, "hits");
  Dynamics dynamics = loaded.system.dynamics;
  dynamics.everywhere = everywhere;
  World world(*loaded.system.table, dynamics);
  const std::vector<State> starts = Sampler(loaded.system).draw_all(world, 0);
  for (std::size_t i = 0; i < starts.size(); ++i) world.add(loaded.system.particles[i], starts[i]);
  Observer silent;
  const double until = loaded.system.run.t_max;
  world.run_until(until, silent);
  std::uint64_t hits = 0;
  for (int i = 0; i < world.size(); ++i) {
    EXPECT_EQ(world.fate(i), Fate::survived) << world.report(i) << "\n" << text;
    const geometry::Vector x = world.state_at(i, Time(until)).position;
    EXPECT_TRUE(world.contains(x)) << text;
    hits += world.hits(i);
  }
  return hits;
}

const char* const charges =
    "[interaction]\nkind = \"coulomb\"\nstrength = 0.5\n[integrator]\nstep = 0.01\n[run]\nt_max = "
    "1.25\n";

// Charges that fly symmetrically come to their walls at the same time, but for rounding.
TEST(HitsInSteps, TwoHitsAtTheSameTimeBothCount) {
  for (int k = 0; k < 40; ++k) {
    const std::string y = std::to_string(0.01 * k), x = std::to_string(0.5 + 0.003 * k);
    const std::string starts =
        "[particles]\ncount = 2\nspeed = 1\n[initial]\nkind = \"list\"\nstarts = [[" + x + ", " +
        y + ", 1, 0], [-" + x + ", -" + y + ", -1, 0]]\n";
    EXPECT_EQ(hits_of("[table]\nshape = \"discs\"\ncenters = [[-2, 0], [2, 0]]\nradius = 0.5\n" +
                      starts + charges),
              2u);
    hits_of("[table]\nshape = \"circle\"\nradius = 1\n" + starts + charges);
  }
}

std::string square(const std::string& position, const std::string& velocity,
                   const std::string& more, const std::string& step) {
  return "[table]\nshape = \"rectangle\"\nwidth = 1\nheight = 1\n" + more +
         "[particles]\nspeed = 1\n[initial]\nkind = \"point\"\nposition = " + position +
         "\nvelocity = " + velocity + "\n[integrator]\nstep = " + step + "\n[run]\nt_max = 20\n";
}

// Half a period is a whole number of steps: what is left of a step after a hit, or before it, is
// rounding.
TEST(HitsInSteps, AHitAtTheEndOfAStepCountsOnce) {
  for (const char* step : {"0.01", "0.02", "0.05", "0.125"})
    EXPECT_EQ(hits_of(square("[0.5, 0.5]", "[1, 0]", "", step), true), 20u) << step;
  // A ball that is thrown up from the floor, under force 1: many hits of both kinds.
  for (const char* step : {"0.01", "0.02", "0.05"})
    for (const char* v : {"-0.8", "-0.6", "-0.4", "0", "0.2", "0.4", "0.8"})
      hits_of(std::string("[table]\nshape = \"rectangle\"\nwidth = 1\nheight = "
                          "1\n[[potential]]\nkind = \"linear\"\n"
                          "force = [0, -1]\n[particles]\nspeed = 1\n[initial]\nkind = "
                          "\"birkhoff\"\nwall = \"bottom\"\n"
                          "s = 0.4\nv_parallel = ") +
              v + "\n[integrator]\nstep = " + step + "\n[run]\nt_max = 50\n");
}

// Orbits that touch a circle nearly along it, and come off it by little more than rounding.
TEST(HitsInSteps, TouchingOrbitHitsOnce) {
  for (const char* start :
       {"[0.999999999999, 0]\nvelocity = [0, 1.000001]", "[0.9999999, 0]\nvelocity = [0, 1]"})
    hits_of(std::string("[table]\nshape = \"circle\"\nradius = 1\n[[potential]]\nkind = "
                        "\"harmonic\"\nomega = 1\n"
                        "[initial]\nkind = \"point\"\nposition = ") +
            start + "\n[integrator]\nstep = 0.01\n[run]\nt_max = 20\n");
}

/// Fate of a particle without force, stepped; `hits` of it.
Fate fate_of(const std::string& text, std::uint64_t& hits) {
  const LoadedSystem loaded = read_system(text, "corner");
  Dynamics dynamics = loaded.system.dynamics;
  dynamics.everywhere = true;
  World world(*loaded.system.table, dynamics);
  world.add(loaded.system.particles[0], Sampler(loaded.system).draw_all(world, 0)[0]);
  Observer silent;
  world.run_until(loaded.system.run.t_max, silent);
  hits = world.hits(0);
  EXPECT_NE(world.fate(0), Fate::lost) << world.report(0) << text;
  return world.fate(0);
}

// No path slips between two walls: right corners turn it back, others that have no unique limit are
// singular.
TEST(HitsInSteps, CornersTurnOrbitsBack) {
  std::uint64_t hits = 0;
  for (const char* step : {"0.01", "0.02", "0.03", "0.05"}) {
    EXPECT_EQ(fate_of(square("[0.5, 0.5]", "[1, 1]", "", step), hits), Fate::survived) << step;
    EXPECT_EQ(hits % 2, 0u);
    EXPECT_EQ(hits, 28u) << step;  // ways of length sqrt(2) after the first half one, two hits each
    const std::string rest = std::string("\n[integrator]\nstep = ") + step + "\n[run]\nt_max = 2\n";
    // The corner of an obstacle on a lattice.
    for (const char* aim : {"[0, 0.4]\nvelocity = [0, -1]", "[0.4, 0]\nvelocity = [-1, 0]"})
      EXPECT_EQ(
          fate_of(std::string(
                      "[table]\nshape = \"path\"\n[[table.loop]]\nstart = [-0.25, 0]\npieces = ["
                      "{line_to = [0, 0.25]}, {line_to = [0.25, 0]}, {line_to = [0, -0.25]}, "
                      "{line_to = "
                      "[-0.25, 0]}]\n[lattice]\nvectors = [[1, 0], [0, 1]]\n[particles]\nspeed = "
                      "1\n[initial]\nkind = \"point\"\nposition = ") +
                      aim + rest,
                  hits),
          Fate::singular)
          << step << aim;
    // A regular triangle has the angle pi/3: three hits turn the particle back. That of a pentagon
    // is none.
    for (const char* sides : {"3", "5"}) {
      const std::string table =
          std::string("[table]\nshape = \"regular\"\nsides = ") + sides +
          "\nradius = 1\n[particles]\nspeed = 1\n[initial]\nkind = \"point\"\nposition = [0.1, "
          "0]\nvelocity = [1, 0]";
      EXPECT_EQ(fate_of(table + rest, hits), *sides == '3' ? Fate::survived : Fate::singular)
          << sides << " " << step;
      EXPECT_EQ(hits, *sides == '3' ? 3u : 1u) << step;
    }
  }
}

}  // namespace
}  // namespace carom
