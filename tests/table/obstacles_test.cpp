// [[table.obstacle]]: circles, ellipses and polygons inside every shape and every cell.
#include <numbers>

#include "spec.hpp"

namespace carom::tests {
namespace {

using Shape = ObstacleSpec::Shape;
constexpr double pi = std::numbers::pi;

ObstacleSpec placed(Shape shape, int line) {
  ObstacleSpec o;
  o.shape = shape;
  o.place = Place{"test.toml", line, 1, "table.obstacle"};
  return o;
}
ObstacleSpec disc(const std::string& x, const std::string& y, const std::string& radius,
                  int line = 30) {
  ObstacleSpec o = placed(Shape::circle, line);
  o.center = at(x, y);
  o.radius = exact(radius);
  return o;
}
ObstacleSpec block(const std::vector<std::pair<std::string, std::string>>& points, int line = 30) {
  ObstacleSpec o = placed(Shape::polygon, line);
  for (const auto& [x, y] : points) o.points.push_back(at(x, y));
  return o;
}
TableSpec with(TableSpec spec, std::vector<ObstacleSpec> obstacles) {
  spec.obstacles = std::move(obstacles);
  return spec;
}
TableSpec square() { return shape("rectangle", {{"width", "4"}, {"height", "4"}}); }

InputError error_of(const TableSpec& spec) {
  try {
    build_table(spec);
  } catch (const InputError& error) {
    return error;
  }
  return InputError("no fault");
}

TEST(Obstacles, TakeTheirAreaFromEveryShape) {
  TableSpec triangle = shape("triangle"), path = shape("path");
  triangle.points["points"] = {at("-2", "-2"), at("2", "-2"), at("0", "2")};
  path.loops = {loop(at("-1", "0"), {line_to("1", "0"), arc_to(at("0", "1"), at("-1", "0"))})};
  TableSpec walled = shape("sinai", {{"side", "1"}, {"radius", "0.2"}}), torus = walled;
  walled.torus = false;
  const std::vector<std::pair<TableSpec, ObstacleSpec>> cases{
      {square(), disc("0.2", "0.2", "0.1")},
      {triangle, disc("0", "0", "0.1")},
      {shape("regular", {{"sides", "5"}, {"radius", "1"}}), disc("0", "0.1", "0.1")},
      {shape("circle", {{"radius", "1"}}), disc("0.3", "0", "0.1")},
      {shape("ellipse", {{"a", "2"}, {"b", "1"}}), disc("0.3", "0", "0.1")},
      {shape("annulus", {{"outer", "1"}, {"inner", "0.3"}}), disc("0.6", "0", "0.1")},
      {shape("stadium", {{"half_length", "1"}, {"radius", "1"}}), disc("0.6", "0", "0.1")},
      {shape("mushroom", {{"cap_radius", "1"}, {"stem_width", "1"}, {"stem_height", "1"}}),
       disc("0", "-0.5", "0.1")},
      {shape("lemon", {{"radius", "1"}, {"separation", "1"}}), disc("0", "0", "0.1")},
      {walled, disc("0.15", "0.15", "0.1")},
      {torus, disc("0", "0", "0.1")},  // across the corners of the cell
      {shape("lorentz", {{"spacing", "2"}, {"radius", "0.4"}}), disc("1", "0", "0.1")},
      {path, disc("0", "0.5", "0.1")}};
  for (const auto& [spec, obstacle] : cases) {
    const Table without = build_table(spec), table = build_table(with(spec, {obstacle}));
    ASSERT_EQ(table.walls.size(), without.walls.size() + 1) << spec.shape;
    EXPECT_EQ(table.walls.back().name, "obstacle_1");
    EXPECT_NEAR(measure(table).area, measure(without).area - 0.01 * pi, 1e-14) << spec.shape;
    EXPECT_NEAR(measure(table).perimeter, measure(without).perimeter + 0.2 * pi, 1e-14)
        << spec.shape;
  }
}

TEST(Obstacles, EllipsesLieAtTheirAngle) {
  ObstacleSpec ellipse = placed(Shape::ellipse, 30);
  ellipse.center = at("2", "1");
  ellipse.a = exact("1/4");
  ellipse.b = exact("1/2");
  ellipse.angle = exact("pi/2");
  ellipse.name = "egg";
  const Table table = build_table(with(square(), {ellipse}));
  const auto& egg = std::get<geometry::Ellipse>(table.wall(table.wall_index("egg")).curve);
  EXPECT_EQ(egg.axis, (geometry::Vector{0.0, 0.25}));
  EXPECT_EQ(egg.ratio, 2.0);
  EXPECT_FALSE(egg.counterclockwise);
  EXPECT_NEAR(measure(table).area, 16.0 - pi / 8, 1e-14);
}

// The sides keep their names, whichever way round the corners are listed.
TEST(Obstacles, PolygonsGoEitherWayRound) {
  const Table clockwise =
      build_table(with(square(), {block({{"1", "1"}, {"1", "2"}, {"2", "1"}})}));
  const Table turned = build_table(with(square(), {block({{"1", "1"}, {"2", "1"}, {"1", "2"}})}));
  const auto ends = [](const Table& table, const char* name) {
    const auto& side = std::get<geometry::Segment>(table.wall(table.wall_index(name)).curve);
    return std::pair(side.from, side.to);
  };
  using V = geometry::Vector;
  EXPECT_EQ(ends(clockwise, "obstacle_1_side_1"), std::pair(V(1, 1), V(1, 2)));
  EXPECT_EQ(ends(clockwise, "obstacle_1_side_3"), std::pair(V(2, 1), V(1, 1)));
  EXPECT_EQ(ends(turned, "obstacle_1_side_1"), std::pair(V(2, 1), V(1, 1)));
  EXPECT_EQ(ends(turned, "obstacle_1_side_3"), std::pair(V(1, 1), V(1, 2)));
  EXPECT_EQ(measure(clockwise).area, 15.5);
  EXPECT_EQ(measure(turned).area, 15.5);
}

// The area of the sliver is far below the rounding of the products it is computed from.
TEST(Obstacles, TheWayRoundIsExact) {
  const auto sliver = [](const char* y) {
    return with(square(), {block({{"1.1", "1.1"}, {"3.3", "3.3"}, {"2.2", y}})});
  };
  EXPECT_TRUE(is_legal(sliver("2.2000000000000006")));
  EXPECT_TRUE(is_legal(sliver("2.1999999999999997")));
}

TEST(Obstacles, CarryHoles) {
  TableSpec spec =
      with(square(), {disc("1", "1", "1/2"), block({{"2", "2"}, {"3", "2"}, {"3", "3"}})});
  spec =
      with_hole(with_hole(spec, "obstacle_1", "pi/4", "pi/4"), "obstacle_2_side_2", "1/2", "1/4");
  const Table table = build_table(spec);
  ASSERT_EQ(table.holes.size(), 2U);
  EXPECT_EQ(table.holes[0].wall, table.wall_index("obstacle_1"));
  // Its wall runs down from (3, 3).
  EXPECT_EQ(table.holes[1].from, 0.375);
  EXPECT_EQ(table.holes[1].to, 0.625);
  EXPECT_EQ(error_of(with_hole(spec, "obstacle_3", "0", "1")).place().line, 21);
}

TEST(Obstacles, MustLieInsideAndApart) {
  EXPECT_EQ(error_of(with(square(), {disc("1", "1", "1"), disc("3", "1", "1")})).problem(),
            "no fault");  // cusps
  for (const auto& obstacles : std::vector<std::vector<ObstacleSpec>>{
           {disc("1", "1", "1/2", 7), disc("4", "1", "1/2", 8)},            // across a wall
           {disc("1", "1", "1/2", 7), disc("9", "1", "1/2", 8)},            // outside
           {disc("1", "1", "1/2", 7), disc("1.9", "1", "1/2", 8)},          // across another
           {disc("1", "1", "1/2", 7), disc("1.1", "1", "1/8", 8)},          // within another
           {disc("1", "1", "1/2", 7), disc("3", "1", "0", 8)},              // no size
           {disc("1", "1", "1/2", 7), block({{"2", "2"}, {"3", "2"}}, 8)},  // no polygon
           {disc("1", "1", "1/2", 7),
            block({{"2", "2"}, {"3", "3"}, {"3", "2"}, {"2", "3"}}, 8)}}) {
    const InputError error = error_of(with(square(), obstacles));
    EXPECT_NE(error.problem(), "no fault");
    EXPECT_TRUE(error.place().line == 8 || error.place().key.empty()) << error.what();
  }
  TableSpec torus = shape("sinai", {{"side", "1"}, {"radius", "0.2"}});
  EXPECT_EQ(error_of(with(torus, {disc("0", "0", "0.51", 9)})).place().line, 9);  // its own copy
}

TEST(Obstacles, HaveNamesOfTheirOwn) {
  std::vector<ObstacleSpec> two{disc("1", "1", "1/2", 7), disc("3", "1", "1/2", 8)};
  two[1].name = "obstacle_1";
  EXPECT_EQ(error_of(with(square(), two)).place().line, 8);
}

}  // namespace
}  // namespace carom::tests
