// Random discs: apart, the same on every machine, refused where there is no room; and tables of
// many walls.
#include <cmath>

#include "spec.hpp"

namespace carom::tests {
namespace {

using geometry::Circle;
using geometry::Vector;

TableSpec random_discs(const std::string& count, const std::string& side,
                       const std::string& radius = "1", const std::string& seed = "1") {
  return shape("random-discs",
               {{"count", count}, {"side", side}, {"radius", radius}, {"seed", seed}});
}

Vector centre(const Table& table, std::size_t disc) {
  return std::get<Circle>(table.walls[disc].curve).centre;
}

TEST(RandomDiscs, AreApartAlsoAcrossTheEdges) {
  const Table table = build_table(random_discs("100", "32"));
  ASSERT_EQ(table.walls.size(), 100u);
  EXPECT_EQ(table.extent, Extent::lattice);
  EXPECT_NEAR(measure(table).area, 1024.0 - 100.0 * 3.141592653589793, 1e-10);
  double nearest = HUGE_VAL;
  for (std::size_t a = 0; a < 100; ++a)
    for (std::size_t b = 0; b < a; ++b) {
      const Vector d = centre(table, a) - centre(table, b);
      const double x = std::fmin(std::fabs(d.x), 32.0 - std::fabs(d.x)),
                   y = std::fmin(std::fabs(d.y), 32.0 - std::fabs(d.y));
      nearest = std::fmin(nearest, std::sqrt(x * x + y * y));
    }
  EXPECT_GT(nearest, 2.0);
  EXPECT_LT(nearest, 2.2);
}

TEST(RandomDiscs, AreAFunctionOfTheSeed) {
  const Table one = build_table(random_discs("100", "32")),
              again = build_table(random_discs("100", "32")),
              other = build_table(random_discs("100", "32", "1", "2"));
  // To the last bit on every machine: products and sums of numbers that Philox draws.
  EXPECT_EQ(centre(one, 0).x, 0x1.fa0cd0009ec47p+4);
  EXPECT_EQ(centre(one, 99).y, 0x1.ff1d8d13429dap+3);
  for (std::size_t k = 0; k < 100; ++k) EXPECT_EQ(centre(one, k), centre(again, k));
  EXPECT_FALSE(centre(one, 0) == centre(other, 0));
  // More discs do not move those before.
  EXPECT_EQ(centre(build_table(random_discs("101", "32")), 99), centre(one, 99));
}

TEST(RandomDiscs, DiscsStayWithinWalls) {
  TableSpec spec = random_discs("30", "16");
  spec.torus = false;
  const Table table = build_table(spec);
  EXPECT_EQ(table.extent, Extent::bounded);
  ASSERT_EQ(table.walls.size(), 34u);
  EXPECT_EQ(table.walls[30].name, "bottom");
}

TEST(RandomDiscs, DiscsNeedRoom) {
  EXPECT_TRUE(is_legal(random_discs("150", "32")));
  EXPECT_EQ(blamed(random_discs("300", "32")), "table.count");
  EXPECT_EQ(blamed(random_discs("2", "4")), "table.radius");
  EXPECT_EQ(blamed(random_discs("0", "32")), "table.count");
  EXPECT_EQ(blamed(random_discs("2.5", "32")), "table.count");
  EXPECT_EQ(blamed(shape("random-discs", {{"side", "32"}, {"radius", "1"}})), "table.count");
}

// A step that grew with the square of the number of walls would take minutes here.
TEST(RandomDiscs, AHundredThousandAreBuilt) {
  EXPECT_EQ(build_table(random_discs("100000", "1022")).walls.size(), 100000u);
}

}  // namespace
}  // namespace carom::tests
