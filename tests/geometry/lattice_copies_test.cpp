// Copies that reach a box: all of them, and no more work than there are.
#include "carom/geometry/lattice_copies.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "carom/geometry/region.hpp"

namespace carom::geometry {
namespace {

Box box_about(Vector c, double width, double height) {
  return {c - Vector{width, height}, c + Vector{width, height}};
}

TEST(LatticeCopies, AreThoseOfATryAtAllCells) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  for (int n = 0; n < 300; ++n) {
    const Vector a{number(random), number(random)}, b{number(random), number(random)};
    if (std::fabs(cross(a, b)) < 0.2) continue;
    const Lattice lattice = make_lattice(a, b + (n % 5 - 2.0) * a, {0.0, 0.0});
    const Box moving = box_about({number(random), number(random)}, std::fabs(number(random)),
                                 std::fabs(number(random)));
    const Box fixed = box_about({number(random), number(random)}, 1.0, std::fabs(number(random)));
    std::vector<Cell> expected;
    for (std::int64_t i = -150; i <= 150; ++i)
      for (std::int64_t j = -150; j <= 150; ++j) {
        const Vector t = lattice.translation({i, j}), low = moving.low + t, high = moving.high + t;
        if (low.x <= fixed.high.x && fixed.low.x <= high.x && low.y <= fixed.high.y &&
            fixed.low.y <= high.y)
          expected.push_back({i, j});
      }
    const auto found = cells_that_reach(lattice, moving, fixed, 100000);
    ASSERT_TRUE(found);
    EXPECT_EQ(*found, expected) << n;
    if (expected.size() > 1) {
      EXPECT_FALSE(cells_that_reach(lattice, moving, fixed, expected.size() - 1));
      EXPECT_TRUE(cells_that_reach(lattice, moving, fixed, expected.size()));
    }
  }
}

TEST(LatticeCopies, AreFoundHoweverTheLatticeIsWritten) {
  const Box small = box_about({0.1, 0.2}, 0.4, 0.4), cell = box_about({0.0, 0.0}, 0.5, 0.5);
  for (const Lattice& l : {make_lattice({1.0, 0.0}, {1e6 + 0.25, 1.0}, {0.0, 0.0}),
                           make_lattice({0x1p30, 1.0}, {0x1p30 + 1.0, 1.0}, {0.0, 0.0}),
                           make_lattice({1.0, 0.0}, {0.0, 1e9}, {0.0, 0.0})}) {
    const auto found = cells_that_reach(l, small, cell, 100);
    ASSERT_TRUE(found);
    EXPECT_LE(found->size(), 9u);
    EXPECT_TRUE(std::count(found->begin(), found->end(), Cell{}));
  }
}

// Each of these took hours or all memory when copies were counted first.
TEST(LatticeCopies, ObstaclesTooWideForTheirCellAreRefusedAtOnce) {
  const std::vector<Loop> disc = {{{"disc", Circle{{0.0, 0.0}, 0.2, false}}}};
  for (const Lattice& l : {make_lattice({1.0, 0.0}, {0.5, 1e-5}, {0.0, 0.0}),
                           make_lattice({1.0, 1.0}, {1.0, 1.0 + 1e-13}, {0.0, 0.0}),
                           make_lattice({1e-9, 0.0}, {0.0, 1e-9}, {0.0, 0.0})}) {
    const auto faults = check_region(disc, RegionKind::lattice, l, 3);
    ASSERT_FALSE(faults.empty());
    EXPECT_EQ(faults.front().kind, RegionFault::Kind::crossing);
  }
  // Apart from its neighbours, yet spread over many cells.
  const std::vector<Loop> two = {{{"here", Circle{{0.0, 0.0}, 0.2, false}}},
                                 {{"far", Circle{{1e9, 1e9 + 0.5}, 0.2, false}}}};
  const auto faults =
      check_region(two, RegionKind::lattice, make_lattice({1.0, 0.0}, {0.0, 1.0}, {0.0, 0.0}), 3);
  ASSERT_FALSE(faults.empty());
  EXPECT_EQ(faults.front().kind, RegionFault::Kind::crossing) << faults.front().sentence;
}

}  // namespace
}  // namespace carom::geometry
