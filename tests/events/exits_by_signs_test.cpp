// Where the joints on the right of a line tell its exit, orbits are those that exact arithmetic
// decides hit by hit.
#include <gtest/gtest.h>

#include <cmath>

#include "carom/geometry/curve.hpp"
#include "events/flight/piece_table.hpp"
#include "events/recorder.hpp"
#include "random_tables.hpp"

namespace carom::tests {
namespace {

bool told_by_signs(const Table& table) { return events::PieceTable(table).signs.size() > 0; }

/// An orbit from a wall, in a world that knows what those before it saw.
void fly(World& world, const Table& table, int wall, double u, Vector velocity, Recorder& seen) {
  State state;
  state.wall = wall;
  state.u = u;
  state.position = geometry::point_at(table.walls[static_cast<std::size_t>(wall)].curve, u);
  state.velocity = velocity;
  world.clear();
  world.limit_hits(300);
  world.add(particle(0.0, std::sqrt(dot(velocity, velocity))), state);
  world.run_until(1e300, seen);
}

TEST(ExitsBySigns, AreThoseOfExactArithmetic) {
  Dice dice(11);
  long told = 0, decided_exactly = 0;
  for (long k = 0; k < cases(60, 3000) && !HasFailure(); ++k) {
    const Shape shape = k % 3 == 0 ? Shape::polygon : k % 3 == 1 ? Shape::mushroom : Shape::arcs;
    const Table table = random_table(shape, 1.0, {}, dice, 2.0);
    if (!told_by_signs(table)) continue;
    ++told;
    World usual(table), inflated(table, {0x1p30}), exact(table, {1e300});
    for (int i = 0; i < 10; ++i) {
      const int wall = dice.whole(0, static_cast<int>(table.walls.size()) - 1);
      const geometry::Curve& curve = table.walls[static_cast<std::size_t>(wall)].curve;
      const double u = geometry::end_parameter(curve) * dice.between(0.001, 0.999);
      const Vector velocity = dice.direction();
      if (dot(velocity, geometry::normal_at(curve, u)) < 1e-3) continue;
      Recorder seen, wide, right;
      fly(usual, table, wall, u, velocity, seen);
      fly(inflated, table, wall, u, velocity, wide);
      const bool all = i < 2;  // exact arithmetic takes long
      if (all) fly(exact, table, wall, u, velocity, right);
      ASSERT_EQ(seen.hits.size(), wide.hits.size());
      ASSERT_EQ(right.hits.size(), all ? seen.hits.size() : 0);
      for (std::size_t n = 0; n < seen.hits.size(); ++n) {
        ASSERT_EQ(seen.hits[n].u, wide.hits[n].u) << "table " << k << " hit " << n;
        ASSERT_EQ(seen.hits[n].time, wide.hits[n].time);
        if (!all) continue;
        ASSERT_EQ(seen.hits[n].wall, right.hits[n].wall) << "table " << k << " hit " << n;
        ASSERT_EQ(seen.hits[n].u, right.hits[n].u);
        ASSERT_EQ(seen.hits[n].time, right.hits[n].time);
        ASSERT_EQ(seen.hits[n].after, right.hits[n].after);
      }
    }
    decided_exactly += static_cast<long>(usual.decisions().exact);
  }
  EXPECT_GT(told, 20);
  EXPECT_LT(decided_exactly, told);
}

// A spike that reaches into the cap of an arc is met by flights that leave and reach that arc, too;
// joints on the chord of a cap do not count as within it.
TEST(ExitsBySigns, AreNotAskedForWhereAJointLiesInACap) {
  const double s = std::sqrt(0.5);
  for (const double tip : {-0.5, 2.0}) {
    const Table table = loop({CircularArc{{s, s}, {s, -s}, -s, true}, Segment{{s, -s}, {tip, 0}},
                              Segment{{tip, 0}, {s, s}}});
    EXPECT_EQ(told_by_signs(table), tip > s);
  }
  EXPECT_TRUE(told_by_signs(mushroom(1.0, 0.3, 0.7)));
  EXPECT_FALSE(told_by_signs(sinai()));
}

}  // namespace
}  // namespace carom::tests
