// What a region is, and each way of not being one.
#include "carom/geometry/region.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace carom::geometry {
namespace {

using Faults = std::vector<RegionFault>;
using Kind = RegionFault::Kind;
const double pi = std::acos(-1.0);

Loop polygon(const std::vector<Vector>& corners, const std::string& name = "side") {
  Loop loop;
  for (std::size_t i = 0; i < corners.size(); ++i)
    loop.push_back({name + "_" + std::to_string(i + 1),
                    Segment{corners[i], corners[(i + 1) % corners.size()]}});
  return loop;
}
Loop rectangle(Vector low, Vector high) {
  return {{"bottom", Segment{low, {high.x, low.y}}},
          {"right", Segment{{high.x, low.y}, high}},
          {"top", Segment{high, {low.x, high.y}}},
          {"left", Segment{{low.x, high.y}, low}}};
}
Loop disc(Vector centre, double radius, const std::string& name = "disc") {
  return {{name, Circle{centre, radius, false}}};
}
Loop circle(double radius) { return {{"circle", Circle{{0, 0}, radius, true}}}; }
Loop stadium(double half, double radius) {
  return {{"bottom", Segment{{-half, -radius}, {half, -radius}}},
          {"right", CircularArc{{half, -radius}, {half, radius}, 0.0, true}},
          {"top", Segment{{half, radius}, {-half, radius}}},
          {"left", CircularArc{{-half, radius}, {-half, -radius}, 0.0, true}}};
}
Loop mushroom(double cap, double width, double height) {
  const double w = 0.5 * width;
  return {{"stem_bottom", Segment{{-w, -height}, {w, -height}}},
          {"stem_right", Segment{{w, -height}, {w, 0}}},
          {"brim_right", Segment{{w, 0}, {cap, 0}}},
          {"cap", CircularArc{{cap, 0}, {-cap, 0}, 0.0, true}},
          {"brim_left", Segment{{-cap, 0}, {-w, 0}}},
          {"stem_left", Segment{{-w, 0}, {-w, -height}}}};
}
Loop reversed_loop(const Loop& loop) {
  Loop result;
  for (auto it = loop.rbegin(); it != loop.rend(); ++it)
    result.push_back({it->name, reversed(it->curve)});
  return result;
}

Faults bounded(const std::vector<Loop>& loops) { return check_region(loops, RegionKind::bounded); }
std::string sentences(const Faults& faults) {
  std::string all;
  for (const RegionFault& f : faults) all += f.sentence + "\n";
  return all;
}
void expect_sound(const std::vector<Loop>& loops, RegionKind kind = RegionKind::bounded,
                  const std::optional<Lattice>& lattice = std::nullopt) {
  const Faults faults = check_region(loops, kind, lattice);
  EXPECT_TRUE(faults.empty()) << sentences(faults);
}
// The first fault is of this kind, between these curves.
void expect_fault(const Faults& faults, Kind kind, const std::string& first,
                  const std::string& second = "") {
  ASSERT_FALSE(faults.empty());
  EXPECT_EQ(faults.front().kind, kind) << sentences(faults);
  EXPECT_EQ(faults.front().first, first) << sentences(faults);
  EXPECT_EQ(faults.front().second, second) << sentences(faults);
}
void expect_fault(const Faults& faults, Kind kind, const std::string& first,
                  const std::string& second, Vector place) {
  expect_fault(faults, kind, first, second);
  EXPECT_NEAR(faults.front().place.x, place.x, 1e-4);
  EXPECT_NEAR(faults.front().place.y, place.y, 1e-4);
}

TEST(Region, SoundTablesHaveNoFault) {
  expect_sound({rectangle({0, 0}, {1, 1})});
  expect_sound({circle(1)});
  expect_sound({stadium(1, 1)});
  expect_sound({mushroom(1, 1, 1)});
  expect_sound({{{"ellipse", Ellipse{{0, 0}, {2, 0}, 0.5, true}}}});
  expect_sound({circle(1), disc({0.25, 0}, 0.5)});
  expect_sound({rectangle({0, 0}, {1, 1}), disc({0.5, 0.5}, 0.25)});
  // A lemon: two arcs that meet twice, at both of their joints.
  expect_sound({{{"right", CircularArc{{0, -1}, {0, 1}, 0.5, true}},
                 {"left", CircularArc{{0, 1}, {0, -1}, 0.5, true}}}});
  // One circle in two arcs, and one ellipse in a minor and a major arc.
  expect_sound({{{"upper", CircularArc{{1, 0}, {-1, 0}, 0.0, true}},
                 {"lower", CircularArc{{-1, 0}, {1, 0}, 0.0, true}}}});
  expect_sound({{{"short", EllipticArc{{1, 0}, {0, 1}, {1, 1}, 0.5, 0.25, true}},
                 {"long", EllipticArc{{0, 1}, {1, 0}, {1, 1}, 0.5, -0.25, true}}}});
}

TEST(Region, AnyStartAndOrderTellTheSame) {
  const std::vector<Loop> sound{mushroom(1, 1, 1), disc({0.5, 0.5}, 0.125, "a"),
                                disc({-0.5, 0.5}, 0.25, "b")};
  const std::vector<Loop> broken{mushroom(1, 1, 1), disc({0.5, 0.5}, 0.125, "a"),
                                 disc({0.25, 0.5}, 0.25, "b")};
  for (const auto& [loops, count] : {std::pair{sound, 0u}, std::pair{broken, 1u}}) {
    std::vector<Loop> turned = loops;
    for (int i = 0; i < 6; ++i) {
      std::rotate(turned[0].begin(), turned[0].begin() + 1, turned[0].end());
      EXPECT_EQ(bounded(turned).size(), count) << sentences(bounded(turned));
      EXPECT_EQ(bounded({turned[2], turned[0], turned[1]}).size(), count);
    }
  }
}

TEST(Region, ReversedIsAFault) {
  for (const Loop& loop : {rectangle({0, 0}, {1, 1}), circle(1), stadium(1, 1), mushroom(1, 1, 1)})
    EXPECT_EQ(bounded({reversed_loop(loop)}).at(0).kind, Kind::orientation);
  expect_fault(bounded({reversed_loop(circle(1))}), Kind::orientation, "circle");
  expect_fault(bounded({circle(1), reversed_loop(disc({0, 0}, 0.5))}), Kind::orientation, "disc");
  EXPECT_EQ(check_region({circle(1)}, RegionKind::open).at(0).kind, Kind::orientation);
  // Two outer loops side by side.
  EXPECT_EQ(bounded({rectangle({0, 0}, {1, 1}), rectangle({2, 0}, {3, 1})}).at(0).kind,
            Kind::orientation);
}

TEST(Region, NoExtent) {
  expect_fault(bounded({polygon({{0, 0}, {1, 0}, {1, 0}, {0, 1}})}), Kind::no_extent, "side_2");
  expect_fault(bounded({circle(0.0)}), Kind::no_extent, "circle");
  expect_fault(bounded({circle(-1.0)}), Kind::no_extent, "circle");
  expect_fault(bounded({circle(NAN)}), Kind::no_extent, "circle");
  expect_fault(bounded({{{"e", Ellipse{{0, 0}, {1, 0}, 0.0, true}}}}), Kind::no_extent, "e");
  expect_fault(bounded({{{"a", CircularArc{{1, 0}, {1, 0}, 1.0, true}}}}), Kind::no_extent, "a");
  EXPECT_FALSE(bounded({{{"a", CircularArc{{INFINITY, 0}, {1, 0}, 1.0, true}}}}).empty());
}

TEST(Region, OpenLoopsAreFaults) {
  Loop open = rectangle({0, 0}, {1, 1});
  open[2].curve = Segment{{1, 1}, {0, 0.75}};
  expect_fault(bounded({open}), Kind::open_loop, "top", "left");
  open = rectangle({0, 0}, {1, 1});
  open.pop_back();
  expect_fault(bounded({open}), Kind::open_loop, "top", "bottom");
  // By the last bit.
  open = rectangle({0, 0}, {1, 1});
  open[0].curve = Segment{{0, 0}, {std::nextafter(1.0, 2.0), 0}};
  expect_fault(bounded({open}), Kind::open_loop, "bottom", "right");
  EXPECT_EQ(bounded({{}}).at(0).kind, Kind::open_loop);
  Loop mixed = rectangle({0, 0}, {1, 1});
  mixed.push_back({"ring", Circle{{0, 0}, 1, true}});
  EXPECT_EQ(bounded({mixed}).at(0).sentence,
            "wall 'ring' is closed by itself and cannot be a part of a loop");
}

TEST(Region, SelfCrossingLoopsAreFaults) {
  expect_fault(bounded({polygon({{0, 0}, {1, 1}, {1, 0}, {0, 1}})}), Kind::crossing, "side_1",
               "side_3", {0.5, 0.5});
  // A cap that bulges into the opposite side.
  Loop bitten = rectangle({0, 0}, {1, 1});
  bitten[2].curve = arc_through({1, 1}, {0.5, -0.125}, {0, 1});
  const Faults faults = bounded({bitten});
  ASSERT_FALSE(faults.empty());
  EXPECT_EQ(faults[0].kind, Kind::crossing);
  EXPECT_EQ(faults[0].first + faults[0].second, "bottomtop");
  // It touches the opposite side: not simple either.
  bitten[2].curve = EllipticArc{{1, 1}, {0, 1}, {1, 0}, 2.0, 0.0, false};
  expect_fault(bounded({bitten}), Kind::crossing, "bottom", "top", {0.5, 0});
  // A spike: the path returns along itself.
  expect_fault(bounded({polygon({{0, 0}, {1, 0}, {2, 0}, {1, 0}, {1, 1}})}), Kind::crossing,
               "side_2", "side_3", {1, 0});
  // A corner on another side, and two corners at one point.
  expect_fault(bounded({polygon({{0, 0}, {2, 0}, {2, 2}, {1, 0}, {0, 2}})}), Kind::crossing,
               "side_1", "side_4", {1, 0});
  EXPECT_EQ(bounded({polygon({{0, 0}, {1, 1}, {2, 0}, {2, 2}, {1, 1}, {0, 2}})}).at(0).kind,
            Kind::crossing);
}

TEST(Region, LoopsThatCrossAreFaults) {
  const Faults faults = bounded({rectangle({0, 0}, {1, 1}), disc({0.0, 0.5}, 0.25)});
  EXPECT_EQ(faults.size(), 2u);
  expect_fault(faults, Kind::crossing, "left", "disc");
  expect_fault(check_region({disc({0, 0}, 1, "a"), disc({1.5, 0}, 1, "b")}, RegionKind::open),
               Kind::crossing, "a", "b", {0.75, 0});
  expect_fault(bounded({circle(1), disc({0.75, 0}, 0.5)}), Kind::crossing, "circle", "disc",
               {0.875, 0.4841});
  expect_fault(bounded({circle(1), disc({0, 0}, 1)}), Kind::crossing, "circle", "disc", {1, 0});
  // An ellipse through a circle: four points.
  EXPECT_EQ(bounded({circle(1), {{"e", Ellipse{{0, 0}, {2, 0}, 0.25, false}}}}).size(), 4u);
  // Sides that lie on one line and overlap.
  expect_fault(bounded({rectangle({0, 0}, {4, 4}),
                        reversed_loop(polygon({{1, 0}, {2, 0}, {2, 1}, {1, 1}}, "box"))}),
               Kind::crossing, "bottom", "box_4");
}

TEST(Region, CuspsAreLegal) {
  expect_sound({rectangle({0, 0}, {1, 1}), disc({0.5, 0.5}, 0.5)});  // four tangencies
  expect_sound({circle(1), disc({0.5, 0}, 0.5)});                    // inner tangency
  expect_sound({disc({0, 0}, 1, "a"), disc({2, 0}, 1, "b")}, RegionKind::open);
  expect_sound({rectangle({0, 0}, {4, 4}), {{"e", Ellipse{{2, 2}, {2, 0}, 0.5, false}}}});
  // A diamond whose corners rest on the sides, and one that pierces a side by the last bit.
  expect_sound(
      {rectangle({0, 0}, {2, 2}), reversed_loop(polygon({{1, 0}, {2, 1}, {1, 2}, {0, 1}}, "d"))});
  const Faults faults =
      bounded({rectangle({0, 0}, {2, 2}),
               reversed_loop(polygon({{1, -1e-300}, {2, 1}, {1, 2}, {0, 1}}, "d"))});
  EXPECT_EQ(faults.size(), 2u) << sentences(faults);
  // Corner against corner, and a smooth joint (tangent continued) against a line.
  expect_sound({rectangle({0, 0}, {2, 2}), reversed_loop(polygon({{0, 0}, {2, 1}, {1, 2}}, "d"))});
  Loop pill = reversed_loop(stadium(1, 1));
  expect_sound({rectangle({-3, -3}, {3, 3}), pill, {{"e", Ellipse{{1, 2}, {1, 0}, 1.0, false}}}});
  // Larger by the last bit, it is not a cusp any more.
  EXPECT_FALSE(
      bounded({rectangle({0, 0}, {1, 1}), disc({0.5, 0.5}, std::nextafter(0.5, 1.0))}).empty());
  EXPECT_FALSE(check_region({disc({0, 0}, 1, "a"), disc({2, 0}, std::nextafter(1.0, 2.0), "b")},
                            RegionKind::open)
                   .empty());
}

TEST(Region, ObstaclesOutsideOrWithinOthersAreFaults) {
  expect_fault(bounded({circle(1), disc({3, 0}, 0.5)}), Kind::nesting, "disc", "circle");
  expect_fault(bounded({stadium(1, 1), reversed_loop(rectangle({1.8, 0.8}, {1.9, 0.9}))}),
               Kind::nesting, "left", "bottom");
  expect_fault(bounded({circle(4), disc({0, 0}, 2, "a"), disc({0.5, 0}, 1, "b")}), Kind::nesting,
               "b", "a");
  expect_fault(
      bounded({circle(8), reversed_loop(rectangle({-2, -2}, {2, 2})), disc({0.5, 0}, 1, "b")}),
      Kind::nesting, "b", "left");
  expect_sound({circle(8), reversed_loop(rectangle({-2, -2}, {2, 2})), disc({4, 0}, 1, "b")});
}

TEST(Region, CellsOfLatticesAreChecked) {
  const Lattice square = make_lattice({1, 0}, {0, 1}, {0, 0});
  expect_sound({disc({0, 0}, 0.25)}, RegionKind::lattice, square);
  expect_sound({disc({0, 0}, 0.5)}, RegionKind::lattice, square);  // touches its copies
  expect_fault(check_region({disc({0, 0}, 0.625)}, RegionKind::lattice, square), Kind::crossing,
               "disc", "disc", {0.5, 0});
  // Moved by a lattice vector, or spread over several cells: the same region.
  expect_sound({disc({5, -3}, 0.25, "a"), disc({0.5, 0.5}, 0.25, "b")}, RegionKind::lattice,
               square);
  EXPECT_FALSE(check_region({disc({5, -3}, 0.25, "a"), disc({0.25, 0}, 0.25, "b")},
                            RegionKind::lattice, square)
                   .empty());
  // One disc inside a copy of another.
  EXPECT_EQ(check_region({disc({5, -3}, 0.4, "a"), disc({0.125, 0}, 0.1, "b")}, RegionKind::lattice,
                         square)
                .at(0)
                .kind,
            Kind::nesting);
  const Lattice skewed = make_lattice({1, 0}, {0.5, std::sqrt(3.0) / 2}, {0, 0});
  expect_sound({disc({0, 0}, 0.5 * 0.999)}, RegionKind::lattice, skewed);
  EXPECT_FALSE(check_region({disc({0, 0}, 0.5001)}, RegionKind::lattice, skewed).empty());
  // A bar that reaches its copy in the next cell, which it crosses or just touches.
  const auto bar = [](double length) { return reversed_loop(rectangle({0, 0}, {length, 0.25})); };
  expect_sound({bar(0.75)}, RegionKind::lattice, square);
  EXPECT_FALSE(check_region({bar(1.25)}, RegionKind::lattice, square).empty());
  EXPECT_EQ(check_region({bar(0.75), disc({2.375, 0.125}, 0.0625)}, RegionKind::lattice, square)
                .at(0)
                .kind,
            Kind::nesting);
}

TEST(Region, SizesAndPlacesDoNotMatter) {
  for (const double size : {1e-6, 1.0, 1e6})
    for (const Vector at : {Vector{0, 0}, Vector{3 * size, -size}}) {
      const Loop square = rectangle(at, at + Vector{size, size});
      const Vector middle = at + Vector{0.5 * size, 0.5 * size};
      expect_sound({square, disc(middle, 0.49 * size)});
      EXPECT_FALSE(bounded({square, disc(middle, 0.51 * size)}).empty());
      EXPECT_NEAR(area({square, disc(middle, 0.25 * size)}), size * size * (1 - pi / 16),
                  1e-14 * size * size);
      EXPECT_EQ(locate(square, middle), 1);
      EXPECT_EQ(locate(square, middle + Vector{size, 0}), -1);
      EXPECT_EQ(locate(square, at + Vector{0, size}), 0);
    }
}

TEST(Region, AreaAndPerimeterAreThoseOfTheShape) {
  EXPECT_NEAR(area({stadium(1, 1)}), 4 + pi, 1e-14);
  EXPECT_NEAR(perimeter({stadium(1, 1)}), 4 + 2 * pi, 1e-14);
  EXPECT_NEAR(area({mushroom(1, 1, 1)}), 1 + pi / 2, 1e-14);
  EXPECT_NEAR(area({circle(2), disc({0, 0}, 1)}), 3 * pi, 1e-14);
  EXPECT_NEAR(perimeter({circle(2), disc({0, 0}, 1)}), 6 * pi, 1e-14);
}

TEST(Region, PointLocationAgreesWithFormulas) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> box(-2.5, 2.5);
  const Loop table = stadium(1, 1), oval{{"e", Ellipse{{0, 0}, {2, 0}, 0.5, true}}};
  for (int i = 0; i < 300; ++i) {
    const Vector p{box(random), box(random)};
    const double x = std::max(std::fabs(p.x) - 1.0, 0.0);
    EXPECT_EQ(locate(table, p), x * x + p.y * p.y < 1.0 ? 1 : -1);
    EXPECT_EQ(locate(oval, p), p.x * p.x / 4 + p.y * p.y < 1.0 ? 1 : -1);
  }
  // On the boundary: only where it is exactly there.
  EXPECT_EQ(locate(table, {0.5, 1.0}), 0);
  EXPECT_EQ(locate(table, {2.0, 0.0}), 0);
  EXPECT_EQ(locate(table, {1.6, 0.8}), -1);  // 0.6 and 0.8 rounded: just outside
  EXPECT_EQ(locate(oval, {0.0, -0.5}), 1);
  EXPECT_EQ(locate(oval, {0.0, -1.0}), 0);
  // Level with joints, where a horizontal ray would run along walls.
  EXPECT_EQ(locate(mushroom(1, 1, 1), {0.0, 0.0}), 1);
  EXPECT_EQ(locate(mushroom(1, 1, 1), {-2.0, 0.0}), -1);
}

