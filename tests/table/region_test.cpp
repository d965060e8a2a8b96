// Walls that bound no region are found with their names and their place.
#include "carom/geometry/region.hpp"

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

TEST(Region, ASelfCrossingPolygonIsRefused) {
  const InputError error = fault(polygon({{"0", "0"}, {"1", "1"}, {"1", "0"}, {"0", "1"}}));
  EXPECT_EQ(error.place().line, 3);
  EXPECT_TRUE(error.place().key.starts_with("table.points["));
  for (const char* part : {"'side_1'", "'side_3'", "(0.5, 0.5)"})
    EXPECT_NE(error.problem().find(part), std::string::npos) << error.what();
}

// Its walls are those of the same corners counter-clockwise; each side keeps the name that it has
// in the list.
TEST(Region, AClockwisePolygonIsTurnedRound) {
  const Table table = build_table(polygon({{"0", "0"}, {"0", "1"}, {"3", "0"}}));
  ASSERT_EQ(table.walls.size(), 3u);
  std::vector<geometry::Loop> loops(1);
  for (const Wall& wall : table.walls) loops[0].push_back({wall.name, wall.curve});
  EXPECT_EQ(geometry::area(loops), 1.5);
  const auto end = [&](const char* name, auto point) {
    return point(table.walls[static_cast<std::size_t>(table.wall_index(name))].curve);
  };
  EXPECT_EQ(end("side_1", geometry::start_point), (geometry::Vector{0, 1}));
  EXPECT_EQ(end("side_1", geometry::end_point), (geometry::Vector{0, 0}));
  EXPECT_EQ(end("side_2", geometry::start_point), (geometry::Vector{3, 0}));
  EXPECT_EQ(end("side_3", geometry::start_point), (geometry::Vector{0, 0}));
  const Table given = build_table(polygon({{"0", "0"}, {"3", "0"}, {"0", "1"}}));
  EXPECT_EQ(given.walls[0].name, "side_1");
  EXPECT_EQ(geometry::start_point(given.walls[0].curve), (geometry::Vector{0, 0}));
}

TEST(Region, APolygonWithASpikeIsRefused) {
  EXPECT_FALSE(is_legal(polygon({{"0", "0"}, {"1", "0"}, {"1", "1"}, {"1", "0.5"}})));
}

TEST(Region, DiscsMustBeApartOrTouch) {
  EXPECT_FALSE(is_legal(discs({{"0", "0"}, {"1.5", "0"}}, "1")));
  EXPECT_TRUE(is_legal(discs({{"0", "0"}, {"2", "0"}}, "1")));   // a cusp
  EXPECT_FALSE(is_legal(discs({{"0", "0"}, {"0", "0"}}, "1")));  // the same twice
  TableSpec inside = discs({{"0", "0"}, {"0.1", "0"}}, "1");
  inside.numbers.clear();
  inside.lists["radii"] = {exact("1"), exact("1/2")};
  EXPECT_FALSE(is_legal(inside));
}

TEST(Region, DiscsMustBeApartFromTheirImages) {
  TableSpec spec = discs({{"0", "0"}, {"2", "0"}}, "1/2");
  spec.lattice = LatticeSpec{at("4", "0"), at("0", "2"), {}};
  EXPECT_TRUE(is_legal(spec));
  spec.lattice =
      LatticeSpec{at("2.5", "0"), at("0", "2"), {}};  // disc_2 and the next disc_1 are 0.5 apart
  EXPECT_FALSE(is_legal(spec));
  spec.lattice = LatticeSpec{at("4", "0"), at("0", "0.9"), {}};  // each meets its own image
  EXPECT_FALSE(is_legal(spec));
}

TEST(Region, ObstaclesMustLieInside) {
  TableSpec spec = shape("path");
  spec.loops.push_back(loop(
      at("0", "0"), {line_to("1", "0"), line_to("1", "1"), line_to("0", "1"), line_to("0", "0")}));
  const LoopSpec clockwise =
      loop(at("0.2", "0.2"), {line_to("0.2", "0.4"), line_to("0.4", "0.2"), line_to("0.2", "0.2")});
  spec.loops.push_back(clockwise);
  EXPECT_TRUE(is_legal(spec));
  spec.loops[1] = loop(at("2", "2"), {line_to("2", "3"), line_to("3", "2"), line_to("2", "2")});
  EXPECT_FALSE(is_legal(spec));
  spec.loops[1] =
      loop(at("0.5", "0.5"), {line_to("0.5", "3"), line_to("0.7", "0.5"), line_to("0.5", "0.5")});
  EXPECT_EQ(blamed(spec), "table.loop[0].pieces");
  spec.loops[1] =
      loop(at("0.2", "0.2"), {line_to("0.4", "0.2"), line_to("0.2", "0.4"), line_to("0.2", "0.2")});
  EXPECT_FALSE(is_legal(spec));  // counter-clockwise within
}

}  // namespace
}  // namespace carom::tests
