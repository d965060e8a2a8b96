// Trajectories under forces, among walls and through holes: lanes against World, the same bits for
// every end.
#include "carom/lanes/soft_lanes.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <string>
#include <vector>

#include "carom/events/world.hpp"
#include "carom/files/system_file.hpp"
#include "carom/starts/sampler.hpp"

namespace carom {
namespace {

struct Case {
  const char* name;
  const char* text;  ///< all but [initial] and [run]
  const char* initial = "kind = \"uniform\"";
};
constexpr Case cases[] = {
    {"gravity in a circle with a hole", R"(
[table]
shape = "circle"
radius = 1
[[table.hole]]
wall = "circle"
center = 4.5
width = 0.4
[[potential]]
kind = "linear"
force = [0, -1]
[integrator]
step = 0.07
[particles]
speed = 1.5
)"},
    {"well in a stadium", R"(
[table]
shape = "stadium"
half_length = 1
radius = 1
[[potential]]
kind = "harmonic"
omega = 1
[integrator]
step = 0.1
scheme = "velocity-verlet"
[particles]
speed = 1.5
)"},
    {"Henon-Heiles in a field", R"(
[table]
shape = "circle"
radius = 0.5
[field]
B = 1.5
[[potential]]
kind = "henon-heiles"
[integrator]
step = 0.1
[particles]
speed = 0.7
mass = 1.25
)"},
    {"quartic in a mushroom", R"(
[table]
shape = "mushroom"
cap_radius = 1
stem_width = 1
stem_height = 1
[[table.hole]]
wall = "stem_bottom"
center = 0.5
width = 0.2
[[potential]]
kind = "quartic"
strength = 0.5
center = [0.1, 0.2]
[integrator]
step = 0.05
scheme = "forest-ruth-4"
[particles]
speed = 2
)"},
    {"discs among bumps", R"(
[table]
shape = "lorentz"
lattice = "triangular"
spacing = 1
radius = 0.2
[[potential]]
kind = "fermi"
radius = 0.3
softness = 0.05
height = 0.3
lattice = true
[integrator]
step = 0.05
[particles]
energy = 0.5
)"},
    {"ellipse with a soft core", R"(
[table]
shape = "ellipse"
a = 1.5
b = 1
[[table.hole]]
wall = "ellipse"
center = 3
width = 0.3
[[potential]]
kind = "coulomb"
charge = 0.4
[integrator]
step = 0.05
[particles]
speed = 1
)"},
    {"away from a disc", R"(
[table]
shape = "discs"
centers = [[0, 0], [3, 0]]
radius = 1
[[potential]]
kind = "quartic"
strength = -1
center = [1, 2]
[integrator]
step = 0.05
[particles]
speed = 1
)",
     "kind = \"boundary\""},
};

System system_of(const Case& c, double t_max, const char* initial = nullptr) {
  const std::string text = std::string(c.text) + "[initial]\n" + (initial ? initial : c.initial) +
                           "\n[run]\ntrajectories = 1\nt_max = " + std::to_string(t_max) + "\n";
  return read_system(text, c.name).system;
}

struct End {
  Fate fate;
  std::uint64_t hits;
  int last_wall, hole;
  Time time;
  State state;
  std::string report;
  StepCounts steps;
  double kinetic = 0.0;
};

class LastEnd : public Observer {
 public:
  void end(const EndEvent& event) override { time = event.time; }
  Time time;
};

End by_world(const System& system, const State& start, std::uint64_t limit) {
  World world(*system.table, system.dynamics);
  world.limit_hits(limit);
  world.add(system.particles[0], start);
  LastEnd last;
  world.run_until(system.run.t_max, last);
  return {world.fate(0),
          world.hits(0),
          world.last_wall(0),
          world.hole(0),
          world.finished(0) ? last.time : world.state(0).time,
          world.state(0),
          world.report(0),
          world.step_counts(),
          world.energy_balance(0).kinetic};
}

void expect_same(const End& a, const LaneEnd& b, const std::string& where) {
  EXPECT_EQ(a.fate, b.fate) << where;
  EXPECT_EQ(a.hits, b.hits) << where;
  EXPECT_EQ(a.last_wall, b.last_wall) << where;
  EXPECT_EQ(a.hole, b.hole) << where;
  EXPECT_EQ(a.time, b.time) << where << ' ' << a.time.value() << ' ' << b.time.value();
  EXPECT_EQ(a.state.wall, b.state.wall) << where;
  EXPECT_EQ(a.state.cell, b.state.cell) << where;
  EXPECT_EQ(a.state.time, b.state.time) << where;
  EXPECT_EQ(std::bit_cast<std::uint64_t>(a.state.position.x),
            std::bit_cast<std::uint64_t>(b.state.position.x))
      << where;
  EXPECT_EQ(std::bit_cast<std::uint64_t>(a.state.position.y),
            std::bit_cast<std::uint64_t>(b.state.position.y))
      << where;
  EXPECT_EQ(std::bit_cast<std::uint64_t>(a.state.velocity.x),
            std::bit_cast<std::uint64_t>(b.state.velocity.x))
      << where;
  EXPECT_EQ(std::bit_cast<std::uint64_t>(a.state.velocity.y),
            std::bit_cast<std::uint64_t>(b.state.velocity.y))
      << where;
  EXPECT_EQ(a.report, b.report) << where;
  EXPECT_EQ(a.steps.steps, b.steps.steps) << where;
  EXPECT_EQ(a.steps.force_evaluations, b.steps.force_evaluations) << where;
  EXPECT_EQ(a.kinetic, b.kinetic) << where;
}

/// Returns how many ended in each way.
std::vector<int> compare(const System& system, std::uint64_t count, const std::string& name,
                         std::uint64_t limit = UINT64_MAX) {
  const World world(*system.table, system.dynamics);
  const Sampler sampler(system);
  std::vector<State> starts;
  std::vector<End> expected;
  std::vector<int> fates(static_cast<std::size_t>(last_fate) + 1);
  for (std::uint64_t k = 0; k < count; ++k) {
    starts.push_back(sampler.draw(world, k, 0));
    expected.push_back(by_world(system, starts.back(), limit));
    ++fates[static_cast<std::size_t>(expected.back().fate)];
  }
  EXPECT_EQ(SoftLanes::hindrance(*system.table, system.dynamics, system.particles), "");
  for (const InstructionSet set : available_instruction_sets()) {
    SoftLanes lanes(*system.table, system.dynamics, system.particles[0], set);
    lanes.limit_hits(limit);
    std::size_t next = 0, ended = 0;
    lanes.run_until(
        system.run.t_max,
        [&](LaneStart& start) {
          if (next == starts.size()) return false;
          start = {next, system.particles[0], starts[next], 0};
          ++next;
          return true;
        },
        [&](const LaneEnd& end) {
          expect_same(expected[end.tag], end,
                      name + ' ' + name_of(set) + " trajectory " + std::to_string(end.tag));
          ++ended;
        });
    EXPECT_EQ(ended, count);
    EXPECT_GT(lanes.effort().hits, 0u) << name;
  }
  return fates;
}

TEST(SoftLanes, HasTheEndsOfTheScalarEngine) {
  for (const Case& c : cases) {
    const std::vector<int> fates = compare(system_of(c, 7.3), 100, c.name);
    if (std::string(c.text).find("hole") != std::string::npos) {
      EXPECT_GT(fates[static_cast<std::size_t>(Fate::escaped)], 0) << c.name;
    }
    if (std::string(c.name) == "away from a disc") {
      EXPECT_GT(fates[static_cast<std::size_t>(Fate::unresolved)], 0);
    }
  }
}

// Starts on walls and the number of particles change nothing.
TEST(SoftLanes, ParticlesMayStartOnWalls) {
  for (const std::uint64_t count : {1u, 63u, 65u})
    compare(system_of(cases[0], 3.0, "kind = \"boundary\""), count, "from the boundary");
}

// Ends at a step's end, within the first step, and after a number of hits.
TEST(SoftLanes, EndsWhereItShould) {
  for (const double t_max : {0.01, 0.07, 0.14, 0.15})
    compare(system_of(cases[0], t_max), 130, "early end");
  const std::vector<int> fates = compare(system_of(cases[1], 40.0), 80, "capped", 5);
  EXPECT_GT(fates[static_cast<std::size_t>(Fate::capped)], 40);
  // More steps than are counted.
  compare(system_of(cases[0], 1e14), 70, "capped in endless time", 3);
}

TEST(SoftLanes, RefusesWhatItCannotDo) {
  std::vector<Particle> two(2);
  two[1].mass = 2.0;
  const System well = system_of(cases[1], 1.0);
  EXPECT_NE(SoftLanes::hindrance(*well.table, well.dynamics, two), "");
}

}  // namespace
}  // namespace carom
