// The disc that a flight from another one meets, by the table of what it sees, against all discs
// around it.
#include "lanes/free/next_disc_table.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "carom/events/world.hpp"
#include "carom/lanes/free_lanes.hpp"
#include "events/flight/piece_table.hpp"
#include "lanes/free/make_lane_table.hpp"
#include "random_tables.hpp"

namespace carom {

using events::PieceTable;

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
      std::nearbyint(small * t.directions_per_unit + (quadrant + 0.5) * LaneTable::disc_directions);
  const double offset =
      std::nearbyint(aside * t.offsets_per_length + 0.5 * LaneTable::disc_offsets);
  return static_cast<std::size_t>(direction * LaneTable::disc_offsets + offset);
}

struct Cell {
  int first, second;
  friend bool operator==(Cell, Cell) = default;
  friend Cell operator+(Cell a, Cell b) { return {a.first + b.first, a.second + b.second}; }
};
Vector place_of(const LaneTable& t, Cell c) {
  return {c.first * t.lattice_x[0] + c.second * t.lattice_x[1],
          c.first * t.lattice_y[0] + c.second * t.lattice_y[1]};
}

/// The first copy of the disc that a flight cuts, of all within so many cells; and how near to a
/// rim lines come before they end there.
struct FirstCut {
  Cell cell{0, 0};
  double doubt = HUGE_VAL;
};
FirstCut first_cut(const LaneTable& t, Vector velocity, double aside) {
  constexpr int far = 60;
  FirstCut found;
  double first = HUGE_VAL;
  for (int n = -far; n <= far; ++n)
    for (int m = -far; m <= far; ++m) {
      const Vector place = place_of(t, {n, m});
      const double ahead = dot(velocity, place), side = std::fabs(aside + cross(velocity, place));
      if ((n == 0 && m == 0) || ahead < 0.0 || ahead > first) continue;
      found.doubt = std::min(found.doubt, std::fabs(side - t.radius[0]));
      if (side < t.radius[0]) {
        found.cell = {n, m};
        first = ahead;
      }
    }
  return found;
}
Cell cell_in(unsigned seen, int part) {
  return {static_cast<signed char>(seen >> (16 * part)),
          static_cast<signed char>(seen >> (16 * part + 8))};
}

/// The same by the table: the cell, how often it was asked, and how often it named two discs.
struct ByTable {
  Cell cell{0, 0};
  int asked = 0, two = 0;
  bool known = true, ends = true;
};
ByTable by_table(const LaneTable& t, Vector velocity, double aside) {
  ByTable found;
  double side = aside;
  while (found.asked++ < 200) {
    const unsigned seen = t.next_discs[entry_of(t, velocity, side)];
    if (seen == LaneTable::no_discs ||
        std::abs(found.cell.first) + std::abs(found.cell.second) > LaneTable::farthest_cell) {
      found.known = false;
      return found;
    }
    const Cell here = found.cell, near = cell_in(seen, 0), then = cell_in(seen, 1);
    found.two += near == then ? 0 : 1;
    for (const Cell& next : {here + near, here + then}) {
      found.cell = next;
      side = aside + cross(velocity, place_of(t, next));
      if (std::fabs(side) < t.radius[0]) return found;
    }
  }
  found.known = found.ends = false;
  return found;
}

TEST(NextDiscTable, AreThoseThatFlightsMeet) {
  Dice dice(17);
  long tables = 0, one = 0, two = 0, several = 0, unknown = 0, in_thin = 0;
  for (long k = 0; k < tests::cases(12, 400); ++k) {
    const double size = dice.coin() ? 1.0 : dice.spread(1e-6, 1e6), angle = dice.between(0.9, 2.2);
    // Thin cells, too: discs that nearly touch in rows far apart.
    const bool thin = k % 2 == 0;
    const double height = thin ? dice.spread(1.2, 25.0) : dice.between(0.7, 1.5);
    const Vector first{size, 0.0},
        second = size * height * Vector{std::cos(angle), std::sin(angle)};
    // Written by longer vectors, too, and not in the middle of the cell.
    const Vector longer = second + static_cast<double>(dice.whole(-2, 2)) * first;
    const Vector centre = size * Vector{dice.between(-0.03, 0.03), dice.between(-0.03, 0.03)};
    const double radius = thin ? 0.4999 - dice.spread(1e-6, 0.3) : dice.between(0.12, 0.28);
    const Table table = lattice_of_discs(first, longer, size * radius, thin ? Vector{} : centre);
    const PieceTable walls(table);
    if (!lanes::misfit(table).empty()) continue;
    LaneTable t = lanes::make_lane_table(walls);
    const auto entries = lanes::make_next_discs(t);
    if (entries.empty()) continue;
    ++tables;
    ASSERT_EQ(t.next_discs, entries.data());
    for (int i = 0; i < 3000; ++i) {
      // Across the rows, too, where one disc after the other is passed.
      Vector velocity = thin && dice.coin()
                            ? Vector{dice.sign() * dice.spread(1e-4, 0.1), dice.sign()}
                            : dice.direction();
      velocity = (1.0 / std::sqrt(dot(velocity, velocity))) * velocity;
      const double aside = t.radius[0] * dice.between(-1.0, 1.0);
      const FirstCut met = first_cut(t, velocity, aside);
      if (met.doubt < 1e-9 * size || met.cell == Cell{0, 0}) continue;
      const ByTable found = by_table(t, velocity, aside);
      ASSERT_TRUE(found.ends) << k << ": " << velocity.x << " " << velocity.y << " " << aside;
      if (!found.known) {
        ++(thin ? in_thin : unknown);
        continue;
      }
      ++(found.asked > 1 ? several : found.two > 0 ? two : one);
      ASSERT_EQ(found.cell, met.cell)
          << k << ": " << velocity.x << " " << velocity.y << " " << aside;
    }
  }
  EXPECT_GT(tables, 5);
  EXPECT_GT(one, 1000);
  EXPECT_GT(two, 1000);
  EXPECT_GT(several, 300);
  EXPECT_LT(unknown, (one + two) / 1000);
  // Beside a disc that is passed may lie the one that the flight began on.
  EXPECT_LT(in_thin, (one + two) / 15);
  std::printf(
      "%ld tables: %ld flights see one disc, %ld two, %ld ask again; left are %ld, and %ld in thin "
      "cells\n",
      tables, one, two, several, unknown, in_thin);
}

