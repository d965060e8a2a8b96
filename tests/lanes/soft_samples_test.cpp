// Steps in lanes against World: the same bits for every particle, scheme and instruction set.
#include "carom/lanes/soft_lanes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <string>

#include "carom/analyses/diffusion.hpp"
#include "carom/events/world.hpp"
#include "carom/files/system_file.hpp"
#include "carom/integrators/scheme.hpp"
#include "carom/starts/sampler.hpp"
#include "lanes/one_by_one.hpp"

namespace carom {
namespace {

using Settings = std::vector<std::pair<std::string, std::string>>;

System system_of(const std::string& name, const Settings& settings = {}) {
  SystemOverrides overrides;
  overrides.set = settings;
  return load_system(name, overrides).system;
}

/// Above its saddles Hénon–Heiles lets some of the particles run away.
System running_away() {
  System system =
      system_of("henon-heiles",
                {{"particles.energy", "0.18"}, {"run.t_max", "40"}, {"run.trajectories", "40"}});
  system.initial.kind = InitialCondition::Kind::rectangle;
  system.initial.low = {-0.5, -0.5};
  system.initial.high = {0.5, 0.5};
  return system;
}

struct Sampled {
  std::vector<State> samples;
  State end;
};

class Listener : public Observer {
 public:
  void sample(int, Time, const State& state) override { states.push_back(state); }
  std::vector<State> states;
};

Sampled by_world(const System& system, const Particle& particle, const State& start,
                 const std::vector<double>& times) {
  World world(*system.table, system.dynamics);
  world.sample_at(times);
  world.add(particle, start);
  Listener listener;
  world.run_until(times.back(), listener);
  return {listener.states, world.state(0)};
}

void expect_same(const State& a, const State& b, const std::string& where) {
  EXPECT_EQ(std::memcmp(&a.position, &b.position, sizeof a.position), 0) << where;
  EXPECT_EQ(std::memcmp(&a.velocity, &b.velocity, sizeof a.velocity), 0) << where;
  EXPECT_EQ(a.cell, b.cell) << where;
  EXPECT_EQ(a.time.value(), b.time.value()) << where;
}

void compare(const System& system, std::size_t count, const std::string& name) {
  const World world(*system.table, system.dynamics);
  const Sampler sampler(system);
  // At steps, between them, several within one, and at the start.
  const double h = system.dynamics.integrator.step;
  const std::vector<double> times{0.0, 0.3 * h, 0.7 * h, h, 4.0 * h, 11.5 * h, 60.0 * h, 61.25 * h};
  std::vector<LaneStart> starts;
  std::vector<Sampled> expected;
  for (std::size_t k = 0; k < count; ++k) {
    starts.push_back({k, system.particles[0], sampler.draw(world, k, 0), 0});
    expected.push_back(by_world(system, system.particles[0], starts.back().state, times));
  }
  ASSERT_EQ(SoftLanes::hindrance(*system.table, system.dynamics, system.particles), "");
  for (const InstructionSet set : available_instruction_sets()) {
    SoftLanes lanes(*system.table, system.dynamics, system.particles[0], set);
    std::vector<std::size_t> sampled(count, 0);
    lanes.sample_at(times, [&](std::uint64_t tag, std::size_t time, const State& state) {
      EXPECT_EQ(time, sampled[tag]++);
      expect_same(state, expected[tag].samples.at(time), name + " sample " + std::to_string(time));
    });
    std::size_t ends = 0;
    lanes.run_until(times.back(), tests::one_by_one(starts), [&](const LaneEnd& end) {
      EXPECT_EQ(end.fate, Fate::survived);
      EXPECT_EQ(sampled[end.tag], times.size());
      expect_same(end.state, expected[end.tag].end, name + " end " + name_of(set));
      ++ends;
    });
    EXPECT_EQ(ends, count);
  }
}

TEST(SoftLanes, AreTheWorldsBits) {
  compare(system_of("soft-lorentz"), 150, "soft-lorentz");
  compare(system_of("antidot-magnetic"), 70, "antidot-magnetic");
  compare(system_of("soft-lorentz", {{"field.B", "-0.7"}, {"particles.mass", "2.5"}}), 20,
          "heavy in a field");
}

TEST(SoftLanes, KnowEverySplittingScheme) {
  for (const Scheme& scheme : schemes()) {
    const System system = system_of(
        "antidot-magnetic", {{"integrator.scheme", "\"" + std::string(scheme.name) + "\""}});
    if (scheme.form == Scheme::Form::spreiter_walter)
      EXPECT_NE(SoftLanes::hindrance(*system.table, system.dynamics, system.particles), "");
    else
      compare(system, 9, std::string(scheme.name));
  }
}

// Potentials without a formula for many particles, and several at once.
TEST(SoftLanes, KnowEveryPotential) {
  compare(system_of("henon-heiles"), 20, "henon-heiles");
  System system = system_of("soft-lorentz");
  PotentialSpec fermi, gaussian;
  fermi.kind = PotentialSpec::Kind::fermi;
  fermi.radius = 0.2;
  fermi.softness = 0.02;
  fermi.centers = {{0.1, 0.2}, {-0.3, 0.1}};
  gaussian.kind = PotentialSpec::Kind::gaussian;
  gaussian.width = 0.3;
  gaussian.height = -0.4;
  fermi.lattice = gaussian.lattice = true;
  system.dynamics.forces =
      ForceField::build({{fermi, gaussian}, {}}, system.particles, system.table->lattice);
  system.dynamics.everywhere = true;
  system.dynamics.integrator.step = 0.01;
  compare(system, 30, "two lattices");
}

/// A well in a hard stadium, and hard discs among soft bumps.
System among_walls(bool lattice) {
  const std::string table = lattice ? R"(
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
)"
                                    : R"(
[table]
shape = "stadium"
half_length = 0.5
radius = 0.5
[[table.hole]]
wall = "top"
center = 0.5
width = 0.2
[[potential]]
kind = "harmonic"
omega = 1.3
[field]
B = 0.4
)";
  return read_system(table + R"(
[integrator]
step = 0.05
[particles]
speed = 1
[initial]
kind = "uniform"
[run]
t_max = 3
trajectories = 150
)",
                     "among walls")
      .system;
}

