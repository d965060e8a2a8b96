// [table] shape = "svg": drawings as drawing programs write them, against closed forms.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "carom/table/table.hpp"
#include "files/toml/read.hpp"
#include "scratch_folder.hpp"
#include "system_text.hpp"

namespace carom::tests {
namespace {

using geometry::Circle;
using geometry::Vector;
constexpr double pi = std::numbers::pi;
/// A quarter of a circle of radius 1 as a cubic with handles of length k: the area between it and
/// its two radii.
double quarter(double k) { return 0.5 + 0.6 * k - 0.15 * k * k; }

class Drawings : public testing::Test {
 protected:
  static TableSpec spec_of(const std::string& toml, const std::string& file) {
    files::Value root = files::parse_document(toml, file);
    return files::read_table(root);
  }
  /// What is drawn within <svg>, with more keys.
  TableSpec spec(const std::string& drawing, const std::string& more = "") const {
    std::ofstream(folder_.file("d.svg")) << "<svg>" + drawing + "</svg>";
    return spec_of("[table]\nshape = \"svg\"\npath = \"d.svg\"\n" + more, folder_.file("a.toml"));
  }
  Table drawn(const std::string& drawing, const std::string& more = "") const {
    return build_table(spec(drawing, more));
  }
  static Table of_file(const std::string& name) {
    return build_table(spec_of("[table]\nshape = \"svg\"\npath = \"" + name + "\"",
                               CAROM_SOURCE "/tests/drawings/x.toml"));
  }
  static double area(const Table& table) { return measure(table).area; }
  static double area_of(const Table& table, const std::string& name) {
    double sum = 0.0;
    for (const Wall& wall : table.walls)
      if (wall.name == name || wall.name.starts_with(name + "_"))
        sum -= geometry::area_integral(wall.curve);
    return sum;
  }