// Discs of one row are passed one after the other: none may name the disc that the flight began on,
// nor each other.
TEST(NextDiscTable, DiscsOfARowLieAhead) {
  struct Case {
    double height, radius, slope, aside;
  };
  for (const Case c : {Case{4.25, 0.48, 0.00169, 0.4732}, Case{12.0, 0.4, 0.008, -0.15}}) {
    const Table table = lattice_of_discs({1, 0}, {0, c.height}, c.radius, {0, 0});
    Vector v{c.slope, 1.0};
    v = (1.0 / std::sqrt(dot(v, v))) * v;
    LaneStart start;
    start.state.wall = 0;
    const PieceTable walls(table);
    const geometry::PreparedCurve& curve = walls.curve(0);
    start.state.u = curve.parameter(std::sqrt(c.radius * c.radius - c.aside * c.aside) * v +
                                    c.aside * Vector{v.y, -v.x});
    start.state.position = geometry::point_at(table.walls[0].curve, start.state.u);
    start.state.velocity = v;
    start.particle.speed = std::sqrt(dot(v, v));
    World world(table);
    Observer none;
    world.limit_hits(1);
    world.add(start.particle, start.state, 0);
    world.run_until(1e3, none);
    for (const InstructionSet set : available_instruction_sets()) {
      FreeLanes lanes(table, {start.particle}, set);
      lanes.limit_hits(1);
      int given = 0, ended = 0, asked = 0;
      lanes.run_until(
          1e3, [&](LaneStart& s) { return s = start, given++ == 0; },
          [&](const LaneEnd& e) {
            ++ended;
            EXPECT_EQ(e.state.cell, world.state(0).cell) << c.height;
            EXPECT_EQ(e.state.position, world.state(0).position) << c.height;
          },
          [&] { return ++asked > 1000; });
      EXPECT_EQ(ended, 1) << c.height;
    }
  }
}

// Few flights ask more than once, be the horizon finite or not. Discs too small for the margins
// have no table.
TEST(NextDiscTable, AreSeenAtOnce) {
  struct Case {
    double height, radius;
    int most;  ///< of 10 000 flights
  };
  Dice dice(18);
  for (const Case c : {Case{std::sqrt(0.75), 0.45, 50}, Case{std::sqrt(0.75), 0.2, 300},
                       Case{1.0, 0.25, 200}, Case{1.0, 0.1, 1500}}) {
    const Table table =
        lattice_of_discs({1, 0}, {c.height < 1.0 ? 0.5 : 0.0, c.height}, c.radius, {0, 0});
    const PieceTable walls(table);
    LaneTable t = lanes::make_lane_table(walls);
    const auto entries = lanes::make_next_discs(t);
    ASSERT_EQ(t.next_discs, entries.data());
    int more = 0;
    for (int i = 0; i < 10000; ++i) {
      const Vector v = dice.direction();
      more +=
          by_table(t, (1.0 / std::sqrt(dot(v, v))) * v, c.radius * dice.between(-1.0, 1.0)).asked >
                  1
              ? 1
              : 0;
    }
    EXPECT_LT(more, c.most) << c.radius;
  }
  const Table table = lattice_of_discs({1, 0}, {0, 1}, 0.002, {0, 0});
  const PieceTable walls(table);
  LaneTable t = lanes::make_lane_table(walls);
  EXPECT_TRUE(lanes::make_next_discs(t).empty());
  EXPECT_EQ(t.next_discs, nullptr);
}

}  // namespace
}  // namespace carom
