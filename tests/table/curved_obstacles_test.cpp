// [[table.obstacle]] of curves: paths, formulas and splines, by the code that makes tables of them.
#include <cmath>
#include <numbers>

#include "spec.hpp"

namespace carom::tests {
namespace {

using Shape = ObstacleSpec::Shape;
constexpr double pi = std::numbers::pi;

ObstacleSpec placed(Shape shape) {
  ObstacleSpec o;
  o.shape = shape;
  o.place = Place{"test.toml", 30, 1, "table.obstacle[0]"};
  return o;
}
ObstacleSpec path_of(ExactPoint start, std::vector<PieceSpec> pieces) {
  ObstacleSpec o = placed(Shape::path);
  o.loop = loop(std::move(start), std::move(pieces));
  return o;
}
ObstacleSpec polar(const std::string& radius, ExactPoint center) {
  ObstacleSpec o = placed(Shape::polar);
  o.radius_formula = {radius, o.place};
  o.center = std::move(center);
  return o;
}
ObstacleSpec parametric(const std::string& x, const std::string& y) {
  ObstacleSpec o = placed(Shape::parametric);
  o.x = {x, o.place};
  o.y = {y, o.place};
  return o;
}
ObstacleSpec spline(std::vector<ExactPoint> points) {
  ObstacleSpec o = placed(Shape::spline);
  o.points = std::move(points);
  return o;
}
PieceSpec bezier(std::vector<ExactPoint> points) {
  PieceSpec piece = line_to("0", "0");
  piece.kind = PieceSpec::Kind::bezier;
  piece.to = points.back();
  points.pop_back();
  piece.control = std::move(points);
  return piece;
}
TableSpec with(TableSpec spec, ObstacleSpec obstacle) {
  spec.obstacles.push_back(std::move(obstacle));
  return spec;
}
TableSpec square() { return shape("rectangle", {{"width", "4"}, {"height", "4"}}); }

/// A half disc of radius 1 about (2, 1), its flat side below.
ObstacleSpec dome(bool clockwise) {
  return clockwise ? path_of(at("1", "1"), {arc_to(at("2", "2"), at("3", "1")), line_to("1", "1")})
                   : path_of(at("1", "1"), {line_to("3", "1"), arc_to(at("2", "2"), at("1", "1"))});
}

TEST(CurvedObstacles, TakeTheirArea) {
  const std::pair<ObstacleSpec, double> cases[] = {
      {dome(true), pi / 2},
      {polar("0.5", at("2", "2")), pi / 4},
      {polar("0.5 + 0.2*cos(3*phi)", at("2", "1")), pi * (0.25 + 0.02)},
      {parametric("2 + cos(t)", "2 + 0.5*sin(t)"), pi / 2},
      // A square with parabolas on two sides, (2/3) of the triangle of their control points each.
      {path_of(at("1", "1"), {bezier({at("2", "0.5"), at("3", "1")}), line_to("3", "2"),
                              bezier({at("2", "3"), at("1", "2")}), line_to("1", "1")}),
       2.0 + 2.0 / 3.0 * 0.5 + 2.0 / 3.0 * 1.0}};
  for (const auto& [obstacle, area] : cases) {
    const Table table = build_table(with(square(), obstacle));
    EXPECT_NEAR(measure(table).area, 16.0 - area, 1e-12);
  }
  const Table table = build_table(with(square(), polar("0.5", at("2", "2"))));
  EXPECT_NEAR(measure(table).perimeter, 16.0 + pi, 1e-12);
  EXPECT_GT(table.curve_errors.distance, 0.0);
}

TEST(CurvedObstacles, RunClockwiseWhicheverWayTheyAreWritten) {
  const Table a = build_table(with(square(), dome(true))),
              b = build_table(with(square(), dome(false)));
  EXPECT_EQ(names_of(a)[4], "obstacle_1_1");
  EXPECT_EQ(names_of(a)[5], "obstacle_1_2");
  EXPECT_EQ(names_of(b)[4], "obstacle_1_2");  // walls keep their names
  EXPECT_EQ(names_of(b)[5], "obstacle_1_1");
  for (int k = 4; k < 6; ++k) {
    const geometry::Curve &one = a.wall(k).curve, &other = b.wall(k).curve;
    EXPECT_EQ(geometry::start_point(one), geometry::start_point(other));
    EXPECT_EQ(geometry::end_point(one), geometry::end_point(other));
    EXPECT_EQ(geometry::length(one), geometry::length(other));
  }
  EXPECT_TRUE(is_legal(with(square(), parametric("2 + cos(t)", "2 + 0.5*sin(t)"))));
  EXPECT_TRUE(is_legal(with(square(), parametric("2 + cos(t)", "2 - 0.5*sin(t)"))));
  EXPECT_TRUE(is_legal(with(square(), spline({at("1", "1"), at("2", "1"), at("2", "2")}))));
  EXPECT_TRUE(is_legal(with(square(), spline({at("2", "2"), at("2", "1"), at("1", "1")}))));
}

TEST(CurvedObstacles, HaveHolesThatRunClockwiseFromTheirStart) {
  const Table table = build_table(
      with_hole(with(square(), polar("0.5", at("2", "2"))), "obstacle_1", "pi/4", "0.2"));
  const Hole &first = table.holes.front(), &last = table.holes.back();
  const geometry::Vector from = geometry::point_at(table.wall(first.wall).curve, first.from),
                         to = geometry::point_at(table.wall(last.wall).curve, last.to);
  EXPECT_NEAR(from.x, 2.0 + 0.5 * std::sin(0.2), 1e-13);
  EXPECT_NEAR(to.x, 2.0 - 0.5 * std::sin(0.2), 1e-13);
  EXPECT_NEAR(from.y, 2.0 - 0.5 * std::cos(0.2), 1e-13);
}

TEST(CurvedObstacles, AreTheTablesCurvesSeenFromOutside) {
  TableSpec inside = shape("polar");
  inside.formulas["radius"] = {"0.5 + 0.2*cos(3*phi)", {}};
  const Table table = build_table(inside),
              outside = build_table(with(square(), polar("0.5 + 0.2*cos(3*phi)", at("2", "2"))));
  const std::size_t n = table.walls.size();
  ASSERT_EQ(outside.walls.size(), n + 4);
  EXPECT_EQ(outside.walls[4].name, "obstacle_1_1");
  for (std::size_t k = 0; k < n; ++k) {
    const auto& a = std::get<geometry::Bezier>(table.walls[n - 1 - k].curve);
    const auto& b = std::get<geometry::Bezier>(outside.walls[k + 4].curve);
    for (int i = 0; i <= a.degree; ++i)
      EXPECT_EQ(b.control(a.degree - i), a.control(i) + (geometry::Vector{2.0, 2.0}));
  }
}

TEST(CurvedObstacles, NamesAreTheirOwnOrCounted) {
  ObstacleSpec one = path_of(at("1", "1"), {bezier({at("3", "1"), at("2", "3"), at("1", "1")})});
  one.name = "drop";
  EXPECT_EQ(names_of(build_table(with(square(), one)))[4], "drop");
  ObstacleSpec two = dome(true);
  two.loop.pieces[0].name = "roof";
  two.name = "house";
  const Table table = build_table(with(square(), two));
  EXPECT_EQ(table.walls[4].name, "roof");
  EXPECT_EQ(table.walls[5].name, "house_2");
}

TEST(CurvedObstacles, FaultsAreAtThePiece) {
  ObstacleSpec open = path_of(at("1", "1"), {line_to("2", "1"), line_to("2", "2")});
  open.loop.pieces[1].place = Place{"test.toml", 33, 4, "table.obstacle[0].pieces[1]"};
  EXPECT_EQ(fault(with(square(), open)).place().line, 33);
  // A side that sticks out of the table.
  ObstacleSpec out =
      path_of(at("1", "1"), {line_to("1", "2"), line_to("5", "1.5"), line_to("1", "1")});
  out.loop.pieces[0].place = Place{"test.toml", 31, 4, "table.obstacle[0].pieces[0]"};
  out.loop.pieces[1].place = Place{"test.toml", 32, 4, "table.obstacle[0].pieces[1]"};
  out.loop.pieces[2].place = Place{"test.toml", 33, 4, "table.obstacle[0].pieces[2]"};
  const int line = fault(with(square(), out)).place().line;
  EXPECT_TRUE(line == 32 || line == 33) << line;
  EXPECT_EQ(fault(with(square(), polar("cos(phi)", at("2", "2")))).place().line, 30);
  EXPECT_EQ(fault(with(square(), spline({at("1", "1"), at("2", "2")}))).place().line, 30);
  EXPECT_FALSE(is_legal(with(square(), polar("0.5 + phi", at("2", "2")))));
}

TEST(CurvedObstacles, StandInCellsAndInTheOpenPlane) {
  for (const char* around : {"lorentz", "plane"}) {
    const bool plane = std::string(around) == "plane";
    TableSpec spec = plane ? shape("plane") : shape(around, {{"spacing", "4"}, {"radius", "0.5"}});
    const ObstacleSpec drop = polar("0.3 + 0.05*cos(2*phi)", at("1.5", "0"));
    const Table table = build_table(with(spec, drop));
    EXPECT_EQ(table.extent, plane ? Extent::open_plane : Extent::lattice);
    if (plane) spec.lattice = LatticeSpec{at("1", "0"), at("0", "1"), {}};
    const Table cell = build_table(with(spec, drop));
    ASSERT_TRUE(cell.lattice);
    const double disc = plane ? 0.0 : pi / 4, area = plane ? 1.0 : 16.0 * std::numbers::sqrt3 / 2;
    EXPECT_NEAR(measure(cell).area, area - disc - pi * (0.09 + 0.5 * 0.0025), 1e-12);
  }
}

TEST(CurvedObstacles, CanBeRegions) {
  TableSpec spec = with(square(), dome(false));
  spec.regions.push_back({"obstacle_1_2", {}, 1, 0, ExactNumber("2"), {}, {}, {}});
  spec.regions[0].index = ExactNumber(1.0);
  const Table table = build_table(spec);
  ASSERT_EQ(table.regions.size(), 1u);
  EXPECT_EQ(table.regions[0].count, 2);
}

// A whole circle or ellipse as the outer wall, anywhere.
TEST(Paths, HoldWholeCirclesAndEllipses) {
  TableSpec spec = shape("path");
  LoopSpec rim;
  rim.kind = LoopSpec::Kind::circle;
  rim.center = at("3", "1");
  rim.radius = exact("2");
  rim.name = "rim";
  spec.loops = {rim};
  const Table table = build_table(with(spec, polar("0.5", at("3", "1"))));
  EXPECT_EQ(table.walls[0].name, "rim");
  EXPECT_EQ(table.extent, Extent::bounded);
  EXPECT_NEAR(measure(table).area, 4 * pi - pi / 4, 1e-12);
  rim.kind = LoopSpec::Kind::ellipse;
  rim.a = exact("2");
  rim.b = exact("1");
  rim.angle = exact("pi/6");
  rim.name = "";
  spec.loops = {rim};
  EXPECT_EQ(names_of(build_table(spec)), std::vector<std::string>{"wall_1"});
  EXPECT_NEAR(measure(build_table(spec)).area, 2 * pi, 1e-12);
}

}  // namespace
}  // namespace carom::tests
