// Worlds and trajectories of a system.
#include "carom/engines/trajectories.hpp"

#include <gtest/gtest.h>

#include "carom/analyses/escape.hpp"
#include "carom/files/system_file.hpp"
#include "carom/starts/sampler.hpp"

namespace carom {
namespace {

System small(const char* name, std::vector<std::pair<std::string, std::string>> set = {}) {
  SystemOverrides changes;
  changes.set = std::move(set);
  changes.trajectories = "20";
  changes.t_max = "20";
  return load_system(name, changes).system;
}

struct Counter : Observer {
  std::uint64_t hits = 0, ends = 0, survived = 0, samples = 0;
  void hit(const HitEvent& event) override {
    hits += static_cast<std::uint64_t>(event.reflections);
  }
  void sample(int, Time, const State&) override { ++samples; }
  void end(const EndEvent& event) override {
    ++ends;
    survived +=
        event.fate == Fate::survived || event.fate == Fate::pinned || event.fate == Fate::capped;
  }
};

TEST(Trajectories, AreThoseOfAnEnsemble) {
  const std::string injection = "[{hole = \"hole_1\", times = [1, 2]}]";
  for (const System& system :
       {small("magnetic-square"), small("soft-lorentz"), small("wigner", {{"run.t_max", "1"}}),
        small("stadium", {{"run.collisions", "5"}}),
        small("magnetic-square", {{"injection", injection}})}) {
    SCOPED_TRACE(system.name);
    Counter all, first, rest;
    for_each_trajectory(system, {0, 20}, all);
    for_each_trajectory(system, {0, 7}, first);
    for_each_trajectory(system, {7, 20}, rest);
    const EscapeResult expected = run_escape(system);
    EXPECT_EQ(all.hits, expected.counts.collisions);
    EXPECT_EQ(all.ends, expected.counts.trajectories);
    EXPECT_EQ(all.survived, expected.counts.survived);
    EXPECT_EQ(first.hits + rest.hits, all.hits);
  }
}

TEST(Trajectories, AreSampledAsTheSystemSays) {
  Counter counter;
  for_each_trajectory(small("mushroom", {{"run.sample", "5"}, {"table.hole", "[]"}}), {0, 3},
                      counter);
  EXPECT_EQ(counter.samples, 15u);
}

// A world of the table alone would let the particle fly straight on.
TEST(MakeWorld, KnowsTheForces) {
  const System system = small("henon-heiles");
  World world = make_world(system);
  const int particle = world.add(system.particles[0], draw_initial_state(system, world, 0, 0));
  const geometry::Vector before = world.state(particle).velocity;
  world.run_until(1.0);
  EXPECT_FALSE(world.state_at(particle, 1.0).velocity == before);
}

TEST(MakeWorld, KnowsTheCapOnHits) {
  const System system = small("mushroom", {{"run.collisions", "3"}});
  World world = make_world(system);
  const int particle = world.add(system.particles[0], draw_initial_state(system, world, 0, 0));
  world.run_until(100.0);
  EXPECT_EQ(world.hits(particle), 3u);
  EXPECT_EQ(world.fate(particle), Fate::capped);
}

}  // namespace
}  // namespace carom
