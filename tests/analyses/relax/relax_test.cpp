// Equilibria: published energies, symmetries, modes, walls that hold particles.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "carom/analyses/relax.hpp"
#include "carom/base/error.hpp"
#include "carom/files/system_file.hpp"

namespace carom {
namespace {

LoadedSystem wigner(int count, std::vector<std::pair<std::string, std::string>> more = {}) {
  SystemOverrides set;
  set.set = {{"particles.count", std::to_string(count)}, {"particles.energy", "100"}};
  set.set.insert(set.set.end(), more.begin(), more.end());
  return load_system("wigner", set);
}

LoadedSystem built_in(const std::string& name, const std::string& count) {
  SystemOverrides set;
  set.set = {{"particles.count", count}};
  return load_system(name, set);
}

RelaxResult relaxed(const System& system, std::uint64_t starts, bool saddles = false) {
  RelaxOptions how;
  how.starts = starts;
  how.saddles = saddles;
  how.threads = 2;
  return run_relax(system, how);
}

bool has_frequency(const Equilibrium& e, double wanted) {
  return std::any_of(e.modes.begin(), e.modes.end(), [&](const NormalMode& m) {
    return std::fabs(m.frequency - wanted) < 1e-10 * wanted;
  });
}

TEST(Relax, WignerMoleculesHaveTheirEnergiesAndModes) {
  const double energies[] = {0.75, 1.3103706971, 1.8354456111, 2.3384453805};
  const double omega = std::numbers::sqrt2;
  for (int n = 2; n <= 5; ++n) {
    const LoadedSystem loaded = wigner(n);
    const RelaxResult found = relaxed(loaded.system, 30);
    ASSERT_FALSE(found.equilibria.empty());
    const Equilibrium& ground = found.equilibria.front();
    EXPECT_NEAR(ground.energy / n, energies[n - 2], 5.1e-11) << n;
    EXPECT_TRUE(ground.minimum());
    EXPECT_EQ(ground.neutral, 1) << n;  // it can be turned
    EXPECT_EQ(ground.modes.size(), static_cast<std::size_t>(2 * n));
    EXPECT_TRUE(has_frequency(ground, std::sqrt(3.0) * omega)) << n;  // it breathes
    EXPECT_EQ(
        std::count_if(ground.modes.begin(), ground.modes.end(),
                      [&](const NormalMode& m) { return std::fabs(m.frequency - omega) < 1e-10; }),
        2)
        << n;  // its centre of mass moves
    EXPECT_EQ(found.without, 0u);
    // Starts are many, shapes few: what is turned or reflected counts once.
    EXPECT_LE(found.equilibria.size(), n == 5 ? 2u : 1u) << n;
  }
}

// Shells of 4 and 9, or of 7 about one and 11, turn against each other at frequencies of 6e-4 and
// 1e-4; charges inside a ring of charges likewise. Every search ends at a minimum all the same.
TEST(Relax, SoftShellsAreFollowedToTheirMinima) {
  const RelaxResult thirteen = relaxed(wigner(13).system, 40);
  EXPECT_EQ(thirteen.without, 0u);
  ASSERT_EQ(thirteen.equilibria.size(), 1u);
  const Equilibrium& ground = thirteen.equilibria.front();
  EXPECT_EQ(ground.found, 40u);
  EXPECT_EQ(ground.neutral, 1);
  EXPECT_LT(ground.modes[24].frequency, 1e-3);
  // A soft direction leads far, but not up.
  EXPECT_GT(ground.position_error, 1e-9);
  EXPECT_LT(ground.energy_error, 1e-12 * ground.energy);
  const RelaxResult nineteen = relaxed(wigner(19).system, 30);
  EXPECT_EQ(nineteen.without, 0u);
  EXPECT_EQ(nineteen.equilibria.size(), 2u);
}

TEST(Relax, RingsOfChargesTurnAboutOthers) {
  const LoadedSystem loaded = built_in("coulomb-circle", "19");
  const RelaxResult found = relaxed(loaded.system, 8);
  EXPECT_EQ(found.without, 0u);
  for (const Equilibrium& e : found.equilibria) EXPECT_TRUE(e.minimum());
}

// What is looked for has no kinetic energy: less than that of the lowest minimum is no hindrance.
TEST(Relax, TheEnergyOfTheParticlesDoesNotLimitTheStarts) {
  const RelaxResult low = relaxed(wigner(5, {{"particles.energy", "1"}}).system, 30),
                    high = relaxed(wigner(5).system, 30);
  ASSERT_EQ(low.equilibria.size(), 2u);
  EXPECT_EQ(low.equilibria[0].found, high.equilibria[0].found);
  EXPECT_EQ(low.equilibria[0].positions, high.equilibria[0].positions);
}

// Five particles that do not act on each other have each frequency five times.
TEST(Relax, DegenerateModesInAFieldAreFound) {
  const LoadedSystem loaded = built_in("antidot-magnetic", "5");
  const RelaxResult found = relaxed(loaded.system, 5, true);
  ASSERT_FALSE(found.equilibria.empty());
  const Equilibrium& ground = found.equilibria.front();
  ASSERT_EQ(ground.modes.size(), 10u);
  for (std::size_t k = 0; k < 5; ++k) {
    // The product of both is the curvature over the mass, their difference the field.
    EXPECT_NEAR(ground.modes[k].frequency - ground.modes[5 + k].frequency, 2.0, 1e-13);
    EXPECT_NEAR(ground.modes[k].frequency, ground.modes[0].frequency, 1e-13);
  }
}

// Kohn: the centre of mass moves at (sqrt(4 omega^2 + B^2) +- B)/2, whatever the particles do.
TEST(Relax, CentreOfMassTurnsInAField) {
  const double b = 0.7, omega = std::numbers::sqrt2, root = std::sqrt(4 * omega * omega + b * b);
  const LoadedSystem loaded = wigner(3, {{"field.B", "0.7"}});
  const Equilibrium ground = relaxed(loaded.system, 5).equilibria.at(0);
  EXPECT_EQ(ground.modes.size(), 6u);
  EXPECT_TRUE(has_frequency(ground, (root + b) / 2));
  EXPECT_TRUE(has_frequency(ground, (root - b) / 2));
  for (const NormalMode& m : ground.modes) EXPECT_EQ(m.growth, 0.0);
}

// Three saddles at E = 1/6, symmetric copies of each other, about the minimum at 0. At a saddle the
// curvatures are 3 and -1.
TEST(Relax, HenonHeilesHasItsSaddles) {
  const LoadedSystem loaded = read_system(
      "[[potential]]\nkind = \"henon-heiles\"\n[particles]\nenergy = 2\n[initial]\nkind = "
      "\"rectangle\"\nmin = [-1, -0.6]\nmax = [1, 1.2]\n[integrator]\nstep = 0.01\n",
      "saddles.toml");
  const RelaxResult found = relaxed(loaded.system, 60, true);
  ASSERT_EQ(found.equilibria.size(), 2u);
  EXPECT_NEAR(found.equilibria[0].energy, 0.0, 1e-30);
  EXPECT_TRUE(found.equilibria[0].minimum());
  const Equilibrium& saddle = found.equilibria[1];
  EXPECT_NEAR(saddle.energy, 1.0 / 6.0, 1e-16);
  EXPECT_EQ(saddle.descending, 1);
  EXPECT_NEAR(saddle.modes[0].frequency, std::sqrt(3.0), 1e-14);
  EXPECT_NEAR(saddle.modes[1].growth, 1.0, 1e-14);
}

LoadedSystem ring(int count, const std::string& more = {}) {
  return read_system(
      "[table]\nshape = \"circle\"\nradius = 1\n[interaction]\nkind = \"coulomb\"\n"
      "[particles]\ncount = " +
          std::to_string(count) +
          "\nenergy = 20\n[integrator]\nstep = 0.001\n[initial]\nkind = "
          "\"uniform\"\n" +
          more,
      "ring.toml");
}

// N charges on the unit circle: E = (N/4) sum over k of 1/sin(pi k/N). One in the middle pays from
// twelve on.
TEST(Relax, ChargesGoToTheWall) {
  for (const int n : {2, 3, 7}) {
    double energy = 0.0;
    for (int k = 1; k < n; ++k) energy += 0.25 * n / std::sin(std::numbers::pi * k / n);
    const LoadedSystem loaded = ring(n);
    const RelaxResult found = relaxed(loaded.system, 10);
    ASSERT_FALSE(found.equilibria.empty()) << n;
    const Equilibrium& ground = found.equilibria.front();
    EXPECT_NEAR(ground.energy, energy, 1e-13 * energy) << n;
    EXPECT_TRUE(ground.minimum());
    EXPECT_EQ(ground.neutral, 1);
    EXPECT_EQ(ground.modes.size(), static_cast<std::size_t>(n));
    for (const int wall : ground.walls) EXPECT_EQ(wall, 0);
  }
  const LoadedSystem fifteen = ring(15);
  const RelaxResult found = relaxed(fifteen.system, 20);
  ASSERT_FALSE(found.equilibria.empty());
  const auto& walls = found.equilibria.front().walls;
  EXPECT_EQ(std::count(walls.begin(), walls.end(), -1), 1);  // one stays in the middle
}

// Four charges in a unit square: one in each corner, which holds it without any freedom. In a
// stadium charges slide from a straight wall to a cap.
TEST(Relax, CornersHoldCharges) {
  const std::string charges =
      "[interaction]\nkind = \"coulomb\"\n[particles]\ncount = 4\nenergy = 20\n[integrator]\nstep "
      "= "
      "0.001\n[initial]\nkind = \"uniform\"\n";
  const LoadedSystem square = read_system(
      "[table]\nshape = \"rectangle\"\nwidth = 1\nheight = 1\n" + charges, "square.toml");
  const RelaxResult found = relaxed(square.system, 10);
  ASSERT_FALSE(found.equilibria.empty());
  EXPECT_NEAR(found.equilibria[0].energy, 4.0 + std::numbers::sqrt2, 1e-14);
  EXPECT_TRUE(found.equilibria[0].modes.empty());
  EXPECT_EQ(found.without, 0u);
  const LoadedSystem stadium = read_system(
      "[table]\nshape = \"stadium\"\nhalf_length = 1\nradius = 1\n" + charges, "stadium.toml");
  const RelaxResult slid = relaxed(stadium.system, 10);
  ASSERT_FALSE(slid.equilibria.empty());
  EXPECT_LE(slid.without, 1u);
  for (const int wall : slid.equilibria[0].walls) EXPECT_GE(wall, 0);
}

TEST(Relax, ThreadsDoNotMatter) {
  const LoadedSystem loaded = wigner(6);
  RelaxOptions one, three;
  one.threads = 1;
  three.threads = 3;
  one.starts = three.starts = 12;
  const RelaxResult a = run_relax(loaded.system, one), b = run_relax(loaded.system, three);
  ASSERT_EQ(a.equilibria.size(), b.equilibria.size());
  for (std::size_t i = 0; i < a.equilibria.size(); ++i) {
    EXPECT_EQ(a.equilibria[i].energy, b.equilibria[i].energy);
    EXPECT_EQ(a.equilibria[i].found, b.equilibria[i].found);
    EXPECT_EQ(a.equilibria[i].positions, b.equilibria[i].positions);
  }
}

// Two charges that nothing holds fly apart: there is no minimum, and none is invented.
TEST(Relax, WhatIsNotHeldHasNoEquilibrium) {
  const LoadedSystem loaded = read_system(
      "[interaction]\nkind = \"coulomb\"\n[particles]\ncount = 2\nenergy = 5\n[integrator]\nstep = "
      "0.001\n[initial]\nkind = \"rectangle\"\nmin = [-1, -1]\nmax = [1, 1]\n",
      "free.toml");
  const RelaxResult found = relaxed(loaded.system, 10);
  EXPECT_TRUE(found.equilibria.empty());
  EXPECT_EQ(found.without, 10u);
}

TEST(Relax, WhereNothingActsItIsRefused) {
  try {
    relaxed(load_system("stadium", {}).system, 1);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_EQ(e.place().key, "potential");
  }
}

}  // namespace
}  // namespace carom
