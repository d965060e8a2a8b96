// Exact coincidences on Larmor circles, at corners with curved walls and at holes in them.
#include <gtest/gtest.h>

#include <cmath>

#include "certify/systems.hpp"

namespace carom {
namespace {

using tests::exactly;
using tests::Shaped;
using tests::task_of;

struct Flight {
  const char *x, *y, *u, *v, *omega;
};

ExactSystem flying(Shaped s, const Flight& f) {
  s.inside = {exactly(f.x), exactly(f.y)};
  ExactSystem system = tests::system_of(s, {exactly(f.u), exactly(f.v)});
  system.omega = exactly(f.omega);
  return system;
}
CertifiedEnd end_of(const ExactSystem& system, const CertifiedTask& task) {
  CertifiedOrbit orbit(system, task);
  return orbit.finish();
}
Shaped square() { return tests::shaped("rectangle", {{"width", "1"}, {"height", "1"}}, "0", "0"); }
Shaped room(const char* radius) {
  Shaped s = tests::shaped("sinai", {{"side", "1"}, {"radius", radius}}, "0", "0");
  s.spec.torus = false;
  return s;
}

// Orbits from beside the start, 10^-30 to either side, follow the one through the tie. `from`: the first hit after it.
void expect_limit(ExactSystem system, std::uint64_t from, std::uint64_t hits) {
  CertifiedOrbit exact(system, task_of(hits, 20));
  std::vector<CertifiedHit> through;
  for (const CertifiedHit& hit : exact) through.push_back(hit);
  ASSERT_EQ(through.size(), hits) << exact.end_state().reason;
  ASSERT_FALSE(exact.end_state().ties.empty());
  const std::string x = system.start.position.x.text();
  for (const char* beside : {"+1/10^30", "-1/10^30"}) {
    system.start.position.x = exactly(x + beside);
    CertifiedOrbit other(system, task_of(hits, 20));
    std::uint64_t n = 0;
    for (const CertifiedHit& hit : other) {
      const CertifiedHit& same = through.at(static_cast<std::size_t>(n++));
      EXPECT_NEAR(hit.x.to_double(), same.x.to_double(), 1e-12) << n;
      EXPECT_NEAR(hit.y.to_double(), same.y.to_double(), 1e-12) << n;
      if (n < from) continue;
      EXPECT_NEAR(hit.vx.to_double(), same.vx.to_double(), 1e-12) << n;
      EXPECT_NEAR(hit.vy.to_double(), same.vy.to_double(), 1e-12) << n;
      EXPECT_NEAR(hit.t.to_double(), same.t.to_double(), 1e-12) << n;
    }
    EXPECT_EQ(n, hits);
    EXPECT_TRUE(other.end_state().ties.empty());
  }
}

// The circle in the square touches all sides; one a little larger does not pass them by.
TEST(TiesInFields, TouchesSegments) {
  const CertifiedEnd inscribed = end_of(flying(square(), {"4/5", "9/10", "4", "-3", "2"}), task_of(5, 20));
  EXPECT_EQ(inscribed.fate, CertifiedFate::pinned);
  EXPECT_EQ(inscribed.collisions, 0u);
  ASSERT_EQ(inscribed.ties.size(), 4u);
  for (const std::string& tie : inscribed.ties) EXPECT_NE(tie.find(", which is no hit"), std::string::npos) << tie;
  const CertifiedEnd larger = end_of(flying(square(), {"4/5", "9/10", "4", "-3", "2-1/10^40"}), task_of(5, 20));
  EXPECT_EQ(larger.fate, CertifiedFate::completed);
  EXPECT_TRUE(larger.ties.empty());
  const CertifiedEnd smaller = end_of(flying(square(), {"4/5", "9/10", "4", "-3", "2+1/10^40"}), task_of(5, 20));
  EXPECT_TRUE(smaller.ties.empty());
  // The top, and then the left side; about (1/2, 1/4) with the radius 3/4.
  const CertifiedEnd one = end_of(flying(square(), {"19/20", "17/20", "-4", "3", "-4/3"}), task_of(1, 20));
  ASSERT_EQ(one.ties.size(), 1u);
  EXPECT_EQ(one.ties[0], "event 1: exactly tangent to 'top', which is no hit");
  EXPECT_EQ(one.wall, 3);
  EXPECT_EQ(one.y.text(10), "0.8090169944");  // 1/4 + sqrt(9/16 - 1/4)
}

TEST(TiesInFields, TouchesCircles) {
  // From outside, and then the bottom; around the disc; from inside a circle.
  const CertifiedEnd outside = end_of(flying(room("1/5"), {"31/50", "13/50", "-4", "3", "-5"}), task_of(1, 20));
  ASSERT_EQ(outside.ties.size(), 1u);
  EXPECT_EQ(outside.ties[0], "event 1: exactly tangent to 'disc', which is no hit");
  EXPECT_EQ(outside.wall, 1);
  for (const char* omega : {"10/3", "-10/3"}) {
    const bool clockwise = omega[0] != '-';
    const Flight flight{"17/25", "16/25", clockwise ? "4" : "-4", clockwise ? "-3" : "3", omega};
    const CertifiedEnd around = end_of(flying(room("1/5"), flight), task_of(5, 20));
    EXPECT_EQ(around.fate, CertifiedFate::pinned);
    ASSERT_EQ(around.ties.size(), 1u);
    EXPECT_EQ(around.ties[0], "event 1: exactly tangent to 'disc', which is no hit");
    EXPECT_EQ(end_of(flying(room("1/5+1/10^40"), flight), task_of(1, 20)).wall, 0);
    EXPECT_EQ(end_of(flying(room("1/5-1/10^40"), flight), task_of(1, 20)).fate, CertifiedFate::pinned);
  }
  const Shaped disc = tests::shaped("circle", {{"radius", "1"}}, "0", "0");
  const CertifiedEnd inside = end_of(flying(disc, {"4/5", "2/5", "4", "-3", "2"}), task_of(5, 20));
  EXPECT_EQ(inside.fate, CertifiedFate::pinned);
  ASSERT_EQ(inside.ties.size(), 1u);
  EXPECT_EQ(inside.ties[0], "event 1: exactly tangent to 'circle', which is no hit");
}

// Through J = P + d from P along v: 2 omega v.(d_y, -d_x) + omega^2 d^2 = 0.
TEST(TiesInFields, CornersAndJoints) {
  const ExactSystem corner = flying(square(), {"3/10", "1/5", "3/5", "4/5", "16/113"});
  const CertifiedEnd end = end_of(corner, task_of(2, 20));
  ASSERT_EQ(end.ties.size(), 1u);
  EXPECT_EQ(end.ties[0], "event 1: exactly into the corner between 'right' and 'top', whose angle is pi/2");
  EXPECT_EQ(end.x.text(15), "1.000000000000000");
  EXPECT_EQ(end.y.text(15), "1.000000000000000");
  // It comes with (3/5, 4/5) + omega (4/5, -7/10) and turns back.
  EXPECT_NEAR(end.vx.to_double(), -(0.6 + 16.0 / 113.0 * 0.8), 1e-15);
  EXPECT_NEAR(end.vy.to_double(), -(0.8 - 16.0 / 113.0 * 0.7), 1e-15);
  expect_limit(corner, 2, 12);
  const Shaped stadium = tests::shaped("stadium", {{"half_length", "1"}, {"radius", "1"}}, "0", "0");
  const ExactSystem joint = flying(stadium, {"3/5", "1/5", "4", "3", "-1"});
  const CertifiedEnd smooth = end_of(joint, task_of(1, 20));
  ASSERT_EQ(smooth.ties.size(), 1u);
  EXPECT_EQ(smooth.ties[0],
            "event 1: exactly into the joint between 'right' and 'top', where they have one tangent");
  EXPECT_EQ(smooth.vy.text(10), "-1.0000000000");
  expect_limit(joint, 1, 8);
  // Into a reflex corner there is no limit.
  const Shaped mushroom = tests::shaped(
      "mushroom", {{"cap_radius", "1"}, {"stem_width", "1"}, {"stem_height", "1"}}, "0", "0");
  const CertifiedEnd neck = end_of(flying(mushroom, {"-1/5", "1/5", "1", "0", "40/53"}), task_of(3, 20));
  EXPECT_EQ(neck.fate, CertifiedFate::singular);
  EXPECT_EQ(neck.reason, "event 1: exactly into the corner between 'stem_right' and 'brim_right'");
}

// Lemons of two arcs; a cap on a brim.
TEST(CurvedCorners, HaveALimit) {
  for (const auto& [separation, height, n] :
       {std::tuple{"sqrt(2)", "sqrt(2)/2", 2u}, {"sqrt(3)", "1/2", 3u}}) {
    const Shaped lemon = tests::shaped("lemon", {{"radius", "1"}, {"separation", separation}}, "0", "0");
    const ExactSystem system = flying(lemon, {"1/20", "0", "-1/20", height, "0"});
    const CertifiedEnd end = end_of(system, task_of(n, 20));
    ASSERT_EQ(end.ties.size(), 1u) << end.reason;
    EXPECT_EQ(end.ties[0], "event 1: exactly into the corner between 'right' and 'left', whose angle is pi/" +
                               std::to_string(n));
    expect_limit(system, n, n + 8);
  }
  const Shaped mushroom = tests::shaped(
      "mushroom", {{"cap_radius", "1"}, {"stem_width", "1"}, {"stem_height", "1"}}, "0", "0");
  const ExactSystem cap = flying(mushroom, {"1/10", "2/5", "9", "-4", "0"});
  EXPECT_EQ(end_of(cap, task_of(2, 20)).ties.at(0),
            "event 1: exactly into the corner between 'brim_right' and 'cap', whose angle is pi/2");
  expect_limit(cap, 2, 12);
  // (1, 0) from (1/10, 2/5) along (1, 0): d = (9, -4)/10, v.(d_y, -d_x) = -2/5, d^2 = 97/100.
  expect_limit(flying(mushroom, {"1/10", "2/5", "1", "0", "80/97"}), 2, 10);
  // Of no such angle.
  const Shaped blunt = tests::shaped("lemon", {{"radius", "1"}, {"separation", "1"}}, "0", "0");
  EXPECT_EQ(end_of(flying(blunt, {"1/20", "0", "-1/20", "sqrt(3)/2", "0"}), task_of(3, 20)).reason,
            "event 1: exactly into the corner between 'right' and 'left'");
}

HoleSpec hole_in(const char* wall, const char* center, const char* width) {
  HoleSpec hole;
  hole.wall = wall;
  hole.center = exactly(center);
  hole.width = exactly(width);
  hole.name = "door";
  return hole;
}

TEST(CurvedHoles, EndsAreNamed) {
  Shaped disc = tests::shaped("circle", {{"radius", "1"}}, "0", "0");
  disc.spec.holes = {hole_in("circle", "pi/2", "pi/3")};
  const CertifiedEnd start = end_of(flying(disc, {"1/2", "0", "0", "1", "0"}), task_of(3, 20));
  EXPECT_EQ(start.fate, CertifiedFate::escaped);
  EXPECT_EQ(start.ties.at(0), "event 1: exactly at the start of hole 'door' in 'circle', which belongs to it");
  const CertifiedEnd end = end_of(flying(disc, {"-1/2", "0", "0", "1", "0"}), task_of(1, 20));
  EXPECT_EQ(end.fate, CertifiedFate::completed);
  EXPECT_EQ(end.ties.at(0), "event 1: exactly at the end of hole 'door' in 'circle', which does not belong to it");
  // In a field, about (7/10, -2/5) with the radius 1/2, clockwise to (1, 0).
  disc.spec.holes = {hole_in("circle", "pi/2", "pi")};
  const CertifiedEnd east = end_of(flying(disc, {"1/5", "-2/5", "0", "1", "2"}), task_of(1, 20));
  EXPECT_EQ(east.ties.size(), 1u);
  EXPECT_EQ(east.fate, CertifiedFate::escaped) << east.reason;
  Shaped stadium = tests::shaped("stadium", {{"half_length", "1"}, {"radius", "1"}}, "0", "0");
  stadium.spec.holes = {hole_in("right", "pi/2", "pi/2")};
  const CertifiedEnd cap = end_of(flying(stadium, {"0", "-sqrt(2)/2", "1", "0", "0"}), task_of(3, 20));
  EXPECT_EQ(cap.fate, CertifiedFate::escaped) << cap.reason;
  EXPECT_EQ(cap.ties.at(0), "event 1: exactly at the start of hole 'door' in 'right', which belongs to it");
  // A number without pi is no tie on a circle: of the angles 3/4 and 5/4 precision tells.
  disc.spec.holes = {hole_in("circle", "1", "1/2")};
  const CertifiedEnd beside = end_of(flying(disc, {"0", "0", "73169/100000", "68164/100000", "0"}), task_of(1, 20));
  EXPECT_TRUE(beside.ties.empty());
  Shaped ellipse = tests::shaped("ellipse", {{"a", "1"}, {"b", "1/2"}}, "0", "0");
  ellipse.spec.holes = {hole_in("ellipse", "1/10", "1/5")};
  const CertifiedEnd vertex = end_of(flying(ellipse, {"2/5", "1/5", "3", "-1", "0"}), task_of(1, 20));
  EXPECT_EQ(vertex.fate, CertifiedFate::escaped) << vertex.reason;
  EXPECT_EQ(vertex.ties.at(0), "event 1: exactly at the start of hole 'door' in 'ellipse', which belongs to it");
}

// x = 1/2 + sin(theta): the right side after a twelfth of a turn.
TEST(TiesInFields, HitsAtTheLastTime) {
  const Shaped tall = tests::shaped("rectangle", {{"width", "1"}, {"height", "2"}}, "0", "0");
  const ExactSystem system = flying(tall, {"1/2", "1/2", "1", "0", "-1"});
  CertifiedTask task;
  task.t_max = exactly("pi/6");
  const CertifiedEnd end = end_of(system, task);
  EXPECT_EQ(end.collisions, 1u);
  EXPECT_EQ(end.ties.at(0), "event 1: 'right' is met exactly at the last time: the hit counts");
  // The same place on the circle, but one turn later.
  task.t_max = exactly("pi/6+2*pi");
  EXPECT_GT(end_of(system, task).collisions, 1u);
  task.t_max = exactly("pi/6-1/10^40");
  EXPECT_EQ(end_of(system, task).collisions, 0u);
  task.t_max = exactly("pi/6+1/10^40");
  const CertifiedEnd after = end_of(system, task);
  EXPECT_EQ(after.collisions, 1u);
  EXPECT_TRUE(after.ties.empty());
}

// What algebra of one root cannot tell ends undecided, and says why.
TEST(TiesInFields, SaysWhatItCannotTell) {
  // Into joints of elliptic arcs, as LarmorExits.BesideAJoint.
  const Shaped s = tests::all_shapes().back();
  int untold = 0;
  for (const auto& [x, y] : {std::pair{"3/10", "3/10"}, {"1/2", "1/5"}, {"2/5", "7/10"}}) {
    for (const auto& [u, v] : {std::pair{"0", "1"}, {"1", "0"}, {"0", "0"}}) {
      const std::string dx = std::string("(") + u + "-" + x + ")", dy = std::string("(") + v + "-" + y + ")";
      const std::string omega = "-2*" + dy + "/(" + dx + "^2+" + dy + "^2)";
      const CertifiedEnd end = end_of(flying(s, {x, y, "1", "0", omega.c_str()}), task_of(1, 20));
      if (end.fate != CertifiedFate::undecided) continue;
      ++untold;
      EXPECT_NE(end.reason.find("event 1: "), std::string::npos) << end.reason;
      EXPECT_NE(end.reason.find("nor by numbers a + b sqrt(d): an angle that is"), std::string::npos)
          << end.reason;
    }
  }
  EXPECT_GT(untold, 2);
}

// A segment in the line of flight, but behind a wall, is not met. Turned by 3-4-5, so that balls cannot tell.
TEST(CertifiedTies, InLineWithASegmentBehindAWall) {
  Shaped s = tests::shaped("polygon", {}, "0", "0");
  const auto turned = [](const char* a, const char* b) {
    const std::string x = std::string("(3*(") + a + ")-4*(" + b + "))/5", y = std::string("(4*(") + a + ")+3*(" + b + "))/5";
    return ExactPoint{exactly(x), exactly(y)};
  };
  for (const auto& [a, b] : {std::pair{"0", "0"}, {"3", "0"}, {"3", "1"}, {"2", "1"}, {"2", "1/2"}, {"1", "1/2"},
                            {"1", "2"}, {"0", "2"}})
    s.spec.points["points"].push_back(turned(a, b));
  s.inside = turned("1/2", "1");
  const CertifiedEnd end = end_of(tests::system_of(s, {exactly("3"), exactly("4")}), task_of(1, 20));
  EXPECT_EQ(end.fate, CertifiedFate::completed) << end.reason;
  EXPECT_EQ(end.wall, 5);
  // Without the wall between, it runs into it.
  s.spec.points["points"][4] = turned("2", "3/2");
  s.spec.points["points"][5] = turned("1", "3/2");
  const CertifiedEnd along = end_of(tests::system_of(s, {exactly("3"), exactly("4")}), task_of(1, 20));
  EXPECT_EQ(along.fate, CertifiedFate::singular) << along.reason;
}

}  // namespace
}  // namespace carom