TEST(Region, RaysMayPassThroughJointsAndTangents) {
  // Point location sends its first ray along this direction: through a joint, and along a tangent.
  const Vector d{1.0, 0.1123046875};
  const auto ring = [](Vector joint) {
    return Loop{{"first", CircularArc{joint, -joint, 0.0, true}},
                {"second", CircularArc{-joint, joint, 0.0, true}}};
  };
  EXPECT_EQ(locate(ring(4.0 * d), {0, 0}), 1);
  EXPECT_EQ(locate(ring(4.0 * d), -8.0 * d), -1);
  EXPECT_EQ(locate(ring(4.0 * d), left(4.0 * d) - 8.0 * d), -1);
  EXPECT_EQ(locate(polygon({{0, 0}, 4.0 * d, left(d)}), -d), -1);  // along a side
  EXPECT_EQ(locate(polygon({{4, -4}, 4.0 * d, {-4, 4}}), {0.0, 0.0}), 0);
  EXPECT_EQ(locate(polygon({{4, -4}, 4.0 * d, {-4, 4}}), 0.5 * d), 1);
}

TEST(Region, ManyWallsAreChecked) {
  std::vector<Vector> corners;
  const int n = 10000;
  for (int i = 0; i < n; ++i)
    corners.push_back({std::cos(2 * pi * i / n), std::sin(2 * pi * i / n)});
  std::vector<Loop> loops{polygon(corners)};
  for (int i = 0; i < 20; ++i)
    loops.push_back(disc({0.04 * i - 0.4, 0.0}, 0.019, "disc_" + std::to_string(i)));
  expect_sound(loops);
  corners[3000] = {0, 0.0};
  EXPECT_FALSE(bounded({polygon(corners), disc({0, 0}, 0.125)}).empty());
}