  const ScratchFolder folder_;
};

TEST_F(Drawings, OfInkscape) {
  const Table table = of_file("inkscape.svg");
  const double room = 6000 - (4 - pi) * 100;
  EXPECT_NEAR(area_of(table, "room"), -room, 1e-9);
  EXPECT_NEAR(area_of(table, "egg"), 32 * pi, 1e-12);
  EXPECT_NEAR(area_of(table, "coin"), 9 * pi, 1e-12);
  EXPECT_NEAR(area_of(table, "blob"), 400 * quarter(0.55228), 0.02);
  EXPECT_EQ(table.wall_index("hidden"), -1);
  EXPECT_EQ(table.wall_index("never"), -1);
  const auto& coin = std::get<Circle>(table.wall(table.wall_index("coin")).curve);
  EXPECT_EQ(coin.radius, 3.0);
  // 30 to the right of the centre of a turn by 30 degrees, which is clockwise in a drawing.
  EXPECT_NEAR(coin.centre.x, 10 + 40 + 30 * std::sqrt(0.75), 1e-13);
  EXPECT_NEAR(coin.centre.y, 20.5 - 80 - 15, 1e-13);
  // The blob misses its start by a unit of its last digit: that is no side.
  EXPECT_EQ(table.wall_index("blob_5"), -1);
  EXPECT_GE(table.wall_index("blob_4"), 0);
}

TEST_F(Drawings, OfIllustrator) {
  const Table table = of_file("illustrator.svg");
  EXPECT_NEAR(area_of(table, "table"), -200 * 100.5, 1e-9);
  EXPECT_NEAR(area_of(table, "step_x5F_1"), 210 + 174.875, 1e-9);
  EXPECT_NEAR(area_of(table, "obstacle_3"), 200, 1e-9);
  EXPECT_NEAR(area_of(table, "obstacle_4"), 200, 1e-9);
}

TEST_F(Drawings, OfFigma) {
  const Table table = of_file("figma.svg");
  const double k = 1 - 8.9543 / 20;
  const double outer = 120 * 60 - 4 * 400 * (1 - quarter(k));
  EXPECT_NEAR(area_of(table, "wall"), -outer, 0.01);
  EXPECT_NEAR(area_of(table, "obstacle_1"), pi * 9.5 * 9.5, 1e-12);
  // A parabola above, its mirror image below: no area.
  EXPECT_NEAR(area_of(table, "obstacle_2"), 800, 1e-9);
}

TEST_F(Drawings, OfPdf) {
  const Table table = of_file("pdf2svg.svg");
  EXPECT_EQ(table.walls.size(), 8u);
  EXPECT_NEAR(area_of(table, "wall"), -113.385406 * 56.692703, 1e-9);
  EXPECT_NEAR(area_of(table, "obstacle_1"), pi * 14.174 * 14.174, 0.5);
  EXPECT_NEAR(geometry::start_point(table.wall(0).curve).y, -57.1, 1e-13);
}

TEST_F(Drawings, PiecesThatMeetAreJoined) {
  const Table table = of_file("stadium.svg");
  EXPECT_EQ(table.walls.size(), 5u);
  EXPECT_NEAR(area(table), 4 + pi - pi / 16, 1e-14);
  EXPECT_NEAR(measure(table).perimeter, 4 + 2 * pi + pi / 2, 1e-14);
  // The walls of the named shape, with the same numbers.
  TableSpec named;
  named.shape = "stadium";
  named.numbers["half_length"] = ExactNumber(1.0);
  named.numbers["radius"] = ExactNumber(1.0);
  const Table stadium = build_table(named);
  for (const auto& [drawn, own] : {std::pair{"lower_1", "bottom"},
                                   {"lower_2", "right"},
                                   {"upper_2", "top"},
                                   {"upper_1", "left"}}) {
    const geometry::Curve& a = table.wall(table.wall_index(drawn)).curve;
    const geometry::Curve& b = stadium.wall(stadium.wall_index(own)).curve;
    EXPECT_EQ(geometry::start_point(a), geometry::start_point(b)) << drawn;
    EXPECT_EQ(geometry::end_point(a), geometry::end_point(b)) << drawn;
    EXPECT_EQ(a.index(), b.index());
    if (const auto* arc = std::get_if<geometry::CircularArc>(&a)) {
      EXPECT_EQ(arc->offset, 0.0);
    }
  }
}

TEST_F(Drawings, AreTransformed) {
  const Table table = of_file("transforms.svg");
  const auto& rim = std::get<Circle>(table.wall(table.wall_index("rim")).curve);
  EXPECT_EQ(rim.radius, 10.0);
  EXPECT_EQ(rim.centre, (Vector{10.0, -10.0}));
  const auto& lens = std::get<geometry::Ellipse>(table.wall(table.wall_index("lens")).curve);
  // A quarter turn: what was 2 to the right is below, at twice the length.
  EXPECT_EQ(lens.centre, (Vector{10.0, -14.0}));
  EXPECT_EQ(lens.ratio * std::sqrt(dot(lens.axis, lens.axis)), 3.0);
  EXPECT_NEAR(area_of(table, "skewed"), 4 * pi, 1e-13);
  EXPECT_NEAR(area_of(table, "box"), 4 * (1 - (4 - pi) * 0.125), 1e-13);
  EXPECT_NEAR(area_of(table, "pie"), 4 * (0.25 + pi / 8), 1e-13);
}

TEST_F(Drawings, KeepExactNumbers) {
  const TableSpec table = spec("<path d='M.1.2l.1 0 0 .1z'/>", "scale = \"1/3\"\n");
  EXPECT_EQ(table.loops[0].start.x.to_rational()->denominator, "30");
  EXPECT_EQ(table.loops[0].start.y.text(), "-1/15");
  const Table circle = drawn("<circle cx='3mm' r='1in' id='c'/>");
  EXPECT_EQ(std::get<Circle>(circle.walls[0].curve).radius, 96.0);
  EXPECT_EQ(std::get<Circle>(circle.walls[0].curve).centre.x, 960.0 * 3.0 / 254.0);
  EXPECT_EQ(circle.walls[0].name, "c");
}

TEST_F(Drawings, TakeLinesAndFlags) {
  const Table house = drawn("<line x2='2'/><line y2='2'/><polyline points='2 0 2 2 0 2'/>");
  EXPECT_NEAR(area(house), 4.0, 1e-14);
  const Table arcs = drawn("<path d='M0 0a2 2 0 0110 0A5 5 0 010 0'/>");  // radii grow as needed
  EXPECT_NEAR(area(arcs), 25 * pi, 1e-12);
  const Table wide = drawn("<path d='M0 0A5 5 0 1 1 5 5L5 0z'/>");
  EXPECT_NEAR(measure(wide).perimeter, 10 + 7.5 * pi, 1e-12);
  const Table smooth = drawn("<path d='M0 0C1 -1 2 -1 3 0S5 1 6 0L6 4 0 4'/><path d='M0 4V0'/>");
  EXPECT_NEAR(area(smooth), 24.0, 1e-13);
}

TEST_F(Drawings, StraightCurvesAreLines) {
  const Table table = drawn("<path d='M0 0C0 0 4 0 4 0Q4 1 4 3L4 3L0 3Z'/>");
  EXPECT_EQ(table.walls.size(), 4u);
  EXPECT_EQ(area(table), 12.0);
}

TEST_F(Drawings, ResolvedSystemsNeedNoFile) {
  for (const char* name :
       {"inkscape", "illustrator", "figma", "pdf2svg", "stadium", "transforms"}) {
    files::Value root = files::parse_document(
        "[table]\nshape = \"svg\"\npath = \"" + std::string(name) + ".svg\"\nscale = 0.5",
        CAROM_SOURCE "/tests/drawings/x.toml");
    const Table drawn = build_table(files::read_table(root));
    const std::string resolved = files::print_document(root);
    EXPECT_EQ(resolved.find("svg"), std::string::npos);
    files::Value again = files::parse_document(resolved, "again.toml");
    const Table table = build_table(files::read_table(again));
    EXPECT_EQ(files::print_document(again), resolved);
    ASSERT_EQ(table.walls.size(), drawn.walls.size());
    for (std::size_t k = 0; k < table.walls.size(); ++k) {
      EXPECT_EQ(table.walls[k].name, drawn.walls[k].name);
      for (const double u : {0.0, 0.3, 0.9})
        EXPECT_EQ(geometry::point_at(table.walls[k].curve, u),
                  geometry::point_at(drawn.walls[k].curve, u));
    }
  }
}

TEST_F(Drawings, HoldMoreFromTheSystem) {
  const Table table =
      drawn("<rect width='4' height='4' id='room'/><circle cx='1' cy='1' r='.5'/>",
            "[[table.obstacle]]\nshape = \"circle\"\ncenter = [3, -3]\nradius = 0.5\n"
            "[[table.hole]]\nwall = \"room_1\"\ncenter = 2\nwidth = 1\n"
            "[[table.region]]\nwall = \"obstacle_1\"\nindex = 2\n");
  EXPECT_EQ(table.holes.size(), 1u);
  EXPECT_EQ(table.regions.size(), 1u);
  EXPECT_GE(table.wall_index("obstacle_2"), 0);
}

}  // namespace
}  // namespace carom::tests
