// Specifications that are no table.
#include "spec.hpp"

namespace carom::tests {
namespace {

TEST(Faults, SizesMustBePositiveAndInRange) {
  for (const char* bad : {"0", "-1", "1e-40", "1e40", "1e-400"}) {
    const std::string message = fault(shape("rectangle", {{"width", bad}, {"height", "1"}}));
    EXPECT_HAS(message, "test.toml, line 7, column 3: table.width: ");
    EXPECT_HAS(message, "expected");
  }
  EXPECT_EQ(fault(shape("circle", {{"radius", "-1/2"}})),
            "test.toml, line 7, column 3: table.radius: must be positive, not -1/2 (expected a "
            "number > 0)");
}

TEST(Faults, SizesMustFitTogether) {
  EXPECT_HAS(
      fault(shape("mushroom", {{"cap_radius", "1"}, {"stem_width", "2.1"}, {"stem_height", "1"}})),
      "table.stem_width: the stem is wider than the cap (expected stem_width <= 2 cap_radius)");
  EXPECT_HAS(fault(shape("lemon", {{"radius", "1"}, {"separation", "2"}})),
             "table.separation: the two circles do not overlap");
  EXPECT_HAS(fault(shape("lemon", {{"radius", "1"}, {"separation", "3"}})), "do not overlap");
  EXPECT_HAS(fault(shape("annulus", {{"outer", "1"}, {"inner", "1"}})), "table.inner: ");
  EXPECT_HAS(fault(shape("annulus", {{"outer", "1"}, {"inner", "1/2"}, {"offset", "-0.6"}})),
             "table.offset: the inner circle sticks out");
  EXPECT_HAS(fault(shape("sinai", {{"side", "1"}, {"radius", "0.6"}})),
             "table.radius: the disc does not fit");
  EXPECT_HAS(fault(shape("lorentz", {{"spacing", "1"}, {"radius", "0.6"}})),
             "table.radius: neighbouring discs overlap");
  EXPECT_HAS(fault(shape("regular", {{"sides", "2"}, {"radius", "1"}})), "table.sides: ");
  EXPECT_HAS(fault(shape("regular", {{"sides", "3.5"}, {"radius", "1"}})), "table.sides: ");
}

TEST(Faults, MissingNumbersAreNamed) {
  EXPECT_EQ(fault(shape("rectangle", {{"width", "1"}})),
            "test.toml, line 2, column 1: table.height: the shape 'rectangle' needs 'height' "
            "(expected a number)");
  EXPECT_HAS(fault(shape("polygon")), "needs 'points'");
  EXPECT_HAS(fault(shape("discs", {{"radius", "1"}})), "needs 'centers'");
  EXPECT_HAS(fault(shape("path")), "needs a loop");
}

TEST(Faults, UnknownShapesAndLatticesNameTheNearest) {
  EXPECT_HAS(fault(shape("rectangel")), "did you mean 'rectangle'?");
  TableSpec lorentz = shape("lorentz", {{"spacing", "1"}, {"radius", "1/4"}});
  lorentz.words["lattice"] = "sqare";
  EXPECT_HAS(fault(lorentz), "did you mean 'square'?");
}

TEST(Faults, RadiiMustMatchTheCenters) {
  TableSpec spec = shape("discs");
  spec.points["centers"] = {at("0", "0"), at("3", "0")};
  spec.lists["radii"] = {exact("1", "table.radii[0]")};
  EXPECT_HAS(fault(spec), "1 radii for 2 centers");
  spec.lists["radii"].push_back(exact("0", "table.radii[1]"));
  EXPECT_HAS(fault(spec), "table.radii[1]: must be positive");
  spec.lists["radii"][1] = exact("1");
  EXPECT_EQ(fault(spec), "no fault");
  spec.numbers["radius"] = exact("1");
  EXPECT_HAS(fault(spec), "both given");
}

TEST(Faults, PathsMustClose) {
  TableSpec spec = shape("path");
  spec.loops = {loop(at("0", "0"), {line_to("1", "0"), line_to("1", "1"), line_to("0", "0.1")})};
  EXPECT_HAS(fault(spec), "the path is open: it ends at (0, 0.1)");
  spec.loops = {loop(at("0", "0"), {line_to("1", "0"), line_to("1", "0"), line_to("0", "0")})};
  EXPECT_HAS(fault(spec), "ends where it begins");
  spec.loops = {loop(at("0", "0"), {line_to("1", "0"), arc_to(at("1/2", "0"), at("0", "0"))})};
  EXPECT_HAS(fault(spec), "no circular arc");
  spec.loops = {
      loop(at("0", "0"), {line_to("1", "0", "a"), line_to("1", "1", "a"), line_to("0", "0")})};
  EXPECT_HAS(fault(spec), "two walls are called 'a'");
  spec.loops = {loop(at("0", "0"), {})};
  EXPECT_HAS(fault(spec), "no pieces");
}

TEST(Faults, LatticesMustSpanThePlaneAndLeadSomewhere) {
  TableSpec spec = shape("discs", {{"radius", "1"}});
  spec.points["centers"] = {at("0", "0")};
  spec.lattice =
      LatticeSpec{at("3", "0"), at("6", "0"), Place{"test.toml", 30, 5, "lattice.vectors"}};
  EXPECT_HAS(fault(spec),
             "test.toml, line 30, column 5: lattice.vectors: the lattice vectors are parallel");
  spec.numbers.insert_or_assign("radius", exact("0.2"));
  spec.lattice =
      LatticeSpec{at("1", "0"), at("10000.25", "1"), Place{"test.toml", 30, 5, "lattice.vectors"}};
  EXPECT_HAS(fault(spec),
             "lattice.vectors: the lattice vectors are more than 1024 times as long as it needs");
  EXPECT_HAS(fault(spec), "shorter vectors of the same lattice: [1, 0] and [0.25, 1]");
  spec.lattice = LatticeSpec{at("1", "0"), at("1000.25", "1"), {}};
  EXPECT_EQ(fault(spec), "no fault");
  TableSpec closed = shape("circle", {{"radius", "1"}});
  closed.lattice = LatticeSpec{at("3", "0"), at("0", "3"), {}};
  EXPECT_HAS(fault(closed), "closed by its walls");
  TableSpec own = shape("sinai", {{"side", "1"}, {"radius", "0.4"}});
  own.lattice = closed.lattice;
  EXPECT_HAS(fault(own), "a lattice of its own");
}

}  // namespace
}  // namespace carom::tests