// Thin rays, whose boxes overlap far more often than they come near each other; one of them too
// long.
TEST(Region, ManyRaysAgree) {
  std::vector<Vector> corners;
  const int n = 1500;
  for (int i = 0; i < n; ++i) {
    const double r = i % 2 == 0 ? 0.5 : 1.0, angle = 2.0 * pi * i / n;
    corners.push_back({r * std::cos(angle), r * std::sin(angle)});
  }
  EXPECT_TRUE(check_region({polygon(corners)}, RegionKind::bounded).empty());
  corners[100] = -1.75 * corners[100];
  const Faults faults = check_region({polygon(corners)}, RegionKind::bounded);
  ASSERT_FALSE(faults.empty());
  EXPECT_EQ(faults.front().kind, Kind::crossing);
}

TEST(Region, ManyDiscsAreChecked) {
  std::vector<Loop> loops{rectangle({-1, -1}, {316, 316})};
  for (int i = 0; i < 316; ++i)
    for (int j = 0; j < 316; ++j)
      loops.push_back(disc({1.0 * i, 1.0 * j}, 0.5, "disc_" + std::to_string(i)));
  expect_sound(loops);  // each touches its neighbours
  loops[1000] = disc({2.0, 51.0}, 0.625, "large");
  EXPECT_FALSE(bounded(loops).empty());
}

}  // namespace
}  // namespace carom::geometry
