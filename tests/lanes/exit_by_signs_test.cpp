// Where the sides of the joints tell the exit: all flights from one piece with the same joints on
// their right leave by one piece.
#include "lanes/free/exit_by_signs.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <vector>

#include "carom/events/world.hpp"
#include "carom/geometry/curve.hpp"
#include "carom/lanes/free_lanes.hpp"
#include "events/flight/next_hit.hpp"
#include "lanes/free/make_lane_table.hpp"
#include "lanes/one_by_one.hpp"
#include "random_tables.hpp"

namespace carom {

using events::PieceTable;

namespace {

using lanes::LaneTable;
using tests::Dice;
using tests::Shape;
using tests::Vector;

/// The piece where the scalar engine sees a flight from a wall end; -1 if it is not one.
int exit_of(World& world, const Table& table, const LaneTable& t, int wall, double u,
            Vector velocity) {
  world.clear();
  world.limit_hits(1);
  Particle particle;
  particle.speed = std::sqrt(dot(velocity, velocity));
  State state;
  state.wall = wall;
  state.u = u;
  state.position = geometry::point_at(table.walls[static_cast<std::size_t>(wall)].curve, u);
  state.velocity = velocity;
  world.add(particle, state);
  Observer silent;
  world.run_until(1e300, silent);
  if (world.fate(0) != Fate::capped || !(world.state(0).u > geometry::first_parameter)) return -1;
  return lanes::piece_at(t, world.state(0).wall, world.state(0).u);
}

TEST(ExitBySigns, IsOneForAllFlightsWithTheSameJointsOnTheRight) {
  Dice dice(3);
  long seen = 0, again = 0, told = 0;
  for (long k = 0; k < tests::cases(60, 3000) && !HasFailure(); ++k) {
    const Shape shape = k % 3 == 0 ? Shape::polygon : k % 3 == 1 ? Shape::mushroom : Shape::arcs;
    const Table table = tests::random_table(shape, 1.0, {}, dice, 2.0);
    const PieceTable walls(table);
    const LaneTable t = lanes::make_lane_table(walls);
    if (!t.by_signs) continue;
    ++told;
    World world(table);
    std::map<int, int> exits;
    for (int i = 0; i < 1500; ++i) {
      const int wall = dice.whole(0, static_cast<int>(table.walls.size()) - 1);
      const geometry::Curve& curve = table.walls[static_cast<std::size_t>(wall)].curve;
      const double u = geometry::end_parameter(curve) * dice.between(0.001, 0.999);
      const Vector velocity = dice.direction();
      if (dot(velocity, geometry::normal_at(curve, u)) < 1e-3) continue;
      const int entry = lanes::entry_of(t, lanes::piece_at(t, wall, u),
                                        geometry::point_at(curve, u), velocity, 0x1p-36 * t.size);
      const int exit = exit_of(world, table, t, wall, u, velocity);
      if (entry < 0 || exit < 0) continue;
      const auto [first, is_new] = exits.insert({entry, exit});
      EXPECT_EQ(first->second, exit) << "table " << k << " entry " << entry;
      ++seen;
      again += !is_new;
    }
  }
  EXPECT_GT(told, 10);
  EXPECT_GT(again, seen / 2);
}

TEST(ExitBySigns, IsNotAskedForWhereAnArcBulgesIntoTheDomain) {
  Dice dice(4);
  for (int k = 0; k < 20; ++k) {
    const Table table = tests::random_table(Shape::discs, 1.0, {}, dice);
    EXPECT_FALSE(lanes::make_lane_table(PieceTable(table)).by_signs);
  }
}

// A spike that reaches into the cap of an arc is met by flights that leave and reach that arc, too.
TEST(ExitBySigns, IsNotAskedForWhereAJointLiesInACap) {
  // Three quarters of the unit circle, its opening to the right; from its ends two walls to a tip
  // far inside the disc.
  const double s = std::sqrt(0.5);
  for (const double tip : {-0.5, 2.0}) {
    const Table table =
        tests::loop({tests::CircularArc{{s, s}, {s, -s}, -s, true},
                     tests::Segment{{s, -s}, {tip, 0}}, tests::Segment{{tip, 0}, {s, s}}});
    const LaneTable t = lanes::make_lane_table(PieceTable(table));
    EXPECT_FALSE(t.convex);
    EXPECT_EQ(t.by_signs, tip > s);
  }
}

// A start whose position is not the one of its parameter is flown from the parameter: its exit
// tells nothing of the position's line.
TEST(ExitBySigns, IsNotLearntFromAStartBesideItsPlace) {
  const Table table = tests::mushroom(1.0, 0.3, 0.7);
  Dice dice(5);
  std::vector<LaneStart> starts(300);
  for (std::size_t i = 0; i < starts.size(); ++i) {
    State& s = starts[i].state;
    s.wall = 0;
    s.u = i == 0 ? 0.0 : dice.between(0.01, 0.99) * geometry::end_parameter(table.walls[0].curve);
    s.position = geometry::point_at(table.walls[0].curve, s.u);
    if (i == 0) s.position = {0.25, -0.69};
    const double slope = i == 0 ? 0.75 : dice.between(-2.0, 2.0);
    s.velocity = i == 0 ? Vector{0.6, 0.8} : Vector{slope, 1.0};
    starts[i].particle.speed = std::sqrt(dot(s.velocity, s.velocity));
    starts[i].tag = i;
  }
  FreeLanes lanes(table, {starts[0].particle}, widest_instruction_set());
  lanes.limit_hits(40);
  lanes.run_until(1e300, tests::one_by_one(starts), [&](const LaneEnd& end) {
    World world(table);
    world.limit_hits(40);
    world.add(starts[end.tag].particle, starts[end.tag].state);
    Observer silent;
    world.run_until(1e300, silent);
    EXPECT_EQ(world.state(0).position, end.state.position) << end.tag;
  });
}

}  // namespace
}  // namespace carom
