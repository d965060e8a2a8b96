#include "carom/geometry/quartic.hpp"

#include <gtest/gtest.h>

namespace carom::tests {
namespace {

using namespace geometry;

// Found among random quartics: at the ends of all intervals tried about the root the coefficients'
// errors hide the sign, so the root may lie outside.
TEST(Quartic, UncertainEndsOfAnIntervalDecideNothing) {
  const Quartic<double> f{{-0.00035483, 0.0066212, -0.0738847, 0.191262, 0.880365}};
  const QuarticError error{{0.000100355, 0.000106621, 0.000173885, 0.000291262, 0.000980365}};
  EXPECT_FALSE(rising_roots(f, error, 4, 0.64225188975977088, 1).decided);
  const QuarticError small{{1e-9, 1e-9, 1e-9, 1e-9, 1e-9}};
  const RisingRoots roots = rising_roots(f, small, 4, 0.64225188975977088, 1);
  ASSERT_TRUE(roots.decided);
  EXPECT_EQ(roots.count, 1);
}

}  // namespace
}  // namespace carom::tests
