// All exponents of several particles: against those of one, against identities, and in parts.
#include "carom/analyses/lyapunov/spectrum.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "analyses/systems.hpp"
#include "carom/analyses/lyapunov.hpp"
#include "carom/base/error.hpp"

namespace carom {
namespace {

const char* const stadium = "[table]\nshape = \"stadium\"\nhalf_length = 1\nradius = 1\n";
const char* const henon_heiles = R"toml([[potential]]
kind = "henon-heiles"
[particles]
energy = 0.125
[initial]
kind = "point"
position = [0, -0.25]
velocity = [1, 0]
[integrator]
step = 0.1
)toml";
// A start in the open plane.
const std::string anywhere = "[initial]\nkind = \"rectangle\"\nmin = [-1, -1]\nmax = [1, 1]\n";
// In their relative motion, which has speed 1, they are one particle among discs of radius 0.4.
const char* const two_discs = R"toml([lattice]
vectors = [[1, 0], [0, 1]]
[interaction]
kind = "hard-discs"
radius = 0.2
[particles]
count = 2
[initial]
kind = "list"
starts = [[0.1, 0.2, 0.3, 0.4], [0.6, 0.7, -0.3, -0.4]]
)toml";

System system_of(const std::string& text, double t_max, std::uint64_t trajectories,
                 bool spectrum = true) {
  System system = make_system(text + "[run]\nt_max = " + std::to_string(t_max) +
                              "\ntrajectories = " + std::to_string(trajectories) + "\n");
  system.run.spectrum = spectrum;
  return system;
}
LyapunovResult run(const System& system, int threads = 2, std::uint64_t k = 1,
                   std::uint64_t of = 1) {
  LyapunovOptions how;
  how.threads = threads;
  how.part = shard(k, of, system.run.trajectories);
  return run_lyapunov(system, how);
}
SpectrumEstimate spectrum_of(const System& system) { return estimate_of(run(system).spectrum); }

TEST(Spectrum, IsRefusedWhereEachParticleHasItsOwn) {
  EXPECT_THROW(run(system_of(std::string(stadium) + "[particles]\ncount = 2\n", 10, 2)),
               InputError);
}

TEST(Spectrum, OfAHarmonicWellIsZero) {
  const System system =
      system_of(anywhere +
                    "[[potential]]\nkind = \"harmonic\"\nomega_x = 1\nomega_y = 1.7\n"
                    "[particles]\nenergy = 1\n[integrator]\nstep = 0.02\n",
                400, 2);
  EXPECT_EQ(vanishing_exponents(system).count, 4u);
  for (const Estimate& one : spectrum_of(system).exponents) EXPECT_NEAR(one.value, 0.0, 2e-3);
}

TEST(Spectrum, OfOneParticleIsThatOfItsLargestExponent) {
  for (const std::string& text : {std::string(henon_heiles), std::string(stadium)}) {
    const bool forces = text == henon_heiles;
    const System whole = system_of(text, forces ? 2000 : 200, forces ? 1 : 100);
    System largest = whole;
    largest.run.spectrum = false;
    const LyapunovResult result = run(whole);
    const SpectrumEstimate e = estimate_of(result.spectrum);
    const LyapunovEstimate one = estimate_of(run(largest).growth);
    ASSERT_EQ(e.exponents.size(), 4u);
    EXPECT_NEAR(e.exponents[0].value, one.per_time.value, 0.02 * one.per_time.value);
    EXPECT_EQ(e.exponents[0].value, estimate_of(whole, result).per_time.value);
    EXPECT_EQ(e.exponents[0].error, estimate_of(whole, result).per_time.error);
    EXPECT_EQ(e.entropy.value, e.exponents[0].value);
    EXPECT_LT(e.pairing, 1e-10);
    EXPECT_LT(e.largest_zero, 0.02);
  }
}

TEST(Spectrum, TwoDiscsOnATorusAreAParticleAmongDiscs) {
  const System system = system_of(two_discs, 2e4, 1);
  EXPECT_EQ(vanishing_exponents(system).count, 6u);
  const SpectrumEstimate e = spectrum_of(system);
  EXPECT_NEAR(e.entropy.value, 2.73845, 4 * e.entropy.error);
  EXPECT_LT(e.entropy.error, 0.03);
  EXPECT_LT(e.pairing, 1e-11);
  EXPECT_LT(e.largest_zero, 5e-4);
  EXPECT_GT(e.largest_zero, 1e-6);
}

TEST(Spectrum, CountsConservationLaws) {
  const auto zeros = [](const std::string& text) {
    return vanishing_exponents(system_of(anywhere + text, 10, 1)).count;
  };
  const std::string charges =
                        "[particles]\ncount = 5\nenergy = 8\n[interaction]\nkind = \"coulomb\"\n",
                    well = "[[potential]]\nkind = \"harmonic\"\n",
                    round = "[table]\nshape = \"circle\"\nradius = 2\n";
  EXPECT_EQ(zeros(charges + well), 8u);
  EXPECT_EQ(zeros(charges + "[[potential]]\nkind = \"harmonic\"\nomega_x = 1\nomega_y = 2\n"), 6u);
  EXPECT_EQ(zeros(charges + "[[potential]]\nkind = \"quartic\"\n"), 4u);
  EXPECT_EQ(zeros(charges + round), 4u);
  EXPECT_EQ(zeros(charges + round + "[[potential]]\nkind = \"quartic\"\ncenter = [0.1, 0]\n"), 2u);
  EXPECT_EQ(zeros(charges + stadium), 2u);
  EXPECT_EQ(zeros(stadium), 2u);
  EXPECT_EQ(zeros(round), 4u);
}

TEST(Spectrum, IsTheSameOnThreadsAndFromParts) {
  const System system = system_of(
      "[table]\nshape = \"rectangle\"\nwidth = 1\nheight = 1\n"
      "[particles]\ncount = 2\nmass = [1, 2]\n"
      "[interaction]\nkind = \"hard-discs\"\nradius = 0.2\n",
      20, 9);
  const LyapunovResult one = run(system, 1), two = run(system, 2);
  LyapunovResult sum = run(system, 1, 2, 3);
  for (const std::uint64_t k : {3u, 1u}) ASSERT_TRUE(sum.add(run(system, 1, k, 3)));
  const LyapunovResult* const others[] = {&two, &sum};
  for (const LyapunovResult* other : others) {
    EXPECT_EQ(other->digest, one.digest);
    for (std::size_t i = 0; i < one.spectrum.sums().size(); ++i) {
      const auto &a = one.spectrum.sums()[i].totals(), &b = other->spectrum.sums()[i].totals();
      EXPECT_EQ(a.growth.state(), b.growth.state()) << i;
      EXPECT_EQ(a.levels[1].growth.state(), b.levels[1].growth.state()) << i;
    }
  }
}

TEST(Spectrum, RefusesTooManyParticles) {
  const System system = system_of(std::string(stadium) + "[particles]\ncount = 129\n", 10, 1);
  try {
    run(system);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.place().key, "run.spectrum");
  }
}

}  // namespace
}  // namespace carom
