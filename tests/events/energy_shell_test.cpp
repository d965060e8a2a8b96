// The filter takes |v|^2 as a constant of the motion; its bounds allow for 64u.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "carom/events/world.hpp"
#include "geometry/quad.hpp"
#include "random_tables.hpp"

namespace carom::tests {
namespace {

struct Shell : Observer {
  double square = 1.0;  // as the engine rounds it
  double worst = 0.0;
  long hits = 0;
  void hit(const HitEvent& h) override {
    const QuadVector v = quad(h.after);
    worst = std::max(worst, double(magnitude(dot(v, v) / Quad(square) - Quad(1))));
    ++hits;
  }
};

TEST(EnergyShell, HoldsWithinWhatTheFilterAllows) {
  Table ellipse = loop({Ellipse{{0.1, 0.2}, {0.8, 0.6}, 0.75, true}});
  Dice dice(1);
  for (const Table& table : {stadium(0.5, 1.0), rectangle(1, 1), mushroom(1.0, 0.5, 1.0), ellipse,
                             with_disc(rectangle(1, 1), {0.5, 0.5}, 0.3)}) {
    World world(table);
    Shell shell;
    for (const double omega : {0.0, 0.7, -3.0}) {
      world.clear();
      Particle p;
      p.speed = dice.spread(0.1, 10.0);
      p.omega = omega * p.speed;
      State s;
      s.position = {0.25, 0.125};
      const Vector d = dice.direction();
      s.velocity = p.speed * d;
      shell.square = p.speed * p.speed;
      world.limit_hits(static_cast<std::uint64_t>(cases(100000, 5000000)));
      world.add(p, s);
      world.run_until(1e300, shell);
    }
    std::printf("%zu walls: | |v|^2/s^2 - 1 | <= %.2f u over %ld hits\n", table.walls.size(),
                shell.worst / 0x1p-53, shell.hits);
    EXPECT_LT(shell.worst, 64.0 * 0x1p-53);
    EXPECT_GT(shell.worst, 0.64 * 0x1p-53);
  }
}

}  // namespace
}  // namespace carom::tests
