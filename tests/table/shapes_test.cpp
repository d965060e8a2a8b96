// Every shape: names, areas, perimeters, orientation, joints.
#include <boost/math/special_functions/ellint_2.hpp>
#include <cmath>
#include <functional>
#include <limits>

#include "spec.hpp"

namespace carom::tests {
namespace {

constexpr double pi = 3.141592653589793;
const double infinity = std::numeric_limits<double>::infinity();

struct Case {
  std::string label;
  TableSpec spec;
  std::vector<std::string> walls;
  double area, perimeter;
  std::function<bool(double, double)> inside;  ///< near the walls
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.label; }

TableSpec points(const std::string& name, std::vector<ExactPoint> list) {
  TableSpec spec = shape(name);
  spec.points["points"] = std::move(list);
  return spec;
}

bool in_disc(double x, double y, double r) { return x * x + y * y < r * r; }

TableSpec path_spec() {
  TableSpec spec = shape("path");
  // A D lying on its back: half disc of radius 1 over [-1, 1], below it a box of height 1/2;
  // inside, a small clockwise square.
  spec.loops.push_back(
      loop(at("-1", "-1/2"), {line_to("1", "-1/2", "floor"), line_to("1", "0"),
                              arc_to(at("0", "1"), at("-1", "0")), line_to("-1", "-1/2")}));
  spec.loops.push_back(loop(at("0", "0"), {line_to("0", "1/4"), line_to("1/4", "1/4"),
                                           line_to("1/4", "0"), line_to("0", "0")}));
  return spec;
}

TableSpec half_ellipse() {
  TableSpec spec = shape("path");
  spec.loops.push_back(loop(
      at("-2", "0"), {line_to("2", "0"), ellipse_to(at("0", "1"), at("-2", "0"), "1/2", "0")}));
  return spec;
}

TableSpec closed_sinai() {
  TableSpec spec = shape("sinai", {{"side", "1"}, {"radius", "0.4"}});
  spec.torus = false;
  return spec;
}

TableSpec lorentz(const std::string& lattice, const std::string& spacing,
                  const std::string& radius) {
  TableSpec spec = shape("lorentz", {{"spacing", spacing}, {"radius", radius}});
  spec.words["lattice"] = lattice;
  return spec;
}

TableSpec two_discs() {
  TableSpec spec = shape("discs");
  spec.points["centers"] = {at("0", "0"), at("3", "1")};
  spec.lists["radii"] = {exact("1"), exact("1/2")};
  return spec;
}

TableSpec repeated_discs() {
  TableSpec spec = two_discs();
  spec.lattice = LatticeSpec{at("6", "0"), at("1", "5"), {}};
  return spec;
}

std::vector<Case> cases() {
  const double half = std::acos(0.5);  // lemon: half the angle that an arc subtends
  return {
      {"rectangle",
       shape("rectangle", {{"width", "2"}, {"height", "0.5"}}),
       {"bottom", "right", "top", "left"},
       1.0,
       5.0,
       [](double x, double y) { return x > 0 && x < 2 && y > 0 && y < 0.5; }},
      {"polygon",
       points("polygon",
              {at("0", "0"), at("2", "0"), at("2", "1"), at("1", "1"), at("1", "2"), at("0", "2")}),
       {"side_1", "side_2", "side_3", "side_4", "side_5", "side_6"},
       3.0,
       8.0,
       [](double x, double y) { return x > 0 && y > 0 && x < 2 && y < 2 && (x < 1 || y < 1); }},
      {"triangle",
       points("triangle", {at("0", "0"), at("1", "0"), at("1/2", "sqrt(3)/2")}),
       {"side_1", "side_2", "side_3"},
       std::sqrt(3) / 4,
       3.0,
       [](double x, double y) {
         return y > 0 && y < std::sqrt(3) * x && y < std::sqrt(3) * (1 - x);
       }},
      {"regular",
       shape("regular", {{"sides", "6"}, {"radius", "2"}, {"angle", "pi/6"}}),
       {"side_1", "side_2", "side_3", "side_4", "side_5", "side_6"},
       6 * std::sqrt(3),
       12.0,
       [](double x, double y) {
         return std::fabs(x) < std::sqrt(3) && std::fabs(y) + std::fabs(x) / std::sqrt(3) < 2;
       }},
      {"circle",
       shape("circle", {{"radius", "3/2"}}),
       {"circle"},
       2.25 * pi,
       3 * pi,
       [](double x, double y) { return in_disc(x, y, 1.5); }},
      {"ellipse",
       shape("ellipse", {{"a", "1"}, {"b", "3/4"}}),
       {"ellipse"},
       0.75 * pi,
       4 * boost::math::ellint_2(std::sqrt(7.0) / 4),
       [](double x, double y) { return in_disc(x, y / 0.75, 1); }},
      {"upright ellipse",
       shape("ellipse", {{"a", "1"}, {"b", "2"}}),
       {"ellipse"},
       2 * pi,
       8 * boost::math::ellint_2(std::sqrt(3.0) / 2),
       [](double x, double y) { return in_disc(x, y / 2, 1); }},
      {"annulus",
       shape("annulus", {{"outer", "2"}, {"inner", "1"}, {"offset", "0.5"}}),
       {"outer", "inner"},
       3 * pi,
       6 * pi,
       [](double x, double y) { return in_disc(x, y, 2) && !in_disc(x - 0.5, y, 1); }},
      {"stadium",
       shape("stadium", {{"half_length", "1"}, {"radius", "1/2"}}),
       {"bottom", "right", "top", "left"},
       2 + pi / 4,
       4 + pi,
       [](double x, double y) {
         return std::fabs(x) < 1 ? std::fabs(y) < 0.5 : in_disc(std::fabs(x) - 1, y, 0.5);
       }},
      {"mushroom",
       shape("mushroom", {{"cap_radius", "1"}, {"stem_width", "1"}, {"stem_height", "2"}}),
       {"stem_bottom", "stem_right", "brim_right", "cap", "brim_left", "stem_left"},
       pi / 2 + 2,
       pi + 1 + 1 + 4,
       [](double x, double y) { return y > 0 ? in_disc(x, y, 1) : std::fabs(x) < 0.5 && y > -2; }},
      {"mushroom without brim",
       shape("mushroom", {{"cap_radius", "1/3"}, {"stem_width", "2/3"}, {"stem_height", "2"}}),
       {"stem_bottom", "stem_right", "cap", "stem_left"},
       pi / 18 + 4.0 / 3,
       pi / 3 + 2.0 / 3 + 4,
       [](double x, double y) {
         return y > 0 ? in_disc(x, y, 1 / 3.0) : std::fabs(x) < 1 / 3.0 && y > -2;
       }},
      {"lemon",
       shape("lemon", {{"radius", "1"}, {"separation", "1"}}),
       {"right", "left"},
       2 * half - std::sin(2 * half),
       4 * half,
       [](double x, double y) { return in_disc(x + 0.5, y, 1) && in_disc(x - 0.5, y, 1); }},
      {"sinai",
       closed_sinai(),
       {"disc", "bottom", "right", "top", "left"},
       1 - 0.16 * pi,
       4 + 0.8 * pi,
       [](double x, double y) {
         return x > 0 && x < 1 && y > 0 && y < 1 && !in_disc(x - 0.5, y - 0.5, 0.4);
       }},
      {"sinai torus",
       shape("sinai", {{"side", "1"}, {"radius", "0.4"}}),
       {"disc"},
       1 - 0.16 * pi,
       0.8 * pi,
       [](double x, double y) { return !in_disc(x - 0.5, y - 0.5, 0.4); }},
      {"lorentz triangular",
       lorentz("triangular", "2.2", "1"),
       {"disc_1"},
       std::sqrt(3) / 2 * 2.2 * 2.2 - pi,
       2 * pi,
       [](double x, double y) { return !in_disc(x, y, 1); }},
      {"lorentz square",
       lorentz("square", "1", "1/3"),
       {"disc_1"},
       1 - pi / 9,
       2 * pi / 3,
       [](double x, double y) { return !in_disc(x, y, 1 / 3.0); }},
      {"discs",
       two_discs(),
       {"disc_1", "disc_2"},
       infinity,
       3 * pi,
       [](double x, double y) { return !in_disc(x, y, 1) && !in_disc(x - 3, y - 1, 0.5); }},
      {"discs on a lattice",
       repeated_discs(),
       {"disc_1", "disc_2"},
       30 - 1.25 * pi,
       3 * pi,
       [](double x, double y) { return !in_disc(x, y, 1) && !in_disc(x - 3, y - 1, 0.5); }},
      {"path",
       path_spec(),
       {"floor", "wall_2", "wall_3", "wall_4", "wall_5", "wall_6", "wall_7", "wall_8"},
       pi / 2 + 1 - 1.0 / 16,
       2 + 1 + pi + 1,
       [](double x, double y) {
         const bool box = x >= 0 && x <= 0.25 && y >= 0 && y <= 0.25;
         return !box && (y > 0 ? in_disc(x, y, 1) : std::fabs(x) < 1 && y > -0.5);
       }},
      {"half an ellipse",
       half_ellipse(),
       {"wall_1", "wall_2"},
       pi,
       4 + 4 * boost::math::ellint_2(std::sqrt(3.0) / 2),
       [](double x, double y) { return y > 0 && in_disc(x / 2, y, 1); }},
  };
}

class Shapes : public testing::TestWithParam<Case> {};

TEST_P(Shapes, HasTheWallsOfTheContract) {
  EXPECT_EQ(names_of(build_table(GetParam().spec)), GetParam().walls);
}

TEST_P(Shapes, MeasuresItsClosedForm) {
  const TableMeasure m = measure(build_table(GetParam().spec));
  if (GetParam().area == infinity) {
    EXPECT_EQ(m.area, infinity);
  } else {
    EXPECT_NEAR(m.area, GetParam().area, 1e-14 * GetParam().area);
    EXPECT_NEAR(m.mean_flight, pi * GetParam().area / GetParam().perimeter, 1e-14 * m.mean_flight);
  }
  EXPECT_NEAR(m.perimeter, GetParam().perimeter, 1e-14 * GetParam().perimeter);
}

TEST_P(Shapes, NormalsPointIntoTheDomain) {
  const Table table = build_table(GetParam().spec);
  for (const Wall& wall : table.walls) {
    const double end = geometry::end_parameter(wall.curve);
    for (int k = 0; k < 16; ++k) {
      const double u = end * (k + 0.5) / 16;
      const geometry::Vector p = geometry::point_at(wall.curve, u),
                             n = geometry::normal_at(wall.curve, u);
      const geometry::Vector in = p + 1e-9 * n, out = p - 1e-9 * n;
      EXPECT_TRUE(GetParam().inside(in.x, in.y)) << wall.name << " at " << u;
      EXPECT_FALSE(GetParam().inside(out.x, out.y)) << wall.name << " at " << u;
    }
  }
}

TEST_P(Shapes, JointsAreTheSameDoubles) {
  const Table table = build_table(GetParam().spec);
  for (std::size_t k = 0; k < table.walls.size(); ++k) {
    const Wall& wall = table.walls[k];
    const Wall& next = table.walls[static_cast<std::size_t>(wall.next)];
    EXPECT_EQ(static_cast<std::size_t>(next.previous), k);
    EXPECT_EQ(geometry::end_point(wall.curve), geometry::start_point(next.curve)) << wall.name;
    EXPECT_EQ(geometry::is_closed(wall.curve), wall.next == static_cast<int>(k));
  }
}

std::string label_of(const testing::TestParamInfo<Case>& one) {
  std::string name = one.param.label;
  for (char& c : name) c = c == ' ' ? '_' : c;
  return name;
}
INSTANTIATE_TEST_SUITE_P(All, Shapes, testing::ValuesIn(cases()), label_of);

TEST(Tables, HalfCirclesJoinStraightWallsWithTheirTangent) {
  for (const TableSpec& spec :
       {shape("stadium", {{"half_length", "0.1"}, {"radius", "1/3"}}),
        shape("mushroom",
              {{"cap_radius", "0.7"}, {"stem_width", "1.4"}, {"stem_height", "sqrt(2)"}})}) {
    const Table table = build_table(spec);
    for (const Wall& wall : table.walls) {
      if (!std::holds_alternative<geometry::CircularArc>(wall.curve)) continue;
      EXPECT_EQ(std::get<geometry::CircularArc>(wall.curve).offset, 0.0);
      const Wall& before = table.walls[static_cast<std::size_t>(wall.previous)];
      EXPECT_EQ(geometry::tangent_at(wall.curve, 0.0), geometry::tangent_at(before.curve, 0.5))
          << wall.name;
    }
  }
}

TEST(Tables, RegularPolygonsDeclareTheCornersThatHaveALimit) {
  const int declared[] = {3, 2, 0, 0, 0};
  for (int n = 3; n <= 7; ++n) {
    const Table table =
        build_table(shape("regular", {{"sides", std::to_string(n)}, {"radius", "1"}}));
    for (const Wall& wall : table.walls) EXPECT_EQ(wall.corner, declared[n - 3]) << n;
  }
}

TEST(Tables, RegularPolygonsAreSymmetricToTheLastBit) {
  const Table square =
      build_table(shape("regular", {{"sides", "4"}, {"radius", "1"}, {"angle", "pi/4"}}));
  const geometry::Vector a = geometry::start_point(square.walls[0].curve);
  EXPECT_EQ(a.x, a.y);
  EXPECT_EQ(a.x, std::sqrt(0.5));
  EXPECT_EQ(geometry::start_point(square.walls[2].curve), -a);
  const Table diamond = build_table(shape("regular", {{"sides", "4"}, {"radius", "3"}}));
  EXPECT_EQ(geometry::start_point(diamond.walls[1].curve), (geometry::Vector{0, 3}));
  const Table hexagon = build_table(shape("regular", {{"sides", "6"}, {"radius", "1"}}));
  EXPECT_EQ(geometry::start_point(hexagon.walls[1].curve).x, 0.5);
}

TEST(Tables, EveryNumberIsRoundedOnce) {
  const Table table = build_table(shape("lemon", {{"radius", "sqrt(2)"}, {"separation", "2"}}));
  // h = sqrt(2 - 1) = 1 and offset d/(4h) = 1/2, exactly, although sqrt(2) is not a double.
  const auto& right = std::get<geometry::CircularArc>(table.walls[0].curve);
  EXPECT_EQ(right.to, (geometry::Vector{0, 1}));
  EXPECT_EQ(right.offset, 0.5);
  const Table ellipse = build_table(shape("ellipse", {{"a", "0.1"}, {"b", "0.3"}}));
  EXPECT_EQ(std::get<geometry::Ellipse>(ellipse.walls[0].curve).ratio, 3.0);
}

TEST(Tables, ExtentTellsWhereTheWallsLead) {
  EXPECT_EQ(build_table(shape("circle", {{"radius", "1"}})).extent, Extent::bounded);
  EXPECT_EQ(build_table(two_discs()).extent, Extent::open_plane);
  const Table torus = build_table(shape("sinai", {{"side", "1"}, {"radius", "0.4"}}));
  ASSERT_EQ(torus.extent, Extent::lattice);
  ASSERT_TRUE(torus.lattice);
  EXPECT_EQ(torus.lattice->first, (geometry::Vector{1, 0}));
  EXPECT_EQ(build_table(closed_sinai()).extent, Extent::bounded);
  EXPECT_FALSE(build_table(closed_sinai()).lattice);
  EXPECT_EQ(build_table(repeated_discs()).extent, Extent::lattice);
  TableSpec obstacle = shape("path");
  obstacle.loops.push_back(
      loop(at("0", "0"), {line_to("0", "1"), line_to("1", "0"), line_to("0", "0")}));
  EXPECT_EQ(build_table(obstacle).extent, Extent::open_plane);
}

TEST(Shapes, CurvesWithANameHaveTheirAreasAndLengths) {
  const auto expect = [](const TableSpec& spec, double area, double perimeter) {
    const TableMeasure m = measure(build_table(spec));
    EXPECT_NEAR(m.area, area, 1e-13 * area) << spec.shape;
    EXPECT_NEAR(m.perimeter, perimeter, 1e-13 * perimeter) << spec.shape;
  };
  expect(shape("limacon", {{"radius", "2"}, {"epsilon", "0"}}), 4 * pi, 4 * pi);
  // A limaçon is Robnik's curve with lambda = epsilon / 2, displaced.
  const double k = 0.25,
               length = 4 * (1 + 2 * k) * boost::math::ellint_2(std::sqrt(8 * k) / (1 + 2 * k));
  expect(shape("robnik", {{"radius", "3"}, {"lambda", "1/4"}}), 9 * pi * (1 + 2 * k * k),
         3 * length);
  expect(shape("limacon", {{"radius", "3"}, {"epsilon", "1/2"}}), 9 * pi * (1 + 0.125), 3 * length);
  expect(shape("cardioid", {{"radius", "2"}}), 6 * pi, 16);
  expect(shape("superellipse", {{"a", "2"}, {"b", "1"}, {"exponent", "2"}}), 2 * pi,
         8 * boost::math::ellint_2(std::sqrt(3.0) / 2));
  expect(shape("egg", {{"a", "2"}, {"b", "1"}, {"epsilon", "0"}}), 2 * pi,
         8 * boost::math::ellint_2(std::sqrt(3.0) / 2));
  const auto area = [](const TableSpec& spec) { return measure(build_table(spec)).area; };
  EXPECT_NEAR(area(shape("superellipse", {{"a", "2"}, {"b", "1"}, {"exponent", "4"}})),
              8 * std::pow(std::tgamma(1.25), 2) / std::tgamma(1.5), 1e-12);
  EXPECT_NEAR(area(shape("flower", {{"radius", "2"}, {"epsilon", "0.2"}, {"petals", "5"}})),
              4 * pi * 1.02, 1e-12);
  EXPECT_NEAR(area(shape("egg", {{"a", "2"}, {"b", "1"}, {"epsilon", "0.3"}})), 2 * pi, 1e-12);
}

}  // namespace
}  // namespace carom::tests