TEST(SoftLanes, MeetWallsWithinSteps) { compare(among_walls(true), 150, "discs among bumps"); }

TEST(SoftLanes, RefuseWhatTheyCannotDo) {
  for (const char* name : {"stadium", "coulomb-circle", "wigner"}) {
    const System system = system_of(name);
    EXPECT_NE(SoftLanes::hindrance(*system.table, system.dynamics, system.particles), "") << name;
  }
  const System adaptive = system_of("soft-lorentz", {{"integrator.scheme", "\"arkode\""}});
  EXPECT_NE(SoftLanes::hindrance(*adaptive.table, adaptive.dynamics, adaptive.particles), "");
}

// A particle that runs away to infinity is reported, and the others do not notice.
TEST(SoftLanes, LostParticlesAreReported) {
  const System system = running_away();
  const World world(*system.table, system.dynamics);
  const Sampler sampler(system);
  std::vector<LaneStart> starts;
  for (std::uint64_t k = 0; k < 30; ++k)
    starts.push_back({k, system.particles[0], sampler.draw(world, k, 0), 0});
  SoftLanes lanes(*system.table, system.dynamics, system.particles[0], widest_instruction_set());
  int lost = 0, ends = 0;
  lanes.run_until(40.0, tests::one_by_one(starts), [&](const LaneEnd& end) {
    World alone(*system.table, system.dynamics);
    alone.add(system.particles[0], starts[end.tag].state);
    alone.run_until(40.0);
    EXPECT_EQ(end.fate, alone.fate(0));
    EXPECT_EQ(end.report, alone.report(0));
    lost += end.fate == Fate::unresolved;
    if (end.fate == Fate::survived) expect_same(end.state, alone.state(0), "survivor");
    ++ends;
  });
  EXPECT_EQ(ends, 30);
  EXPECT_GT(lost, 0);
  EXPECT_LT(lost, 30);
}

