// Walls that bound no region are found with their names and their place.
#include "spec.hpp"

namespace carom::tests {
namespace {

TableSpec polygon(const std::vector<std::pair<std::string, std::string>>& corners) {
  TableSpec spec = shape("polygon");
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const std::string key = "table.points[" + std::to_string(k) + "]";
    const Place place{"test.toml", 3, static_cast<int>(10 + 8 * k), key};
    spec.points["points"].push_back(
        {ExactNumber(corners[k].first, place), ExactNumber(corners[k].second, place)});
  }
  return spec;
}

TableSpec discs(const std::vector<std::pair<std::string, std::string>>& centers,
                const std::string& radius) {
  TableSpec spec = shape("discs", {{"radius", radius}});
  for (const auto& [x, y] : centers) spec.points["centers"].push_back(at(x, y));
  return spec;
}

TEST(Region, SelfCrossingPolygon) {
  const std::string message = fault(polygon({{"0", "0"}, {"1", "1"}, {"1", "0"}, {"0", "1"}}));
  EXPECT_HAS(message, "test.toml, line 3, column ");
  EXPECT_HAS(message, "table.points[");
  EXPECT_HAS(message, "'side_1'");
  EXPECT_HAS(message, "'side_3'");
  EXPECT_HAS(message, "(0.5, 0.5)");
}

TEST(Region, PolygonTheWrongWayRound) {
  EXPECT_NE(fault(polygon({{"0", "0"}, {"0", "1"}, {"1", "0"}})), "no fault");
  EXPECT_EQ(fault(polygon({{"0", "0"}, {"1", "0"}, {"0", "1"}})), "no fault");
}

TEST(Region, PolygonWithASpike) {
  EXPECT_NE(fault(polygon({{"0", "0"}, {"1", "0"}, {"1", "1"}, {"1", "0.5"}})), "no fault");
}

TEST(Region, DiscsMustBeApartOrTouch) {
  EXPECT_HAS(fault(discs({{"0", "0"}, {"1.5", "0"}}, "1")), "'disc_1'");
  EXPECT_EQ(fault(discs({{"0", "0"}, {"2", "0"}}, "1")), "no fault");  // a cusp
  EXPECT_NE(fault(discs({{"0", "0"}, {"0", "0"}}, "1")), "no fault");  // the same twice
  TableSpec inside = discs({{"0", "0"}, {"0.1", "0"}}, "1");
  inside.numbers.clear();
  inside.lists["radii"] = {exact("1"), exact("1/2")};
  EXPECT_NE(fault(inside), "no fault");
}

TEST(Region, DiscsMustBeApartFromTheirImages) {
  TableSpec spec = discs({{"0", "0"}, {"2", "0"}}, "1/2");
  spec.lattice = LatticeSpec{at("4", "0"), at("0", "2"), {}};
  EXPECT_EQ(fault(spec), "no fault");
  spec.lattice =
      LatticeSpec{at("2.5", "0"), at("0", "2"), {}};  // disc_2 and the next disc_1 are 0.5 apart
  EXPECT_NE(fault(spec), "no fault");
  spec.lattice = LatticeSpec{at("4", "0"), at("0", "0.9"), {}};  // each meets its own image
  EXPECT_NE(fault(spec), "no fault");
}

TEST(Region, ObstaclesMustLieInside) {
  TableSpec spec = shape("path");
  spec.loops.push_back(loop(
      at("0", "0"), {line_to("1", "0"), line_to("1", "1"), line_to("0", "1"), line_to("0", "0")}));
  const LoopSpec clockwise =
      loop(at("0.2", "0.2"), {line_to("0.2", "0.4"), line_to("0.4", "0.2"), line_to("0.2", "0.2")});
  spec.loops.push_back(clockwise);
  EXPECT_EQ(fault(spec), "no fault");
  spec.loops[1] = loop(at("2", "2"), {line_to("2", "3"), line_to("3", "2"), line_to("2", "2")});
  EXPECT_NE(fault(spec), "no fault");
  spec.loops[1] =
      loop(at("0.5", "0.5"), {line_to("0.5", "3"), line_to("0.7", "0.5"), line_to("0.5", "0.5")});
  EXPECT_HAS(fault(spec), "test.toml, line 12, column 5: table.loop[0].pieces");
  spec.loops[1] =
      loop(at("0.2", "0.2"), {line_to("0.4", "0.2"), line_to("0.2", "0.4"), line_to("0.2", "0.2")});
  EXPECT_NE(fault(spec), "no fault");  // counter-clockwise within
}

}  // namespace
}  // namespace carom::tests
