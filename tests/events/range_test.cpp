// Interactions of finite range: groups merge and split, and it is the motion of all in one group.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "carom/base/error.hpp"
#include "carom/events/energy.hpp"
#include "carom/events/world.hpp"
#include "carom/files/system_file.hpp"
#include "carom/starts/sampler.hpp"

namespace carom {
namespace {

using geometry::Vector;

struct Result {
  std::vector<State> end;
  double energy_error = 0.0;
  std::uint64_t events = 0;
};

Result run(const System& system, bool everywhere, double until) {
  Dynamics dynamics = system.dynamics;
  dynamics.everywhere = everywhere;
  World world(*system.table, dynamics);
  const std::vector<State> starts = Sampler(system).draw_all(world, 0);
  for (std::size_t i = 0; i < starts.size(); ++i) world.add(system.particles[i], starts[i]);
  Observer silent;
  Result r;
  r.events = world.run_until(until, silent);
  std::vector<State> after;
  for (int i = 0; i < world.size(); ++i) {
    EXPECT_EQ(world.fate(i), Fate::survived) << world.report(i);
    after.push_back(world.state_at(i, Time(until)));
  }
  const auto energy = [&](const std::vector<State>& s) {
    return energy_of(system.particles, s, system.dynamics, *system.table).total();
  };
  r.energy_error = energy(after) / energy(starts) - 1.0;
  r.end = after;
  return r;
}

LoadedSystem yukawa(const std::string& table, int count, const std::string& range,
                    const std::string& field) {
  return read_system(
      table + "[interaction]\nkind = \"yukawa\"\nstrength = 0.01\nrange = " + range +
          "\n[field]\nB = " + field + "\n[particles]\nspeed = 1\ncount = " + std::to_string(count) +
          "\n[initial]\nkind = \"uniform\"\n[integrator]\nstep = 0.0005\n[run]\nt_max = 10\n",
      "yukawa");
}

const char* const square = "[table]\nshape = \"rectangle\"\nwidth = 1\nheight = 1\n";

TEST(Range, GroupsThatMergeAndSplitMoveAsAllInOne) {
  for (const char* field : {"0", "0.8"}) {
    const LoadedSystem loaded = yukawa(square, 3, "0.002", field);
    const System& system = loaded.system;
    ASSERT_LT(system.dynamics.forces->pair_range(), 0.1);
    const Result apart = run(system, false, 2.0), together = run(system, true, 2.0);
    EXPECT_LT(apart.events, together.events / 2) << "the particles should fly most of the time";
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector d = apart.end[i].position - together.end[i].position;
      EXPECT_LT(std::sqrt(dot(d, d)), 1e-8) << i;
    }
  }
}

TEST(Range, EnergyIsKeptThroughManyMeetings) {
  for (const char* field : {"0", "1"}) {
    const LoadedSystem loaded = yukawa(square, 8, "0.003", field);
    const Result r = run(loaded.system, false, 20.0);
    EXPECT_LT(std::fabs(r.energy_error), 1e-6) << field;
  }
}

TEST(Range, TheNearestCopyOnALatticeCounts) {
  const LoadedSystem loaded = yukawa("[lattice]\nvectors = [[1, 0], [0, 1]]\n", 4, "0.002", "0");
  const Result apart = run(loaded.system, false, 2.0), together = run(loaded.system, true, 2.0);
  for (std::size_t i = 0; i < 4; ++i) {
    const geometry::Lattice& lattice = *loaded.system.table->lattice;
    const Vector d = apart.end[i].position + lattice.translation(apart.end[i].cell) -
                     (together.end[i].position + lattice.translation(together.end[i].cell));
    EXPECT_LT(std::sqrt(dot(d, d)), 1e-8) << i;
  }
}

/// Positions at the end, and the relative error of the energy, as those of everything in one group.
void expect_as_in_one_group(const System& system, double until, double tolerance) {
  const Result apart = run(system, false, until), together = run(system, true, until);
  EXPECT_LT(std::fabs(apart.energy_error), 1e-4);
  for (std::size_t i = 0; i < apart.end.size(); ++i) {
    const Vector d = apart.end[i].position - together.end[i].position;
    EXPECT_LT(std::sqrt(dot(d, d)), tolerance) << i;
  }
}

std::string list_of(const std::string& interaction, const std::string& starts, int count) {
  return "[interaction]\n" + interaction + "\n[particles]\ncount = " + std::to_string(count) +
         "\nspeed = 1\n[initial]\nkind = \"list\"\nstarts = " + starts +
         "\n[integrator]\nstep = 0.0025\n[run]\nt_max = 1\n";
}

// Where a potential acts everywhere, particles that start within their range interact from the
// first step on.
TEST(Range, ParticlesThatStartUnderAForceInteractAtOnce) {
  const char* const starts = "[[-0.1, 0, 0, 1], [0.1, 0, 1, 0]]";
  for (const char* kind : {"kind = \"yukawa\"\nstrength = 1\nrange = 0.5",
                           "kind = \"soft-sphere\"\ndiameter = 0.2\nexponent = 12\nstrength = 1",
                           "kind = \"lennard-jones\"\ndiameter = 0.2\ndepth = 1"}) {
    const LoadedSystem loaded = read_system(
        "[[potential]]\nkind = \"harmonic\"\nomega = 1\n" + list_of(kind, starts, 2), "trap");
    expect_as_in_one_group(loaded.system, 1.0, 1e-12);
  }
}

// The second is near the first, the third near the second alone; and in every order of numbers.
TEST(Range, AChainStartsAsOneGroup) {
  for (const char* starts : {"[[-3.7, 0, 0, 1], [0, 0, 1, 0], [0.2, 0.1, 0, 1]]",
                             "[[0, 0, 1, 0], [-3.7, 0, 0, 1], [0.2, 0.1, 0, 1]]",
                             "[[0.2, 0.1, 0, 1], [-3.7, 0, 0, 1], [0, 0, 1, 0]]"}) {
    const LoadedSystem loaded =
        read_system(list_of("kind = \"yukawa\"\nstrength = 1\nrange = 0.1", starts, 3), "chain");
    expect_as_in_one_group(loaded.system, 1.0, 1e-12);
  }
}

// Three pairs, each of them a group, fly towards each other.
TEST(Range, GroupsTakeInGroups) {
  const LoadedSystem loaded =
      read_system(list_of("kind = \"yukawa\"\nstrength = 0.05\nrange = 0.02",
                          "[[-1, 0.1, 1, 0], [-1, -0.1, 1, 0], [1, 0.12, -1, 0], [1, -0.11, -1, "
                          "0], [0.13, 1, 0, -1], "
                          "[-0.14, 1, 0, -1]]",
                          6),
                  "pairs");
  ASSERT_LT(loaded.system.dynamics.forces->pair_range(), 1.0);
  expect_as_in_one_group(loaded.system, 2.0, 1e-9);
}

// Two that enter within a step of a group, one free and one under a force: the group's step ends
// then.
TEST(Range, LateParticlesInteractAtOnce) {
  for (const bool trap : {false, true}) {
    const LoadedSystem loaded =
        read_system((trap ? "[[potential]]\nkind = \"harmonic\"\nomega = 1\n" : "") +
                        list_of("kind = \"yukawa\"\nstrength = 1\nrange = 0.1",
                                "[[0, 0, 1, 0], [0.3, 0, 0, 1], [0, 9, 1, 0]]", 3),
                    "late");
    std::vector<Vector> end;
    for (const bool everywhere : {false, true}) {
      Dynamics dynamics = loaded.system.dynamics;
      dynamics.everywhere = everywhere;
      World world(*loaded.system.table, dynamics);
      std::vector<State> starts(3);
      starts[0].position = {0.0, 0.0};
      starts[1].position = {0.3, 0.0};
      starts[2].position = {0.2, 0.1};
      starts[2].time = Time(0.205);
      for (std::size_t i = 0; i < 3; ++i) {
        starts[i].velocity = {i == 0 ? 1.0 : 0.0, i == 0 ? 0.0 : 1.0};
        world.add(loaded.system.particles[i], starts[i]);
      }
      Observer silent;
      world.run_until(1.0, silent);
      for (int i = 0; i < 3; ++i) end.push_back(world.state_at(i, Time(1.0)).position);
    }
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector d = end[i] - end[i + 3];
      EXPECT_LT(std::sqrt(dot(d, d)), 1e-12) << trap << i;
    }
  }
}

