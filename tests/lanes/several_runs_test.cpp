// Lanes that run several times, or are stopped on the way.
#include <gtest/gtest.h>

#include <memory>
#include <utility>
#include <vector>

#include "carom/events/world.hpp"
#include "carom/files/system_file.hpp"
#include "carom/geometry/lattice.hpp"
#include "carom/lanes/free_lanes.hpp"
#include "carom/starts/sampler.hpp"
#include "lanes/one_by_one.hpp"
#include "tables_by_hand.hpp"

namespace carom {
namespace {

// A particle that meets no wall is the scalar engine's: it does not keep the report times of a run
// before.
TEST(LaneRuns, ReportWhatIsAskedOfThisRun) {
  const Table table = tests::disc(1.0);
  LaneStart pinned;
  pinned.state.velocity = {1, 0};
  pinned.particle.omega = 10.0;
  FreeLanes lanes(table, {pinned.particle}, widest_instruction_set());
  int reports = 0;
  const auto count = [&](std::uint64_t, std::size_t, const State&) { ++reports; };
  for (const std::vector<double>& times : {std::vector<double>{1.0, 2.0, 9.0}, {}, {3.0}}) {
    lanes.sample_at(times, times.empty() ? FreeLanes::Sampled() : count);
    bool given = false;
    lanes.run_until(
        5.0, [&](LaneStart& start) { return start = pinned, !std::exchange(given, true); },
        [](const LaneEnd&) {});
  }
  EXPECT_EQ(reports, 3);
}

// In a free corridor of a lattice, a flight as long as the run: the question comes up inside it.
TEST(LaneRuns, StopWithinAFlight) {
  Table table;
  tests::add_loop(table, {geometry::Circle{{0, 0}, 0.25, false}});
  table.extent = Extent::lattice;
  table.lattice = geometry::make_lattice({1, 0}, {0, 1}, {0, 0});
  LaneStart corridor;
  corridor.state.position = {0.1, 0.4};
  corridor.state.velocity = {1, 0};
  FreeLanes lanes(table, {corridor.particle}, widest_instruction_set());
  int asked = 0, ended = 0;
  lanes.run_until(
      1e12, [&](LaneStart& start) { return start = corridor, true; },
      [&](const LaneEnd&) { ++ended; }, [&] { return ++asked > 10; });
  EXPECT_EQ(asked, 11);
  EXPECT_EQ(ended, 0);
}

TEST(LaneRuns, GoOnFromWhereTheyWereStopped) {
  System system = load_system("stadium").system;
  system.table = std::make_shared<const Table>(tests::stadium());  // without its hole
  const Sampler sampler(system);
  World world(*system.table);
  std::vector<LaneStart> starts;
  for (std::uint64_t i = 0; i < 100; ++i)
    starts.push_back({i, system.particles[0], sampler.draw(world, i, 0), 0});
  const std::vector<LaneStart> first = starts;
  FreeLanes lanes(*system.table, system.particles, widest_instruction_set());
  for (std::uint64_t limit = 10; limit <= 50; limit += 10) {
    lanes.limit_hits(limit);
    const std::vector<LaneStart> from = starts;
    lanes.run_until(1e300, tests::one_by_one(from), [&](const LaneEnd& end) {
      starts[end.tag].state = end.state;
      starts[end.tag].hits = end.hits;
    });
  }
  world.limit_hits(50);
  for (std::size_t i = 0; i < starts.size(); ++i) {
    world.clear();
    world.add(first[i].particle, first[i].state);
    world.run_until(1e300);
    EXPECT_EQ(world.state(0).position, starts[i].state.position);
    EXPECT_EQ(world.state(0).velocity, starts[i].state.velocity);
    EXPECT_EQ(starts[i].hits, 50u);
  }
}

}  // namespace
}  // namespace carom
