// Specifications that are no table.
#include "spec.hpp"

namespace carom::tests {
namespace {

TEST(Faults, SizesMustBePositiveAndInRange) {
  for (const char* bad : {"0", "-1", "1e-40", "1e40", "1e-400"}) {
    const InputError error = fault(shape("rectangle", {{"width", bad}, {"height", "1"}}));
    EXPECT_EQ(error.place().key, "table.width");
    EXPECT_EQ(error.place().line, 7);
    EXPECT_FALSE(error.expected().empty());
  }
}

TEST(Faults, SizesMustFitTogether) {
  EXPECT_EQ(
      blamed(shape("mushroom", {{"cap_radius", "1"}, {"stem_width", "2.1"}, {"stem_height", "1"}})),
      "table.stem_width");
  EXPECT_EQ(blamed(shape("lemon", {{"radius", "1"}, {"separation", "2"}})), "table.separation");
  EXPECT_EQ(blamed(shape("lemon", {{"radius", "1"}, {"separation", "3"}})), "table.separation");
  EXPECT_EQ(blamed(shape("annulus", {{"outer", "1"}, {"inner", "1"}})), "table.inner");
  EXPECT_EQ(blamed(shape("annulus", {{"outer", "1"}, {"inner", "1/2"}, {"offset", "-0.6"}})),
            "table.offset");
  EXPECT_EQ(blamed(shape("sinai", {{"side", "1"}, {"radius", "0.6"}})), "table.radius");
  EXPECT_EQ(blamed(shape("lorentz", {{"spacing", "1"}, {"radius", "0.6"}})), "table.radius");
  EXPECT_EQ(blamed(shape("regular", {{"sides", "2"}, {"radius", "1"}})), "table.sides");
  EXPECT_EQ(blamed(shape("limacon", {{"radius", "1"}, {"epsilon", "1"}})), "table.epsilon");
  EXPECT_EQ(blamed(shape("robnik", {{"radius", "1"}, {"lambda", "-0.5"}})), "table.lambda");
  EXPECT_EQ(blamed(shape("superellipse", {{"a", "1"}, {"b", "1"}, {"exponent", "3"}})),
            "table.exponent");
  EXPECT_EQ(blamed(shape("flower", {{"radius", "1"}, {"epsilon", "0.1"}, {"petals", "0.5"}})),
            "table.petals");
  EXPECT_EQ(blamed(shape("regular", {{"sides", "3.5"}, {"radius", "1"}})), "table.sides");
}

TEST(Faults, MissingNumbersAreNamed) {
  EXPECT_EQ(blamed(shape("rectangle", {{"width", "1"}})), "table.height");
  EXPECT_EQ(blamed(shape("polygon")), "table.points");
  EXPECT_EQ(blamed(shape("discs", {{"radius", "1"}})), "table.centers");
  EXPECT_EQ(blamed(shape("path")), "table.loop");
}

TEST(Faults, UnknownShapesAndLatticesNameTheNearest) {
  EXPECT_EQ(fault(shape("rectangel")).nearest(), "rectangle");
  TableSpec lorentz = shape("lorentz", {{"spacing", "1"}, {"radius", "1/4"}});
  lorentz.words["lattice"] = "sqare";
  EXPECT_EQ(fault(lorentz).nearest(), "square");
}

TEST(Faults, RadiiMustMatchTheCenters) {
  TableSpec spec = shape("discs");
  spec.points["centers"] = {at("0", "0"), at("3", "0")};
  spec.lists["radii"] = {exact("1", "table.radii[0]")};
  EXPECT_EQ(blamed(spec), "table.radii[0]");
  spec.lists["radii"].push_back(exact("0", "table.radii[1]"));
  EXPECT_EQ(blamed(spec), "table.radii[1]");
  spec.lists["radii"][1] = exact("1");
  EXPECT_TRUE(is_legal(spec));
  spec.numbers["radius"] = exact("1");
  EXPECT_FALSE(is_legal(spec));
}

TEST(Faults, PathsMustClose) {
  TableSpec spec = shape("path");
  spec.loops = {loop(at("0", "0"), {line_to("1", "0"), line_to("1", "1"), line_to("0", "0.1")})};
  EXPECT_EQ(blamed(spec), "table.loop[0].pieces");
  spec.loops = {loop(at("0", "0"), {line_to("1", "0"), line_to("1", "0"), line_to("0", "0")})};
  EXPECT_EQ(blamed(spec), "table.loop[0].pieces");
  spec.loops = {loop(at("0", "0"), {line_to("1", "0"), arc_to(at("1/2", "0"), at("0", "0"))})};
  EXPECT_EQ(blamed(spec), "table.loop[0].pieces");
  spec.loops = {
      loop(at("0", "0"), {line_to("1", "0", "a"), line_to("1", "1", "a"), line_to("0", "0")})};
  EXPECT_EQ(blamed(spec), "table.loop[0].pieces");
  spec.loops = {loop(at("0", "0"), {})};
  EXPECT_EQ(blamed(spec), "table.loop[0]");
}

TEST(Faults, LatticesMustSpanThePlaneAndLeadSomewhere) {
  TableSpec spec = shape("discs", {{"radius", "1"}});
  spec.points["centers"] = {at("0", "0")};
  spec.lattice =
      LatticeSpec{at("3", "0"), at("6", "0"), Place{"test.toml", 30, 5, "lattice.vectors"}};
  EXPECT_EQ(blamed(spec), "lattice.vectors");
  spec.numbers.insert_or_assign("radius", exact("0.2"));
  spec.lattice =
      LatticeSpec{at("1", "0"), at("10000.25", "1"), Place{"test.toml", 30, 5, "lattice.vectors"}};
  EXPECT_EQ(blamed(spec), "lattice.vectors");
  EXPECT_EQ(blamed(spec), "lattice.vectors");
  spec.lattice = LatticeSpec{at("1", "0"), at("1000.25", "1"), {}};
  EXPECT_TRUE(is_legal(spec));
  TableSpec closed = shape("circle", {{"radius", "1"}});
  closed.lattice = LatticeSpec{at("3", "0"), at("0", "3"), {}};
  EXPECT_FALSE(is_legal(closed));
  TableSpec own = shape("sinai", {{"side", "1"}, {"radius", "0.4"}});
  own.lattice = closed.lattice;
  EXPECT_FALSE(is_legal(own));
}

}  // namespace
}  // namespace carom::tests
