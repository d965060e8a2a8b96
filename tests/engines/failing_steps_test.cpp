// A particle whose step fails is lost at the start of the step, and has no states within it.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "analyses/systems.hpp"
#include "carom/analyses/diffusion.hpp"
#include "carom/analyses/escape.hpp"
#include "carom/events/world.hpp"
#include "carom/lanes/soft_lanes.hpp"
#include "carom/starts/sampler.hpp"
#include "lanes/one_by_one.hpp"

namespace carom {
namespace {

using geometry::Vector;

/// Above the saddles of Hénon-Heiles: some run away, and their force overflows.
System running_away() {
  return make_system(R"toml(
[particles]
speed = 0.6
[initial]
kind = "rectangle"
min = [-0.3, -0.3]
max = [0.3, 0.3]
[[potential]]
kind = "henon-heiles"
[integrator]
step = 0.05
[run]
t_max = 20
trajectories = 100
times = { from = 0.01, to = 20, count = 50, spacing = "linear" }
)toml");
}

System over_an_edge() {
  return make_system(std::string(defined_in_the_right_half) + R"toml(
[run]
t_max = 5
trajectories = 100
times = { from = 0.003, to = 4.996, count = 50, spacing = "linear" }
)toml");
}

/// Steps that jump over narrow bumps beside the walls: some end outside of them.
System slipping_through() {
  return make_system(R"toml(
[table]
shape = "rectangle"
width = 1
height = 1
[[potential]]
kind = "harmonic"
omega = 0.1
[[potential]]
kind = "gaussian"
height = 5
width = 0.02
centers = [[0.05, 0.05], [0.25, 0.03], [0.5, 0.02], [0.75, 0.05], [0.95, 0.04], [0.04, 0.5], [0.96, 0.5], [0.3, 0.97], [0.7, 0.95]]
[particles]
energy = 1
[integrator]
step = 0.15
unresolved = "count"
[run]
t_max = 20
trajectories = 100
times = { from = 0.01, to = 20, count = 40, spacing = "linear" }
)toml");
}

class Listener : public Observer {
 public:
  void sample(int, Time, const State& state) override { states.push_back(state); }
  void end(const EndEvent& event) override { last = event; }
  std::vector<State> states;
  std::optional<EndEvent> last;
};

/// When each of the first trajectories was lost, if it was.
std::vector<std::optional<Time>> losses(const System& system, std::uint64_t trajectories) {
  const Sampler sampler(system);
  World world(*system.table, system.dynamics);
  std::vector<std::optional<Time>> all;
  for (std::uint64_t k = 0; k < trajectories; ++k) {
    world.clear();
    add_start(world, sampler, k, 0);
    Listener listener;
    world.run_until(system.run.t_max, listener);
    all.emplace_back();
    if (listener.last && listener.last->fate == Fate::unresolved) all.back() = listener.last->time;
  }
  return all;
}

TEST(FailingSteps, AreNotAveraged) {
  for (const System& system : {running_away(), over_an_edge(), slipping_through()}) {
    DiffusionOptions options;
    const DiffusionResult one = run_diffusion(system, options);
    EXPECT_GT(one.unresolved, 10u);
    EXPECT_EQ(one.unresolved + one.survived, system.run.trajectories);
    System as_long = system;
    as_long.run.t_max = system.run.times.back();
    EXPECT_EQ(one.unresolved, run_escape(as_long).counts.unresolved);
    const auto points = DisplacementMoments(one.sums).points();
    EXPECT_EQ(points.back().count, one.survived);
    const auto lost = losses(system, system.run.trajectories);
    for (const MomentPoint& point : points) {
      std::uint64_t there = 0;
      for (const auto& when : lost) there += !when || !(*when < Time(point.t));
      // A particle that runs away is far away before its step fails.
      ASSERT_LE(point.count, there) << point.t;
      ASSERT_GE(point.count + (system.table->walls.empty() ? one.unresolved : 0), there) << point.t;
      ASSERT_EQ(std::isnan(point.square.value), point.count == 0) << point.t;
    }
    for (const InstructionSet set : available_instruction_sets()) {
      options.lanes = set;
      const DiffusionResult lanes = run_diffusion(system, options);
      EXPECT_EQ(lanes.digest, one.digest) << name_of(set);
      EXPECT_EQ(lanes.unresolved, one.unresolved) << name_of(set);
      const auto also = DisplacementMoments(lanes.sums).points();
      for (std::size_t k = 0; k < points.size(); ++k) {
        ASSERT_EQ(also[k].count, points[k].count);
        if (points[k].count == 0) break;
        ASSERT_EQ(also[k].square.value, points[k].square.value);
      }
    }
  }
}

// A run that ends within a step that fails.
TEST(FailingSteps, TheLastStepMayFail) {
  for (const System& system : {running_away(), over_an_edge(), slipping_through()}) {
    const Sampler sampler(system);
    const auto lost = losses(system, 60);
    const double h = system.dynamics.integrator.step;
    int seen = 0;
    for (std::uint64_t k = 0; k < lost.size(); ++k) {
      if (!lost[k] || lost[k]->value() < h) continue;
      ++seen;
      const double from = lost[k]->value();
      const std::vector<double> times{from - 0.3 * h, from, from + 0.3 * h, from + 0.6 * h};
      World world(*system.table, system.dynamics);
      world.sample_at(times);
      add_start(world, sampler, k, 0);
      const std::vector<LaneStart> start{{0, system.particles[0], world.state(0), 0}};
      Listener listener;
      world.run_until(times.back(), listener);
      ASSERT_TRUE(listener.last);
      EXPECT_EQ(listener.last->fate, Fate::unresolved);
      EXPECT_EQ(listener.last->time.value(), from);
      EXPECT_EQ(listener.states.size(), *lost[k] < Time(from) ? 1u : 2u);
      for (const State& s : listener.states)
        EXPECT_TRUE(std::isfinite(dot(s.position, s.position)));
      // The step before it ended inside the table, or on its wall.
      const Vector last = listener.states.back().position;
      EXPECT_TRUE(listener.states.size() < 2 || world.contains(last) ||
                  world.contains(last + 1e-9 * (Vector{0.5, 0.5} - last)))
          << k;

      SoftLanes lanes(*system.table, system.dynamics, system.particles[0],
                      InstructionSet::baseline);
      std::size_t samples = 0;
      lanes.sample_at(times, [&](std::uint64_t, std::size_t, const State&) { ++samples; });
      lanes.run_until(times.back(), tests::one_by_one(start), [&](const LaneEnd& end) {
        EXPECT_EQ(end.fate, Fate::unresolved);
        EXPECT_EQ(end.time.value(), from);
      });
      EXPECT_EQ(samples, listener.states.size());
    }
    EXPECT_GT(seen, 5);
  }
}

}  // namespace
}  // namespace carom