// Ensembles: one by one, in lanes of any kind, on any number of threads, in blocks of any size.
TEST(SoftDiffusion, IsTheSameInEveryWay) {
  for (const std::string name :
       {"soft-lorentz", "antidot-magnetic", "discs", "stadium with a hole"}) {
    const bool walls = name == "discs" || name == "stadium with a hole";
    const System system = walls
                              ? among_walls(name == "discs")
                              : system_of(name, {{"run.t_max", "3"}, {"run.trajectories", "150"}});
    DiffusionOptions options;
    options.lanes.reset();
    options.threads = 1;
    const DiffusionResult expected = run_diffusion(system, options);
    EXPECT_FALSE(expected.lanes);
    EXPECT_EQ(expected.survived == 150u, name != "stadium with a hole");
    EXPECT_EQ(expected.collisions > 0, walls);
    const std::vector<MomentPoint> points = DisplacementMoments(expected.sums).points();
    ASSERT_GT(points.back().square.value, 0.0);
    EXPECT_GT(expected.steps.force_evaluations, expected.steps.steps);
    EXPECT_GE(expected.energy_error.largest, expected.energy_error.end);
    EXPECT_GT(expected.energy_error.end, 0.0);
    for (const InstructionSet set : available_instruction_sets())
      for (const int threads : {1, 2})
        for (const std::uint64_t block : {7u, 1024u}) {
          options.lanes = set;
          options.threads = threads;
          options.block = block;
          const DiffusionResult result = run_diffusion(system, options);
          EXPECT_EQ(result.lanes, set);
          EXPECT_TRUE(result.complete);
          EXPECT_EQ(result.digest, expected.digest);
          EXPECT_EQ(result.survived, expected.survived);
          EXPECT_EQ(result.escaped, expected.escaped);
          EXPECT_EQ(result.collisions, expected.collisions);
          EXPECT_EQ(result.energy_change, expected.energy_change);
          EXPECT_EQ(result.energy_error.end, expected.energy_error.end);
          EXPECT_EQ(result.energy_error.largest, expected.energy_error.largest);
          EXPECT_EQ(result.steps.steps, expected.steps.steps);
          EXPECT_EQ(result.steps.force_evaluations, expected.steps.force_evaluations);
          const std::vector<MomentPoint> same = DisplacementMoments(result.sums).points();
          ASSERT_EQ(same.size(), points.size());
          for (std::size_t k = 0; k < points.size(); ++k) {
            EXPECT_EQ(same[k].square.value, points[k].square.value);
            EXPECT_EQ(same[k].square.error, points[k].square.error);
            EXPECT_EQ(same[k].fourth.value, points[k].fourth.value);
          }
        }
  }
}

// Lost particles run one by one, and count as present.
TEST(SoftDiffusion, LostParticlesAreCounted) {
  const System system = system_of(
      "henon-heiles", {{"particles.energy", "3"}, {"run.t_max", "20"}, {"run.trajectories", "40"}});
  DiffusionOptions options;
  options.lanes.reset();
  const DiffusionResult expected = run_diffusion(system, options);
  options.lanes = widest_instruction_set();
  const DiffusionResult result = run_diffusion(system, options);
  EXPECT_GT(expected.unresolved, 0u);
  EXPECT_EQ(result.unresolved, expected.unresolved);
  EXPECT_EQ(result.survived, expected.survived);
  EXPECT_EQ(result.digest, expected.digest);
  EXPECT_EQ(result.reports, expected.reports);
}

}  // namespace
}  // namespace carom