// Without a time of steps there is none at which groups look around: a mistake of the user's.
TEST(Range, NeedsTheLengthOfAStep) {
  const LoadedSystem loaded = read_system(
      "[[potential]]\nkind = \"harmonic\"\nomega = 1\n[interaction]\nkind = \"yukawa\"\nstrength = "
      "1\nrange = 0.5\n"
      "[particles]\ncount = 2\nspeed = 1\n[initial]\nkind = \"list\"\nstarts = [[0, 0, 1, 0], [1, "
      "0, 1, 0]]\n"
      "[integrator]\nscheme = \"arkode\"\n[run]\nt_max = 1\n",
      "arkode");
  try {
    World world(*loaded.system.table, loaded.system.dynamics);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.place().key, "integrator.step");
  }
}

// A particle that is injected into a group that moves.
TEST(Range, LateParticlesJoin) {
  const LoadedSystem loaded = read_system(
      "[table]\nshape = \"circle\"\nradius = 1\n[interaction]\nkind = \"coulomb\"\nstrength = "
      "0.1\n[particles]\ncount = "
      "3\n[integrator]\nstep = 0.001\n[run]\nt_max = 3\n",
      "late");
  const System& system = loaded.system;
  World world(*system.table, system.dynamics);
  std::vector<State> starts(3);
  starts[0].position = {-0.5, 0.0};
  starts[1].position = {0.5, 0.0};
  starts[2].position = {0.0, 0.5};
  starts[2].time = Time(1.00025);
  for (State& s : starts) s.velocity = {0.6, 0.8};
  for (std::size_t i = 0; i < 3; ++i) world.add(system.particles[i], starts[i]);
  Observer silent;
  world.run_until(1.00025, silent);
  const auto energy = [&](double t) {
    std::vector<State> now;
    for (int i = 0; i < 3; ++i) now.push_back(world.state_at(i, Time(t)));
    return energy_of(system.particles, now, system.dynamics, *system.table).total();
  };
  const double before = energy(1.00025);
  world.run_until(3.0, silent);
  EXPECT_NEAR(energy(3.0), before, 1e-9);
  EXPECT_NE(world.state(2).position, starts[2].position);
}

}  // namespace
}  // namespace carom
