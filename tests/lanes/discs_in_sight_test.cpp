// What the table says that a flight from a disc of a lattice sees, against all discs around it.
#include "lanes/discs_in_sight.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "events/next_hit.hpp"
#include "lanes/make_lane_table.hpp"
#include "random_tables.hpp"

namespace carom {
namespace {

using lanes::LaneTable;
using tests::Dice;
using tests::Vector;

Table lattice_of_discs(Vector first, Vector second, double radius, Vector centre) {
  Table table;
  tests::add_loop(table, {geometry::Circle{centre, radius, false}});
  table.extent = Extent::lattice;
  table.lattice = geometry::make_lattice(first, second, {0, 0});
  return table;
}

/// The entry of a flight of unit speed, as the kernels find it.
std::size_t entry_of(const LaneTable& t, Vector velocity, double aside) {
  const bool steep = std::fabs(velocity.x) < std::fabs(velocity.y);
  const double small = steep ? velocity.x : velocity.y, big = steep ? velocity.y : velocity.x;
  const double quadrant = (steep ? 2.0 : 0.0) + (big < 0.0 ? 1.0 : 0.0);
  const double direction =
      std::nearbyint(small * t.directions_per_unit + (quadrant + 0.5) * LaneTable::sight_directions);
  const double offset = std::nearbyint(aside * t.offsets_per_length + 0.5 * LaneTable::sight_offsets);
  return static_cast<std::size_t>(direction * LaneTable::sight_offsets + offset);
}

struct Cell {
  int first, second;
  friend bool operator==(Cell, Cell) = default;
};
/// The first copy of the disc that a flight cuts, of all within so many cells; and how near to a rim lines
/// come before they end there.
Cell first_cut(const LaneTable& t, Vector velocity, double aside, double& doubt) {
  constexpr int far = 30;
  Cell found{0, 0};
  double first = HUGE_VAL;
  doubt = HUGE_VAL;
  for (int n = -far; n <= far; ++n)
    for (int m = -far; m <= far; ++m) {
      const Vector place{n * t.lattice_x[0] + m * t.lattice_x[1], n * t.lattice_y[0] + m * t.lattice_y[1]};
      const double ahead = dot(velocity, place), side = std::fabs(aside + cross(velocity, place));
      if ((n == 0 && m == 0) || ahead < 0.0 || ahead > first) continue;
      doubt = std::min(doubt, std::fabs(side - t.radius[0]));
      if (side < t.radius[0]) {
        found = {n, m};
        first = ahead;
      }
    }
  return found;
}
Cell cell_in(unsigned seen, int part) {
  return {static_cast<signed char>(seen >> (16 * part)), static_cast<signed char>(seen >> (16 * part + 8))};
}

TEST(DiscsInSight, AreThoseThatFlightsMeet) {
  Dice dice(17);
  long tables = 0, one = 0, two = 0, open = 0;
  for (long k = 0; k < tests::cases(12, 400); ++k) {
    const double size = dice.coin() ? 1.0 : dice.spread(1e-6, 1e6), angle = dice.between(0.9, 2.2);
    const Vector first{size, 0.0},
        second = size * dice.between(0.7, 1.5) * Vector{std::cos(angle), std::sin(angle)};
    // Written by longer vectors, too, and not in the middle of the cell.
    const Vector longer = second + static_cast<double>(dice.whole(-2, 2)) * first;
    const Vector centre = size * Vector{dice.between(-0.03, 0.03), dice.between(-0.03, 0.03)};
    const Table table = lattice_of_discs(first, longer, size * dice.between(0.12, 0.28), centre);
    const HitFinder finder(table);
    if (!lanes::fits(table)) continue;
    LaneTable t = lanes::make_lane_table(finder);
    const auto entries = lanes::discs_in_sight(t);
    if (entries.empty()) continue;
    ++tables;
    ASSERT_EQ(t.sights, entries.data());
    for (int i = 0; i < 3000; ++i) {
      Vector velocity = dice.direction();
      velocity = (1.0 / std::sqrt(dot(velocity, velocity))) * velocity;
      const double aside = t.radius[0] * dice.between(-1.0, 1.0);
      const unsigned seen = entries[entry_of(t, velocity, aside)];
      if (seen == LaneTable::open_sight) {
        ++open;
        continue;
      }
      double doubt = 0.0;
      const Cell met = first_cut(t, velocity, aside, doubt);
      if (doubt < 1e-9 * size) continue;
      const Cell near = cell_in(seen, 0), then = cell_in(seen, 1);
      ++(near == then ? one : two);
      const Vector place{near.first * t.lattice_x[0] + near.second * t.lattice_x[1],
                         near.first * t.lattice_y[0] + near.second * t.lattice_y[1]};
      const bool cuts = std::fabs(aside + cross(velocity, place)) < t.radius[0];
      ASSERT_EQ(cuts ? near : then, met) << k << ": " << velocity.x << " " << velocity.y << " " << aside;
    }
  }
  EXPECT_GT(tables, 5);
  EXPECT_GT(one, 1000);
  EXPECT_GT(two, 1000);
  EXPECT_LT(open, (one + two) / 20);
}

// The finite horizon of a triangular lattice leaves nothing far away; among small discs a table would be open
// almost everywhere.
TEST(DiscsInSight, AreLookedUpWhereThatIsWorthWhile) {
  const Vector first{1, 0}, second{0.5, std::sqrt(0.75)};
  for (const double radius : {0.45, 0.02}) {
    const Table table = lattice_of_discs(first, second, radius, {0, 0});
    const HitFinder finder(table);
    LaneTable t = lanes::make_lane_table(finder);
    EXPECT_EQ(lanes::discs_in_sight(t).empty(), radius == 0.02);
    EXPECT_EQ(t.sights == nullptr, radius == 0.02);
  }
}

}  // namespace
}  // namespace carom
