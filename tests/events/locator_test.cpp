// Is a point inside? The engine's answers against the exact one for loops.
#include <gtest/gtest.h>

#include "carom/geometry/curve.hpp"
#include "carom/geometry/region.hpp"
#include "events/flight/locator.hpp"
#include "events/flight/next_hit.hpp"
#include "random_tables.hpp"

namespace carom {

using namespace events;

namespace {

using geometry::Vector;
using tests::Dice;
using tests::Shape;

// Points anywhere, on walls, and some last digits beside them and their chords.
TEST(Locators, AgreeWithTheExactRegion) {
  Dice dice(31);
  long inside = 0, surely = 0, near = 0;
  for (const Shape shape : {Shape::polygon, Shape::arcs, Shape::stadium, Shape::mushroom}) {
    for (long k = 0; k < tests::cases(30, 3000) && !HasFailure(); ++k) {
      const double size = dice.coin() ? 1.0 : dice.spread(1e-6, 1e6);
      const Table table = tests::random_table(shape, size, {}, dice);
      geometry::Loop loop;
      for (const Wall& wall : table.walls) loop.push_back({wall.name, wall.curve});
      Locator locator(table);
      const PieceTable pieces(table);
      for (int i = 0; i < 200; ++i) {
        Vector p{dice.between(-2, 2) * size, dice.between(-2, 2) * size};
        if (dice.coin()) {
          const auto wall =
              static_cast<std::size_t>(dice.whole(0, static_cast<int>(table.walls.size()) - 1));
          const geometry::Curve& curve = table.walls[wall].curve;
          const double end = geometry::end_parameter(curve);
          const Vector a = geometry::point_at(curve, 0.0),
                       b = geometry::point_at(curve, 0.999999 * end);
          p = dice.coin() ? geometry::point_at(curve, dice.between(0, 1) * end)
                          : a + dice.between(0, 1) * (b - a);
          for (int n = dice.whole(0, 4); n > 0; --n)
            p.x = std::nextafter(p.x, dice.coin() ? 1e30 : -1e30);
          ++near;
        }
        const bool exactly = geometry::locate(loop, p) > 0;
        EXPECT_EQ(locator.contains(p), exactly) << p.x << " " << p.y;
        const bool known = pieces.surely_inside(p);
        EXPECT_TRUE(exactly || !known) << p.x << " " << p.y;
        inside += exactly;
        surely += known;
      }
    }
  }
  EXPECT_GT(near, 1000);
  EXPECT_GT(surely, 100);
  EXPECT_GT(inside, 300);
}

}  // namespace
}  // namespace carom
