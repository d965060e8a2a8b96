// Long loops: the exact stage finds no exit among the pieces that the tree leaves out, and no
// crossing among those that it says are missed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "carom/table/make.hpp"
#include "events/flight/chain_tree.hpp"
#include "events/flight/piece_table.hpp"
#include "random_tables.hpp"

namespace carom::tests {

using namespace events;

namespace {

Table polar(const char* radius) {
  TableSpec spec;
  spec.shape = "polar";
  spec.formulas["radius"] = {radius, {}};
  return build_table(spec);
}

/// Two loops, one within the other, of sides with ends at random distances.
Table stars(int sides) {
  Dice dice(3);
  Table table;
  for (const double size : {1.0, 0.3}) {
    std::vector<Vector> corners;
    for (int i = 0; i < sides; ++i) {
      const double angle = 6.283185307179586 / sides * (size < 1.0 ? -i : i),
                   r = size * dice.between(0.6, 1.0);
      corners.push_back({r * std::cos(angle), r * std::sin(angle)});
    }
    std::vector<Curve> walls;
    for (std::size_t i = 0; i < corners.size(); ++i)
      walls.push_back(Segment{corners[i], corners[(i + 1) % corners.size()]});
    add_loop(table, walls);
  }
  return table;
}

/// From a wall into the domain.
Flight flight_from(const PieceTable& pieces, const Table& table, Dice& dice, int number) {
  Flight f;
  const int wall = static_cast<int>(dice.unit() * static_cast<double>(table.walls.size()));
  const Curve& curve = table.wall(wall).curve;
  const double u = std::max(0x1p-53, dice.unit() * geometry::last_parameter(curve));
  const Vector n = geometry::normal_at(curve, u);
  double sine = dice.between(-1.0, 1.0);
  if (number % 5 == 0) sine = std::copysign(1.0 - std::ldexp(dice.unit(), -number % 30), sine);
  f.velocity = std::sqrt((1.0 - sine) * (1.0 + sine)) * n - sine * geometry::left(n);
  f.omega = number % 2 == 0 ? 0.0 : std::ldexp(number % 4 == 1 ? 1.0 : -1.0, number % 6 - 2);
  f.square_speed = dot(f.velocity, f.velocity);
  pieces.begin_on_wall(f, wall, u, geometry::point_at(curve, u), f.velocity);
  return f;
}

}  // namespace

TEST(ChainTree, LeavesOutNoExit) {
  std::size_t kept_in_all = 0, flights = 0, alone = 0;
  for (const Table& table : {stars(40), polar("1 + 0.5*cos(phi)"), polar("1 + 0.2*sin(3*phi)"),
                             build_table(*carom::cardioid(1).spec)}) {
    const PieceTable pieces(table);
    ASSERT_NE(pieces.tree, nullptr);
    Dice dice(17);
    const int count = static_cast<int>(table.walls.size() < 100 ? cases(100, 2000) : cases(5, 100));
    for (int i = 0; i < count; ++i) {
      const Flight f = flight_from(pieces, table, dice, i);
      DecisionCounts counts;
      const Vector n = geometry::normal_at(table.wall(f.wall).curve, f.u);
      if (pieces.inward(f.wall, f.u, f.velocity, n, counts) != Sign::positive) continue;
      const Origin o = pieces.origin_of(f, 0);
      std::set<int> kept, met;
      std::size_t crossed = 0;
      const auto keep = [&](int piece, bool surely) {
        EXPECT_TRUE(kept.insert(piece).second);
        crossed += surely ? 1 : 0;
      };
      const auto meet = [&](int piece, bool) { EXPECT_TRUE(met.insert(piece).second); };
      if (f.omega == 0.0) {
        pieces.tree->exits_of_line(o.point, f.velocity, o.scale, keep);
        pieces.tree->along_line(o.point, f.velocity, o.scale, meet);
      } else {
        pieces.tree->exits_of_circle(o.point, f.velocity, f.omega, o.scale, keep);
        pieces.tree->along_circle(o.point, f.velocity, f.omega, o.scale, meet);
      }
      for (const auto* some : {&kept, &met}) {
        std::vector<int> left_out;
        for (const int piece : pieces.all())
          if (some->count(piece) == 0) left_out.push_back(piece);
        const geometry::ExactFlight::First first = pieces.exact_flight(f).first(
            left_out, f.cell, f.entry, f.start_piece, f.start_previous);
        EXPECT_EQ(first.kind, geometry::ExactFlight::First::Kind::none) << i << " " << first.piece;
      }
      EXPECT_TRUE(std::includes(met.begin(), met.end(), kept.begin(), kept.end())) << i;
      kept_in_all += kept.size();
      alone += kept.size() == 1 && crossed == 1 ? 1 : 0;
      ++flights;
    }
  }
  EXPECT_LT(kept_in_all, 3 * flights);
  EXPECT_GT(10 * alone, flights);  // nearly all in smooth curves
}

}  // namespace carom::tests
