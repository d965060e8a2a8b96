// The symmetries of tables.
#include "orbits/symmetry.hpp"

#include <gtest/gtest.h>

#include <set>

#include "carom/table/make.hpp"

namespace carom::orbits {
namespace {

std::size_t order_of(const MadeTable& table) {
  const Boundary boundary(*table.table, {});
  const std::vector<Isometry> maps = isometries(boundary);
  for (const Isometry& map : maps)  // permutations of the walls
    EXPECT_EQ(std::set<int>(map.walls.begin(), map.walls.end()).size(), boundary.frames.size());
  return maps.size();
}

TEST(Symmetry, GroupsHaveTheirOrders) {
  EXPECT_EQ(order_of(rectangle(1.0, 1.0)), 8U);
  EXPECT_EQ(order_of(rectangle(2.0, 1.0)), 4U);
  EXPECT_EQ(order_of(regular_polygon(7, 1.0)), 14U);
  EXPECT_EQ(order_of(ellipse(1.0, "3/4"_exact)), 4U);
  EXPECT_EQ(order_of(stadium(1.0, 1.0)), 4U);
  EXPECT_EQ(order_of(lemon(1.0, 0.5)), 4U);
  EXPECT_EQ(order_of(mushroom(1.0, 0.5, 1.0)), 2U);
  EXPECT_EQ(order_of(sinai(1.0, "1/3"_exact, false)), 8U);
  EXPECT_EQ(order_of(polygon({{0.0, 0.0}, {2.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}})), 1U);
  EXPECT_EQ(order_of(annulus(2.0, 1.0, 0.5)), 2U);
  EXPECT_EQ(order_of(discs({{0.0, 0.0}, {6.0, 0.0}, {3.0, "3*sqrt(3)"_exact}}, 1.0)), 6U);
  EXPECT_EQ(order_of(discs({{0.0, 0.0}, {6.0, 0.0}, {3.0, 5.0}}, 1.0)), 2U);
}

TEST(Symmetry, KnowsLattices) {
  EXPECT_EQ(order_of(sinai(1.0, "1/3"_exact)), 8U);
  EXPECT_EQ(order_of(lorentz(2.2, 1.0)), 12U);
  EXPECT_EQ(order_of(discs({{0.0, 0.0}}, 0.25).lattice({2.0, 0.0}, {0.0, 1.0})), 4U);
  EXPECT_EQ(order_of(discs({{0.0, 0.0}}, 0.25).lattice({2.0, 0.0}, {"1/4"_exact, 1.0})), 2U);
}

TEST(Symmetry, NeedsMoreThanEqualWalls) {
  // A pinwheel of equal discs: turned, but not mirrored.
  EXPECT_EQ(order_of(rectangle(4.0, 4.0)
                         .obstacle(disc({1.0, 0.75}, 0.25))
                         .obstacle(disc({3.25, 1.0}, 0.25))
                         .obstacle(disc({3.0, 3.25}, 0.25))
                         .obstacle(disc({0.75, 3.0}, 0.25))),
            4U);
}

}  // namespace
}  // namespace carom::orbits
