// Round tables keep the angular momentum: what rounding does to it has no sign of its own.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "carom/lanes/free_lanes.hpp"
#include "lanes/one_by_one.hpp"
#include "random_tables.hpp"

namespace carom {
namespace {

using tests::Dice;
using tests::Vector;

/// What a hit adds to the size of the angular momentum, in radii times speed: the mean of 64
/// orbits.
double drift(Vector centre, double radius, double speed, std::uint64_t hits, Dice& dice) {
  const Table table = tests::loop({geometry::Circle{centre, radius, true}});
  const geometry::Curve& curve = table.walls[0].curve;
  const auto momentum = [&](const State& s) {
    return std::fabs(cross(s.position - centre, s.velocity));
  };
  std::vector<LaneStart> starts;
  double before = 0.0, after = 0.0;
  while (starts.size() < 64) {
    LaneStart start;
    State& s = start.state;
    s.wall = 0;
    s.u = dice.between(0.001, 0.999) * geometry::end_parameter(curve);
    s.position = geometry::point_at(curve, s.u);
    const Vector way = dice.direction();
    s.velocity = (speed / std::sqrt(dot(way, way))) * way;
    start.particle.speed = speed;
    if (!(dot(centre - s.position, s.velocity) > 0.1 * radius * speed)) continue;
    before += momentum(s);
    starts.push_back(start);
  }
  FreeLanes lanes(table, {starts[0].particle}, widest_instruction_set());
  lanes.limit_hits(hits);
  lanes.run_until(1e300, tests::one_by_one(starts),
                  [&](const LaneEnd& end) { after += momentum(end.state); });
  return (after - before) / (64.0 * static_cast<double>(hits) * radius * speed);
}

TEST(AngularMomentum, HasNoDriftInDiscs) {
  Dice dice(23);
  double largest = 0.0;
  for (int i = 0; i < 90; ++i) {
    const double radius = dice.spread(std::exp(-1.0), std::exp(1.0)),
                 speed = dice.spread(std::exp(-1.0), std::exp(1.0));
    const Vector centre =
        i % 3 == 0 ? Vector{0, 0} : Vector{dice.between(-2, 2), dice.between(-2, 2)};
    const double found = std::fabs(drift(centre, radius, speed, 20000, dice));
    EXPECT_LT(found, 2e-18) << radius << " " << speed << " " << centre.x << " " << centre.y;
    largest = std::max(largest, found);
  }
  std::printf("largest drift: %.1e radius speed a hit\n", largest);
}

}  // namespace
}  // namespace carom
