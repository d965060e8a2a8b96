// Points that a step put far away are brought back into the cell about the centre, and the cells
// are counted.
#include <gtest/gtest.h>

#include <cmath>

#include "carom/geometry/lattice.hpp"
#include "events/step/group.hpp"

namespace carom {

using namespace events;

namespace {

using geometry::Cell;
using geometry::Vector;

TEST(Fold, ComesBackFromAnyDistance) {
  const geometry::Lattice lattice = geometry::make_lattice({1, 0}, {0.5, 0.875}, {0, 0});
  const Vector centre = centre_of_cell(lattice), inside = centre + Vector{0.125, -0.0625};
  for (const std::int64_t far : {0LL, 1LL, 3LL, 70LL, 1000LL, 123456789LL, 1LL << 40})
    for (const Cell away : {Cell{far, 0}, Cell{-far, far / 3}, Cell{far / 7, -far}}) {
      Vector x = inside + lattice.translation(away);
      Cell cell{5, -2};
      fold_towards_centre(lattice, centre, x, cell);
      EXPECT_NEAR(x.x, inside.x, 1e-3) << far;
      EXPECT_NEAR(x.y, inside.y, 1e-3) << far;
      EXPECT_EQ(cell, (Cell{5 + away.first, -2 + away.second})) << far;
    }
}

TEST(Fold, FarPositionsStayFinite) {
  const geometry::Lattice lattice = geometry::make_lattice({1, 0}, {0, 1}, {0, 0});
  for (const double far : {1e16, 1e29, 1e150}) {
    Vector x{far, -far};
    Cell cell;
    fold_towards_centre(lattice, centre_of_cell(lattice), x, cell);
    EXPECT_TRUE(std::isfinite(x.x) && std::isfinite(x.y)) << far;
  }
}

}  // namespace
}  // namespace carom
