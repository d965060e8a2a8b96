// Tables made in code are those of the same specification, and are checked at each step.
#include "carom/table/make.hpp"

#include <numbers>
#include <stdexcept>

#include "spec.hpp"

namespace carom::tests {
namespace {

void expect_same(const Table& a, const Table& b) {
  EXPECT_EQ(names_of(a), names_of(b));
  EXPECT_EQ(a.extent, b.extent);
  EXPECT_EQ(measure(a).perimeter, measure(b).perimeter);
  EXPECT_EQ(measure(a).area, measure(b).area);
}

TEST(Make, EveryShape) {
  expect_same(rectangle(2, "1/3"_exact),
              build_table(shape("rectangle", {{"width", "2"}, {"height", "1/3"}})));
  expect_same(regular_polygon(5, 2),
              build_table(shape("regular", {{"sides", "5"}, {"radius", "2"}})));
  expect_same(circle(2), build_table(shape("circle", {{"radius", "2"}})));
  expect_same(ellipse(2, 1), build_table(shape("ellipse", {{"a", "2"}, {"b", "1"}})));
  expect_same(annulus(2, 1, 0.5),
              build_table(shape("annulus", {{"outer", "2"}, {"inner", "1"}, {"offset", "1/2"}})));
  expect_same(stadium(2, 1),
              build_table(shape("stadium", {{"half_length", "2"}, {"radius", "1"}})));
  expect_same(mushroom(2, 1, 3),
              build_table(shape("mushroom",
                                {{"cap_radius", "2"}, {"stem_width", "1"}, {"stem_height", "3"}})));
  expect_same(lemon(2, 1), build_table(shape("lemon", {{"radius", "2"}, {"separation", "1"}})));
  expect_same(cardioid(2), build_table(shape("cardioid", {{"radius", "2"}})));
  expect_same(limacon(2, 0.5),
              build_table(shape("limacon", {{"radius", "2"}, {"epsilon", "1/2"}})));
  expect_same(flower(2, 0.1, 3),
              build_table(shape("flower", {{"radius", "2"}, {"epsilon", "0.1"}, {"petals", "3"}})));
  expect_same(superellipse(2, 1, 4),
              build_table(shape("superellipse", {{"a", "2"}, {"b", "1"}, {"exponent", "4"}})));
  expect_same(robnik(2, 0.25), build_table(shape("robnik", {{"radius", "2"}, {"lambda", "1/4"}})));
  expect_same(egg(2, 1, 0.25),
              build_table(shape("egg", {{"a", "2"}, {"b", "1"}, {"epsilon", "1/4"}})));
  expect_same(sinai(2, 0.5), build_table(shape("sinai", {{"side", "2"}, {"radius", "1/2"}})));
  EXPECT_EQ(sinai(2, 0.5, false).table->walls.size(), 5u);
  expect_same(lorentz(3, 1), build_table(shape("lorentz", {{"spacing", "3"}, {"radius", "1"}})));
  EXPECT_EQ(measure(lorentz(3, 1, "square")).area + std::numbers::pi, 9.0);
  EXPECT_EQ(discs({{0, 0}, {3, 0}}, 1).table->walls.size(), 2u);
  EXPECT_EQ(measure(discs({{0, 0}, {3, 0}}, {1, 0.5}).lattice({6, 0}, {0, 4})).area +
                1.25 * std::numbers::pi,
            24.0);
  EXPECT_EQ(
      measure(path({loop({0, 0}, {line_to("1", "0"), line_to("1", "1"), line_to("0", "0")})})).area,
      0.5);
}

TEST(Make, HolesAndObstaclesAreAdded) {
  const MadeTable table =
      polygon({{0, 0}, {2, 0}, {2, 1}, {0, 1}})
          .hole("side_1", {.center = 1, .width = 0.25})
          .obstacle(disc({1, 0.5}, 0.25), "middle")
          .obstacle(elliptic_disc({0.25, 0.5}, 0.1, 0.2))
          .obstacle(block({{1.5, 0.5}, {1.75, 0.5}, {1.75, 0.75}}))
          .hole("middle", {.center = "pi/8"_exact, .width = "pi/8"_exact, .name = "inner"});
  EXPECT_EQ(names_of(table), (std::vector<std::string>{"side_1", "side_2", "side_3", "side_4",
                                                       "middle", "obstacle_2", "obstacle_3_side_3",
                                                       "obstacle_3_side_2", "obstacle_3_side_1"}));
  EXPECT_EQ(table.table->holes[0].from, 0.4375);
  EXPECT_EQ(table.table->wall(table.table->holes[1].wall).name, "middle");
  EXPECT_EQ(table.table->holes[1].name, "inner");
  EXPECT_THROW(table.table->wall(-1), std::out_of_range);
}

template <class Make>
InputError error_of(Make make) {
  try {
    make();
  } catch (const InputError& error) {
    return error;
  }
  return InputError("no fault");
}

TEST(Make, FaultsNameTheStep) {
  const MadeTable square = rectangle(1, 1);
  EXPECT_EQ(error_of([] { rectangle(0, 1); }).place().key, "table");
  EXPECT_EQ(error_of([] { polygon({{0, 0}, {1, 1}}); }).place().key, "table");
  EXPECT_EQ(error_of([] { polygon({{0, 0}, {1, 1}, {1, 0}, {0, 1}}); }).place().key, "table");
  EXPECT_EQ(error_of([&] { square.hole("botom", {.center = 0.5, .width = 0.1}); }).nearest(),
            "bottom");
  EXPECT_EQ(error_of([&] { square.hole("top", {.center = 2, .width = 0.1}); }).place().key,
            "table.hole[0]");
  EXPECT_EQ(error_of([&] {
              square.obstacle(disc({0.5, 0.5}, 0.1)).obstacle(disc({1, 0}, 0.1));
            })
                .place()
                .key,
            "table.obstacle[1]");
  EXPECT_EQ(error_of([&] { square.lattice({1, 0}, {0, 1}); }).place().key, "lattice.vectors");
  EXPECT_EQ(error_of([] { lorentz(3, 1, "sqare"); }).nearest(), "square");
  EXPECT_THROW("1/0"_exact, InputError);
}

// The doubles 0.1 and 0.3 are not 1/10 and 3/10, nor is their quotient nearest to 1/3.
TEST(Make, ADoubleMeansItself) {
  const auto ratio = [](const MadeTable& table) {
    return std::get<geometry::Ellipse>(table.table->wall(0).curve).ratio;
  };
  EXPECT_EQ(ratio(ellipse(0.3, 0.1)), 0.1 / 0.3);
  EXPECT_NE(0.1 / 0.3, 1.0 / 3.0);
  EXPECT_EQ(ratio(ellipse("0.3"_exact, "0.1"_exact)), 1.0 / 3.0);
}

}  // namespace
}  // namespace carom::tests
