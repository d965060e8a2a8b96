// Exact coincidences have a name, in bounded time.
#include <gtest/gtest.h>

#include <cmath>

#include "certify/number/rational.hpp"
#include "certify/systems.hpp"
#include "certify/tie_names.hpp"

namespace carom {
namespace {

using certify::Rational;
using tests::exactly;
using tests::Shaped;

CertifiedEnd end_of(const Shaped& s, const ExactPoint& direction, std::uint64_t collisions,
                    const char* t = nullptr) {
  CertifiedTask task;
  task.collisions = collisions;
  if (t != nullptr) task.t_max = exactly(t);
  CertifiedOrbit orbit(tests::system_of(s, direction), task);
  return orbit.finish();
}

Shaped square(const char* x, const char* y) {
  return tests::shaped("rectangle", {{"width", "1"}, {"height", "1"}}, x, y);
}

TEST(Rational, KnowsRationalNumbersOnly) {
  const Rational x(exactly("2/3+sqrt(1/4)")), root(exactly("sqrt(2)"));
  EXPECT_EQ(sign(x - Rational(7) / Rational(6)), Sign::zero);
  EXPECT_EQ(sign(sqrt(square(x)) - x), Sign::zero);
  EXPECT_EQ(sign(Rational(exactly("1/10")) - Rational(0.1)), Sign::negative);
  for (const Rational& unknown :
       {root, Rational(exactly("pi")), sqrt(Rational(3)), root * root, Rational(1) / Rational(0)})
    EXPECT_THROW(sign(unknown), certify::NotRational);
}

// It turns back, by two reflections.
TEST(CertifiedTies, CornersOfTheSquareTurnOrbitsBack) {
  const CertifiedEnd back = end_of(square("1/2", "1/4"), {exactly("2"), exactly("3")}, 2);
  EXPECT_EQ(back.fate, CertifiedFate::completed);
  ASSERT_EQ(back.ties.size(), 1u);
  EXPECT_EQ(tests::named_in(back.ties[0]), "1 right top pi/2");
  EXPECT_EQ(back.x.text(20), "1.00000000000000000000");
  EXPECT_EQ(back.y.text(20), "1.00000000000000000000");
  EXPECT_EQ(back.vx.text(10), "-0.5547001962");
  EXPECT_EQ(back.vy.text(10), "-0.8320502943");
  // (1/10, 1/10) along (29, 9): x = 3, y = 1 after a tenth of the way, by the sides 1 and 2.
  const CertifiedEnd far = end_of(square("1/10", "1/10"), {exactly("29"), exactly("9")}, 100);
  EXPECT_EQ(far.fate, CertifiedFate::completed);
  ASSERT_GE(far.ties.size(), 1u);
  EXPECT_EQ(tests::named_in(far.ties[0]), "3 right top pi/2");
}

// From (1/10, 1/10) to the lattice point (301, 200) and all the way back.
TEST(CertifiedTies, ACornerIsMetAfterManyHits) {
  CertifiedTask task;
  task.t_max = exactly("2*sqrt((301-1/10)^2+(200-1/10)^2)");
  CertifiedOrbit orbit(tests::system_of(square("1/10", "1/10"), {exactly("3009"), exactly("1999")}),
                       task);
  const CertifiedEnd& end = orbit.finish();
  EXPECT_EQ(end.fate, CertifiedFate::completed);
  ASSERT_EQ(end.ties.size(), 1u);
  EXPECT_EQ(tests::named_in(end.ties[0]), "500 bottom right pi/2");
  EXPECT_EQ(end.collisions, 2u * (300 + 199) + 2);
  EXPECT_EQ(end.x.text(20), "0.10000000000000000000");
  EXPECT_EQ(end.y.text(20), "0.10000000000000000000");
}

// Of pi/2 and pi/4; other corners have no limit.
TEST(CertifiedTies, CornersInOtherShapesReflectByTheirAngle) {
  const Shaped tall = tests::shaped("rectangle", {{"width", "1"}, {"height", "3/2"}}, "1/2", "3/4");
  const CertifiedEnd diagonal = end_of(tall, {exactly("2"), exactly("3")}, 8);
  ASSERT_EQ(diagonal.ties.size(), 4u);  // to and fro between two corners
  EXPECT_EQ(tests::named_in(diagonal.ties[3]), "7 left bottom pi/2");
  Shaped blunt = tests::shaped("triangle", {}, "1", "1/2");
  blunt.spec.points["points"] = {
      {exactly("0"), exactly("0")}, {exactly("2"), exactly("0")}, {exactly("1"), exactly("1.5")}};
  const CertifiedEnd without = end_of(blunt, {exactly("0"), exactly("1")}, 10);
  EXPECT_EQ(without.fate, CertifiedFate::singular);
  EXPECT_EQ(tests::named_in(without.reason), "1 side_2 side_3");
  Shaped wedge = tests::shaped("triangle", {}, "1/2", "1/10");
  wedge.spec.points["points"] = {
      {exactly("0"), exactly("0")}, {exactly("1"), exactly("0")}, {exactly("1"), exactly("1")}};
  const CertifiedEnd end = end_of(wedge, {exactly("-5"), exactly("-1")}, 4);
  ASSERT_EQ(end.ties.size(), 1u);
  EXPECT_NE(end.ties[0].find("pi/4"), std::string::npos) << end.ties[0];
  EXPECT_EQ(end.x.text(15), "0.000000000000000");
  // Four reflections turn it back.
  EXPECT_EQ(end.vx.text(10), "0.9805806757");
  EXPECT_EQ(end.vy.text(10), "0.1961161351");
  EXPECT_EQ(end_of(wedge, {exactly("-5"), exactly("-1")}, 24).fate, CertifiedFate::completed);
}

// As the double engine does: (1, 1), (2, 0), (1, -1), (-1, 1), (-2, 0), (-1, -1) and again.
TEST(CertifiedTies, ReflectsAtSmoothJoints) {
  const Shaped stadium =
      tests::shaped("stadium", {{"half_length", "1"}, {"radius", "1"}}, "0", "0");
  const CertifiedEnd end = end_of(stadium, {exactly("1"), exactly("1")}, 12);
  EXPECT_EQ(end.fate, CertifiedFate::completed);
  EXPECT_EQ(end.collisions, 12u);
  ASSERT_EQ(end.ties.size(), 8u);
  EXPECT_EQ(tests::named_in(end.ties[0]), "1 right top");
  EXPECT_EQ(tests::named_in(end.ties[2]), "4 top left");
  EXPECT_EQ(end.x.text(20), "-1.00000000000000000000");
  EXPECT_EQ(end.y.text(20), "-1.00000000000000000000");
  CertifiedOrbit before(tests::system_of(stadium, {exactly("1"), exactly("1")}), [] {
    CertifiedTask task;
    task.collisions = 5;
    return task;
  }());
  EXPECT_EQ(before.finish().x.text(20), "-2.00000000000000000000");
}

TEST(CertifiedTies, TouchesADisc) {
  Shaped sinai = tests::shaped("sinai", {{"side", "1"}, {"radius", "1/5"}}, "1/10", "3/10");
  sinai.spec.torus = false;
  // To and fro along a line that touches the disc: no hit, each time.
  const CertifiedEnd end = end_of(sinai, {exactly("1"), exactly("0")}, 10);
  EXPECT_EQ(end.fate, CertifiedFate::completed);
  EXPECT_EQ(end.collisions, 10u);
  ASSERT_EQ(end.ties.size(), 10u);
  EXPECT_EQ(tests::named_in(end.ties[3]), "4 disc");
  EXPECT_EQ(end.x.text(10), "0.0000000000");
  EXPECT_EQ(end.y.text(10), "0.3000000000");
  // On the torus along the edge of a corridor: no other disc will follow.
  sinai.spec.torus = true;
  const CertifiedEnd corridor = end_of(sinai, {exactly("1"), exactly("0")}, 10);
  EXPECT_EQ(corridor.fate, CertifiedFate::singular);
  EXPECT_EQ(tests::named_in(corridor.reason), "1 disc");
  // 3-4-5: after the bottom at (1/10, 0) the line along (4, 3) passes (1/2, 1/2) at |4/2 - 3
  // (2/5)|/5 = 4/25.
  Shaped beside = tests::shaped("sinai", {{"side", "1"}, {"radius", "4/25"}}, "1/20", "3/80");
  beside.spec.torus = false;
  const CertifiedEnd touched = end_of(beside, {exactly("4"), exactly("-3")}, 2);
  EXPECT_EQ(touched.wall, 2);  // the right side, after the bottom
  ASSERT_EQ(touched.ties.size(), 1u);
  EXPECT_EQ(tests::named_in(touched.ties[0]), "2 disc");
  // A disc larger by 1/10^40 is hit, one smaller is not touched.
  for (const auto& [radius, wall] : {std::pair{"4/25+1/10^40", 0}, {"4/25-1/10^40", 2}}) {
    beside.spec.numbers["radius"] = exactly(radius);
    const CertifiedEnd missed = end_of(beside, {exactly("4"), exactly("-3")}, 2);
    EXPECT_EQ(missed.wall, wall);
    EXPECT_TRUE(missed.ties.empty());
  }
}

HoleSpec door(const char* center, const char* width) {
  HoleSpec hole;
  hole.wall = "right";
  hole.center = exactly(center);
  hole.width = exactly(width);
  hole.name = "door";
  return hole;
}

// The orbit along (2, 1) is periodic and meets the right side at heights 1/2 and … exactly.
TEST(CertifiedTies, EndsOfAHoleAreDecided) {
  Shaped s = square("0.1", "0.3");
  // Straight across: (1, 3/10) again and again.
  s.spec.holes = {door("4/10", "2/10")};
  const CertifiedEnd start = end_of(s, {exactly("1"), exactly("0")}, 10);
  EXPECT_EQ(start.fate, CertifiedFate::escaped);
  ASSERT_EQ(start.ties.size(), 1u);
  EXPECT_EQ(tests::named_in(start.ties[0]), "1 door right");
  s.spec.holes = {door("2/10", "2/10")};
  const CertifiedEnd end = end_of(s, {exactly("1"), exactly("0")}, 10);
  EXPECT_EQ(end.fate, CertifiedFate::completed);
  EXPECT_EQ(end.collisions, 10u);
  ASSERT_EQ(end.ties.size(), 5u);
  EXPECT_EQ(tests::named_in(end.ties[4]), "9 door right");
  // For ever: named, and ended after a thousand of them.
  const CertifiedEnd forever = end_of(s, {exactly("1"), exactly("0")}, 100'000);
  EXPECT_EQ(forever.fate, CertifiedFate::singular);
  EXPECT_EQ(forever.ties.size(), 1000u);
  EXPECT_EQ(tests::named_in(forever.reason), "2001 door right");
}

// The point where one hole ends and the next one starts belongs to the next, in whatever order they
// are written.
TEST(CertifiedTies, AnOrbitMayPassBetweenTwoHoles) {
  for (const bool swapped : {false, true}) {
    Shaped s = square("0.1", "0.3");
    s.spec.holes = {door("2/10", "2/10"), door("4/10", "2/10")};
    s.spec.holes[1].name = "window";
    if (swapped) std::swap(s.spec.holes[0], s.spec.holes[1]);
    const ExactSystem system = tests::system_of(s, {exactly("1"), exactly("0")});
    CertifiedTask task;
    task.collisions = 10;
    CertifiedOrbit orbit(system, task);
    const CertifiedEnd end = orbit.finish();
    EXPECT_EQ(end.fate, CertifiedFate::escaped);
    ASSERT_GE(end.hole, 0);
    EXPECT_EQ(system.table->holes[static_cast<std::size_t>(end.hole)].name, "window") << swapped;
    EXPECT_EQ(end.ties.size(), 1u);
  }
}

// Into a corner at which a hole ends there is no limit of orbits beside.
TEST(CertifiedTies, CornersWithAHoleAreDecided) {
  Shaped s = square("1/2", "1/4");
  s.spec.holes = {door("9/10", "2/10")};
  const CertifiedEnd end = end_of(s, {exactly("2"), exactly("3")}, 2);
  EXPECT_EQ(end.fate, CertifiedFate::singular);
  EXPECT_EQ(tests::named_in(end.reason), "1 right top");
  s.spec.holes = {door("1/2", "2/10")};
  EXPECT_EQ(end_of(s, {exactly("2"), exactly("3")}, 2).fate, CertifiedFate::completed);
}

TEST(CertifiedTies, HitsAtTheLastTimeCount) {
  const CertifiedEnd end = end_of(square("1/2", "1/4"), {exactly("3/5"), exactly("4/5")}, 0, "5/6");
  EXPECT_EQ(end.fate, CertifiedFate::completed);
  EXPECT_EQ(end.collisions, 1u);
  EXPECT_EQ(end.t.text(10), "0.8333333333");
  ASSERT_EQ(end.ties.size(), 1u);
  EXPECT_EQ(tests::named_in(end.ties[0]), "1 right");
}

// Ties of other numbers, and in fields, end at a stated precision, with what was not told.
TEST(CertifiedTies, TiesWithoutRationalNumbersAreUndecided) {
  const Shaped s = tests::shaped("rectangle", {{"width", "pi"}, {"height", "pi"}}, "pi/2", "pi/2");
  const CertifiedEnd end = end_of(s, {exactly("1"), exactly("1")}, 10);
  EXPECT_EQ(end.fate, CertifiedFate::undecided);
  EXPECT_NE(end.reason.find("event 1: "), std::string::npos) << end.reason;
  const Shaped hexagon = tests::shaped("regular", {{"sides", "6"}, {"radius", "1"}}, "0", "0");
  EXPECT_EQ(end_of(hexagon, {exactly("1"), exactly("sqrt(3)")}, 10).fate, CertifiedFate::undecided);
  Shaped open = tests::shaped("rectangle", {{"width", "1"}, {"height", "pi"}}, "1/2", "pi/4");
  open.spec.holes = {door("1", "2-pi/2")};
  const CertifiedEnd beside = end_of(open, {exactly("1"), exactly("0")}, 10);
  EXPECT_EQ(beside.fate, CertifiedFate::undecided);
  EXPECT_EQ(beside.collisions, 0u);
  EXPECT_NE(beside.reason.find("'door'"), std::string::npos) << beside.reason;
  // On a Larmor circle that touches all sides of the square.
  ExactSystem turning = tests::system_of(square("4/5", "9/10"), {exactly("4"), exactly("-3")});
  turning.omega = exactly("2");
  CertifiedTask task;
  task.collisions = 5;
  task.most_bits_a_doubt = 1 << 10;
  EXPECT_EQ(CertifiedOrbit(turning, task).finish().fate, CertifiedFate::undecided);
  turning.omega = exactly("2-1/10^40");
  EXPECT_EQ(CertifiedOrbit(turning, task).finish().fate, CertifiedFate::completed);
}

}  // namespace
}  // namespace carom
