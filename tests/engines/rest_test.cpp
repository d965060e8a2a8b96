// Particles that start at rest: forces set them in motion, or hold them where they are.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "analyses/systems.hpp"
#include "carom/analyses/escape.hpp"
#include "carom/analyses/run.hpp"
#include "carom/base/error.hpp"

namespace carom {
namespace {

const std::string plane = "[table]\nshape = \"plane\"\n";
const std::string at = "[initial]\nkind = \"point\"\nposition = [1, 0]\nvelocity = [0, 0]\n";
const std::string well = "[[potential]]\nkind = \"harmonic\"\nomega = 2\n";
std::string integrator(const std::string& lines) {
  return "[integrator]\n" + lines + "\n[run]\nt_max = 3\n";
}

SingleRunResult run(const System& system) {
  Observer silent;
  return run_single(system, silent);
}

TEST(Rest, AReleaseInAHarmonicWellIsACosine) {
  for (const char* lines :
       {"scheme = \"blanes-moan-srkn11b\"\nstep = 0.01",
        "scheme = \"velocity-verlet\"\nstep = 0.0005", "scheme = \"arkode\"\ntolerance = 1e-12",
        "scheme = \"cvode\"\ntolerance = 1e-12"}) {
    const RunEnd end = run(make_system(plane + well + at + integrator(lines))).particles.front();
    EXPECT_EQ(end.progress.fate, Fate::survived) << lines << end.report;
    EXPECT_NEAR(end.x, std::cos(6.0), 1e-5) << lines;
    EXPECT_NEAR(end.vx, -2.0 * std::sin(6.0), 1e-5) << lines;
    EXPECT_EQ(end.y, 0.0) << lines;
  }
}

TEST(Rest, AFieldTurnsWhatIsReleased) {
  // Constant force f along x, a = (f, 0) + omega (v_y, -v_x): a cycloid, x = f/omega^2 (1 -
  // cos(omega t)).
  const System system =
      make_system(plane + "[[potential]]\nkind = \"linear\"\nforce = [1, 0]\n[field]\nB = 2\n" +
                  at + integrator("scheme = \"blanes-moan-srkn11b\"\nstep = 0.01"));
  const RunEnd end = run(system).particles.front();
  EXPECT_NEAR(end.x, 1.0 + 0.25 * (1.0 - std::cos(6.0)), 1e-9);
  EXPECT_NEAR(end.y, 0.25 * std::sin(6.0) - 0.5 * 3.0, 1e-9);
}

TEST(Rest, AnEquilibriumStays) {
  for (const char* lines :
       {"step = 0.01", "scheme = \"arkode\"\nstep = 0.1", "scheme = \"cvode\"\nstep = 0.1"}) {
    const System system = make_system("[table]\nshape = \"circle\"\nradius = 3\n" + well +
                                      "center = [1, 0]\n" + at + integrator(lines));
    const RunEnd end = run(system).particles.front();
    EXPECT_EQ(end.progress.fate, Fate::survived) << lines << end.report;
    EXPECT_EQ(end.x, 1.0) << lines;
    EXPECT_EQ(end.y, 0.0) << lines;
    EXPECT_EQ(end.vx, 0.0) << lines;
    EXPECT_EQ(end.progress.hits, 0u) << lines;
  }
}

// Two charges q at rest a distance d apart: their relative energy q^2/d becomes kinetic, v^2/4 each
// way.
TEST(Rest, TwoChargesRepelEachOther) {
  const System system = make_system(plane +
                                    "[interaction]\nkind = \"coulomb\"\nstrength = "
                                    "1\n[particles]\ncount = 2\n[initial]\nkind = \"list\"\n"
                                    "starts = [[-0.5, 0, 0, 0], [0.5, 0, 0, 0]]\n" +
                                    integrator("scheme = \"blanes-moan-srkn11b\"\nstep = 0.001"));
  const SingleRunResult result = run(system);
  const RunEnd &a = result.particles[0], &b = result.particles[1];
  EXPECT_LT(a.vx, -0.5);
  EXPECT_DOUBLE_EQ(a.vx, -b.vx);
  const double r = b.x - a.x, v = b.vx - a.vx;
  EXPECT_NEAR(v * v / 4.0 + 1.0 / r, 1.0, 1e-9);
  // t = sqrt(1/4) (sqrt(r (r - 1)) + arcosh(sqrt(r))), of r'' = 2/r^2 from r = 1.
  EXPECT_NEAR(0.5 * (std::sqrt(r * (r - 1.0)) + std::acosh(std::sqrt(r))), 3.0, 1e-8);
}

TEST(Rest, AParticleAtRestIsMetWithinTheRangeOfAnInteraction) {
  const System system = make_system(plane +
                                    "[interaction]\nkind = \"yukawa\"\nstrength = 1\nrange = "
                                    "0.01\n[particles]\ncount = 2\nspeed = [0, 1]\n[initial]\n"
                                    "kind = \"list\"\nstarts = [[0, 0, 0, 0], [-1, 0, 1, 0]]\n" +
                                    integrator("scheme = \"blanes-moan-srkn11b\"\nstep = 0.0005"));
  const SingleRunResult result = run(system);
  // Equal masses, head-on: they exchange their velocities.
  EXPECT_NEAR(result.particles[0].vx, 1.0, 1e-6);
  EXPECT_NEAR(result.particles[1].vx, 0.0, 1e-6);
}

TEST(Rest, LanesReleaseAsOneWorldDoes) {
  const System system = make_system("[table]\nshape = \"circle\"\nradius = 3\n" + well +
                                    "[particles]\nspeed = 0\n[initial]\nkind = "
                                    "\"uniform\"\n[integrator]\nstep = 0.01\n[run]\nt_max = 3\n"
                                    "trajectories = 100\n");
  EscapeOptions lanes, one_by_one;
  lanes.threads = one_by_one.threads = 1;
  one_by_one.lanes = std::nullopt;
  const EscapeResult a = run_escape(system, lanes), b = run_escape(system, one_by_one);
  EXPECT_EQ(a.digest, b.digest);
  EXPECT_TRUE(a.lanes);
  EXPECT_EQ(a.counts.lost, 0u);
}

std::string place_of_fault(const std::string& toml) {
  try {
    make_system(toml);
  } catch (const InputError& error) {
    return error.place().key;
  }
  return "none";
}

TEST(Rest, RestWithoutAForceIsRefused) {
  const std::string end = integrator("step = 0.01");
  EXPECT_EQ(place_of_fault(plane + at + end), "initial.velocity");
  EXPECT_EQ(place_of_fault(plane + "[particles]\nspeed = 0\n" + at + end), "particles.speed");
  // An interaction acts on several.
  const std::string coulomb = "[interaction]\nkind = \"coulomb\"\nstrength = 1\n";
  EXPECT_NE(place_of_fault(plane + coulomb + at + end), "none");
  // A direction is needed where a speed or an energy is given, and a wall is no place to rest.
  EXPECT_EQ(place_of_fault(plane + well + "[particles]\nspeed = 1\n" + at + end),
            "initial.velocity");
  EXPECT_EQ(place_of_fault(plane + well + "[particles]\nenergy = 10\n" + at + end),
            "initial.velocity");
  EXPECT_EQ(place_of_fault("[table]\nshape = \"circle\"\nradius = 1\n" + well +
                           "[particles]\nspeed = 0\n[initial]\nkind = \"boundary\"\n" + end),
            "initial.kind");
}

TEST(Rest, RestBeyondAllForcesIsRefused) {
  const System system = make_system(
      "[table]\nshape = \"circle\"\nradius = 3\n[[potential]]\nkind = \"gaussian\"\nheight = "
      "1\nwidth = 0.01\n" +
      at + integrator("step = 0.001"));
  Observer silent;
  EXPECT_THROW(run_single(system, silent), InputError);
}

}  // namespace
}  // namespace carom
