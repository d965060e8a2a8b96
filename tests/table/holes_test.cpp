#include <cmath>

#include "carom/table/hole_names.hpp"
#include "spec.hpp"

namespace carom::tests {
namespace {

const TableSpec square = shape("rectangle", {{"width", "1"}, {"height", "1"}});
const TableSpec circle = shape("circle", {{"radius", "1"}});
const TableSpec ellipse = shape("ellipse", {{"a", "1"}, {"b", "3/4"}});

std::size_t base_of(const Hole& hole) { return static_cast<std::size_t>(hole.wall); }

double length_to(const Table& table, const Hole& hole, double u) {
  const geometry::Curve& curve = table.walls[static_cast<std::size_t>(hole.wall)].curve;
  return geometry::arc_length_at(curve, u);
}

TEST(Holes, LieAtTheirArcLength) {
  const TableSpec tables[] = {
      with_hole(shape("rectangle", {{"width", "3"}, {"height", "1"}}), "top", "1.3", "0.4"),
      with_hole(circle, "circle", "1.3", "0.4"), with_hole(ellipse, "ellipse", "1.3", "0.4"),
      with_hole(shape("stadium", {{"half_length", "1"}, {"radius", "1"}}), "left", "1.3", "0.4"),
      with_hole(shape("sinai", {{"side", "1"}, {"radius", "0.4"}}), "disc", "1.3", "0.4")};
  for (const TableSpec& spec : tables) {
    const Table table = build_table(spec);
    ASSERT_EQ(table.holes.size(), 1u);
    const Hole& hole = table.holes[0];
    EXPECT_EQ(hole.name, "hole_1");
    EXPECT_NEAR(length_to(table, hole, hole.from), 1.1, 1e-15);
    EXPECT_NEAR(length_to(table, hole, hole.to), 1.5, 1e-15);
    EXPECT_EQ(table.walls[static_cast<std::size_t>(hole.wall)].holes, std::vector<int>{0});
  }
}

TEST(Holes, InTwoPiecesHaveOneName) {
  const Table table = build_table(
      with_hole(with_hole(with_hole(circle, "circle", "2", "0.4"), "circle", "0", "0.5"), "circle",
                "3", "0.1"));
  ASSERT_EQ(table.holes.size(), 4u);
  EXPECT_EQ(hole_names(table), (std::vector<std::string>{"hole_1", "hole_2", "hole_3"}));
  EXPECT_EQ(hole_numbers(table), (std::vector<int>{0, 1, 1, 2}));
  EXPECT_TRUE(hole_names(build_table(circle)).empty());
}

TEST(Holes, RunAlongTheWallWithTheDomainOnTheLeft) {
  // The top wall runs to -x: arc length 1/4 is x = 3/4.
  const Table table = build_table(with_hole(square, "top", "1/4", "1/8"));
  const geometry::Curve& top = table.walls[static_cast<std::size_t>(table.wall_index("top"))].curve;
  EXPECT_EQ(geometry::point_at(top, table.holes[0].from), (geometry::Vector{0.8125, 1}));
  // An obstacle's circle runs clockwise from angle 0: a quarter of it ends at the bottom.
  const Table disc = build_table(
      with_hole(shape("sinai", {{"side", "2"}, {"radius", "1/2"}}), "disc", "pi/4", "pi/4"));
  const geometry::Vector middle = geometry::point_at(disc.walls[0].curve, 1.0);
  EXPECT_EQ(middle, (geometry::Vector{1, 0.5}));
}

TEST(Holes, RoundTheirEndsOnce) {
  const Table table =
      build_table(with_hole(with_hole(square, "bottom", "0.1", "0.2"), "bottom", "0.3", "0.2"));
  EXPECT_EQ(table.holes[0].from, 0.0);
  EXPECT_EQ(table.holes[0].to, 0.2);
  EXPECT_EQ(table.holes[1].from, 0.2);  // neighbours share the end, which belongs to the second
  EXPECT_EQ(table.holes[1].to, 0.4);
}

TEST(Holes, MayFillTheirWall) {
  const Table straight = build_table(with_hole(square, "right", "1/2", "1"));
  EXPECT_EQ(straight.holes[0].from, 0.0);
  EXPECT_EQ(straight.holes[0].to, 1.0);
  const Table cap = build_table(with_hole(
      shape("stadium", {{"half_length", "1"}, {"radius", "1/3"}}), "right", "pi/6", "pi/3"));
  EXPECT_EQ(cap.holes[0].from, 0.0);
  EXPECT_EQ(cap.holes[0].to, geometry::end_parameter(cap.walls[1].curve));
  const Table all = build_table(with_hole(circle, "circle", "0", "2*pi"));
  ASSERT_EQ(all.holes.size(), 1u);
  EXPECT_EQ(all.holes[0].from, 0.0);
  EXPECT_EQ(all.holes[0].to, 4.0);
}

/// Lengths of many pieces are sums of rounded numbers, those in a system file are not.
TEST(Holes, MayFillAWholeCurveOrItsHalves) {
  const TableSpec cardioid = shape("cardioid", {{"radius", "1"}});
  const Table all = build_table(with_hole(cardioid, "curve", "4", "8"));
  ASSERT_EQ(all.holes.size(), all.walls.size());
  for (const Hole& hole : all.holes) {
    EXPECT_EQ(hole.from, 0.0);
    EXPECT_EQ(hole.to, geometry::end_parameter(all.walls[base_of(hole)].curve));
  }
  const Table halves =
      build_table(with_hole(with_hole(cardioid, "curve", "2", "4"), "curve", "6", "4"));
  EXPECT_EQ(hole_names(halves).size(), 2u);
  EXPECT_EQ(halves.holes.back().to, geometry::end_parameter(halves.walls.back().curve));
  EXPECT_TRUE(is_legal(with_hole(cardioid, "curve", "8", "0.1")));
  EXPECT_FALSE(is_legal(with_hole(cardioid, "curve", "4", "8.000001")));
  EXPECT_FALSE(is_legal(with_hole(cardioid, "curve", "8.000001", "0.1")));
}

TEST(Holes, WrapPastTheStartOfAClosedCurve) {
  for (const char* center : {"0.1", "2*pi-0.1"}) {
    const Table table = build_table(with_hole(circle, "circle", center, "0.6", "door"));
    ASSERT_EQ(table.holes.size(), 2u);
    EXPECT_EQ(table.holes[0].name, "door");
    EXPECT_EQ(table.holes[1].name, "door");
    EXPECT_EQ(table.hole_index("door"), 0);
    const double width = length_to(table, table.holes[0], table.holes[0].to) -
                         length_to(table, table.holes[0], table.holes[0].from) +
                         length_to(table, table.holes[1], table.holes[1].to) -
                         length_to(table, table.holes[1], table.holes[1].from);
    EXPECT_NEAR(width, 0.6, 1e-14);
    EXPECT_EQ(table.holes[0].to, 4.0);
    EXPECT_EQ(table.holes[1].from, 0.0);
    EXPECT_EQ(table.walls[0].holes, (std::vector<int>{1, 0}));  // in the order of the parameter
  }
}

/// The stretches of the holes, as "wall from to".
std::vector<std::string> parts(const Table& table) {
  std::vector<std::string> all;
  for (const Hole& hole : table.holes)
    all.push_back(table.wall(hole.wall).name + " " +
                  std::to_string(length_to(table, hole, hole.from)) + " " +
                  std::to_string(length_to(table, hole, hole.to)));
  return all;
}

TEST(Holes, RunOnOverWallsThatAreNumbered) {
  const TableSpec hexagon = shape("regular", {{"sides", "6"}, {"radius", "1"}});
  using Parts = std::vector<std::string>;
  const Table across = build_table(with_hole(hexagon, "side", "1.25", "1"));
  EXPECT_EQ(parts(across), (Parts{"side_1 0.750000 1.000000", "side_2 0.000000 0.750000"}));
  EXPECT_EQ(hole_names(across), Parts{"hole_1"});
  EXPECT_EQ(across.holes[1].from, 0.0);
  EXPECT_EQ(parts(build_table(with_hole(hexagon, "side", "0", "2.5"))),
            (Parts{"side_5 0.750000 1.000000", "side_6 0.000000 1.000000",
                   "side_1 0.000000 1.000000", "side_2 0.000000 0.250000"}));
  EXPECT_EQ(build_table(with_hole(hexagon, "side", "3", "6")).holes.size(), 6u);
  EXPECT_EQ(blamed(with_hole(hexagon, "side", "3", "6.1")), "table.hole[0].width");
  EXPECT_EQ(blamed(with_hole(with_hole(hexagon, "side", "1", "1"), "side_2", "0.2", "0.1")),
            "table.hole[1].center");
  // A curve of formulas is its circle's, and an obstacle runs the other way from the same point.
  TableSpec curve = shape("polar");
  curve.formulas["radius"] = {"1", {}};
  const Table table = build_table(with_hole(curve, "curve", "pi/2", "1")),
              round = build_table(with_hole(circle, "circle", "pi/2", "1"));
  const auto ends = [](const Table& t) {
    return std::pair{geometry::point_at(t.wall(t.holes.front().wall).curve, t.holes.front().from),
                     geometry::point_at(t.wall(t.holes.back().wall).curve, t.holes.back().to)};
  };
  EXPECT_GT(table.holes.size(), 2u);
  EXPECT_NEAR(length(ends(table).first - ends(round).first), 0.0, 1e-14);
  EXPECT_NEAR(length(ends(table).second - ends(round).second), 0.0, 1e-14);
}

TEST(WallLaws, AreOfAllWallsOfAName) {
  TableSpec spec = shape("regular", {{"sides", "6"}, {"radius", "1"}});
  spec.laws.push_back({.wall = "side", .specularity = 0.0, .place = {}, .wall_place = {}});
  spec.laws.push_back({.wall = "side_2", .specularity = 0.5, .place = {}, .wall_place = {}});
  const Table table = build_table(spec);
  for (const Wall& wall : table.walls)
    EXPECT_EQ(wall.specularity, wall.name == "side_2" ? 0.5 : 0.0) << wall.name;
}

TEST(Holes, FaultsAreFoundAtTheirPlace) {
  const InputError unknown = fault(with_hole(square, "botom", "1/2", "0.1"));
  EXPECT_EQ(unknown.place().key, "table.hole[0].wall");
  EXPECT_EQ(unknown.place().line, 21);
  EXPECT_EQ(unknown.nearest(), "bottom");
  EXPECT_EQ(blamed(with_hole(square, "top", "1/2", "1.1")), "table.hole[0].width");
  EXPECT_EQ(blamed(with_hole(circle, "circle", "1", "6.3")), "table.hole[0].width");
  EXPECT_EQ(blamed(with_hole(square, "top", "0.05", "0.2")), "table.hole[0].center");
  EXPECT_EQ(blamed(with_hole(square, "top", "0.95", "0.2")), "table.hole[0].center");
  EXPECT_EQ(blamed(with_hole(circle, "circle", "-1", "0.2")), "table.hole[0].center");
  EXPECT_EQ(blamed(with_hole(circle, "circle", "7", "0.2")), "table.hole[0].center");
  for (const char* width : {"0", "-0.1"}) {
    EXPECT_EQ(blamed(with_hole(square, "top", "1/2", width)), "table.hole[0].width");
  }
  EXPECT_EQ(blamed(with_hole(square, "top", "1/2", "1e-20")), "table.hole[0].width");
  const TableSpec overlap =
      with_hole(with_hole(square, "top", "0.5", "0.2", "a"), "top", "0.6", "0.1", "b");
  EXPECT_EQ(blamed(overlap), "table.hole[1].center");
  EXPECT_EQ(blamed(with_hole(with_hole(circle, "circle", "0", "1"), "circle", "6", "0.1")),
            "table.hole[1].center");
  EXPECT_EQ(
      blamed(with_hole(with_hole(square, "top", "0.2", "0.2", "a"), "left", "0.6", "0.1", "a")),
      "table.hole[1]");
  EXPECT_TRUE(is_legal(with_hole(with_hole(square, "top", "0.2", "0.2"), "top", "0.6", "0.1")));
}

}  // namespace
}  // namespace carom::tests
