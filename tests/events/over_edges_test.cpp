// Straight flights among the discs of a lattice: taken over several edges at once or one by one,
// they end alike, to the last bit.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "events/flight/next_hit.hpp"
#include "random_tables.hpp"

namespace carom::tests {

using namespace events;

namespace {

Table lattice_of(Vector first, Vector second, const std::vector<Circle>& discs) {
  Table table;
  for (const Circle& disc : discs) add_loop(table, {disc});
  table.extent = Extent::lattice;
  table.lattice = geometry::make_lattice(first, second, {0, 0});
  return table;
}

/// Flies from the boundary of the first disc both ways; counts the edges that were crossed.
int edges_of_flights(const Table& table, DecisionOptions options, int flights) {
  const PieceTable pieces(table, options);
  EXPECT_TRUE(pieces.discs_within);
  HitFinder at_once(pieces), one_by_one(pieces);
  DecisionCounts counts;
  Dice dice(5);
  int edges = 0;
  for (int i = 0; i < flights; ++i) {
    const geometry::PreparedCurve& disc = pieces.curve(0);
    const double angle = dice.between(-3.1, 3.1), off = dice.between(-1.5, 1.5);
    const double u =
        disc.parameter(disc.centre + std::sqrt(disc.r2) * Vector{std::cos(angle), std::sin(angle)});
    const Vector normal = disc.frame(u).normal;
    const double turned = std::atan2(normal.y, normal.x) + off;
    Flight near;
    near.square_speed = 1.0;
    pieces.begin_on_wall(near, 0, u, disc.point(u), {std::cos(turned), std::sin(turned)});
    Flight far = near;
    Ahead expected, found;
    one_by_one.next(near, expected, counts);
    at_once.next_over_edges(far, found, counts);
    // In a corridor the search ends at an edge.
    for (; expected.kind == Ahead::Kind::edge && !(near.cell == far.cell); ++edges) {
      pieces.cross(near, expected);
      one_by_one.next(near, expected, counts);
    }
    EXPECT_EQ(near.cell, far.cell) << i;
    EXPECT_EQ(near.entry, far.entry) << i;
    EXPECT_EQ(near.start_piece, far.start_piece) << i;
    EXPECT_EQ(expected.kind, found.kind) << i;
    EXPECT_EQ(expected.piece, found.piece) << i;
    EXPECT_EQ(std::bit_cast<std::uint64_t>(expected.kappa),
              std::bit_cast<std::uint64_t>(found.kappa));
    EXPECT_EQ(std::bit_cast<std::uint64_t>(expected.duration),
              std::bit_cast<std::uint64_t>(found.duration));
  }
  return edges;
}

}  // namespace

TEST(OverEdges, AFlightEndsAsEdgeByEdge) {
  const double height = 1.1 * std::sqrt(3.0);
  const Table tables[] = {
      lattice_of({2.2, 0}, {1.1, height}, {{{0, 0}, 1.0, false}}),
      lattice_of({1, 0}, {0, 1}, {{{0, 0}, 0.4, false}}),
      lattice_of({1, 0}, {0, 1}, {{{0.01, -0.02}, 0.001, false}}),  // long corridors
      lattice_of({2, 0.1}, {0.3, 1.5}, {{{-0.4, 0}, 0.3, false}, {{0.4, 0.1}, 0.2, false}})};
  for (const Table& table : tables)
    for (const double inflation : {1.0, 0x1p30, 0x1p45})
      EXPECT_GT(edges_of_flights(table, {inflation, 1000}, 3000), inflation == 0x1p45 ? 0 : 3000);
}

}  // namespace carom::tests
