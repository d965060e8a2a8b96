// Exact coincidences of straight flights at curved walls: at corners, and at holes in them.
#include <gtest/gtest.h>

#include <cmath>

#include "certify/systems.hpp"
#include "certify/tie_names.hpp"

namespace carom {
namespace {

using tests::exactly;
using tests::Shaped;
using tests::task_of;

struct Flight {
  const char *x, *y, *u, *v;
};

ExactSystem flying(Shaped s, const Flight& f) {
  s.inside = {exactly(f.x), exactly(f.y)};
  return tests::system_of(s, {exactly(f.u), exactly(f.v)});
}
CertifiedEnd end_of(const ExactSystem& system, const CertifiedTask& task) {
  CertifiedOrbit orbit(system, task);
  return orbit.finish();
}

// Orbits from beside the start, 10^-30 to either side, follow the one through the tie. `from`: the
// first hit after it.
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

TEST(CurvedCorners, HaveALimit) {
  const Shaped mushroom = tests::shaped(
      "mushroom", {{"cap_radius", "1"}, {"stem_width", "1"}, {"stem_height", "1"}}, "0", "0");
  const ExactSystem cap = flying(mushroom, {"1/10", "2/5", "9", "-4"});
  EXPECT_EQ(tests::named_in(end_of(cap, task_of(2, 20)).ties.at(0)), "1 brim_right cap pi/2");
  expect_limit(cap, 2, 12);
  // A lemon of two arcs: its tips at (0, 1) and (0, -1) have no such angle.
  const Shaped lemon = tests::shaped("lemon", {{"radius", "5/4"}, {"separation", "3/2"}}, "0", "0");
  EXPECT_EQ(
      tests::named_in(end_of(flying(lemon, {"1/20", "0", "-1/20", "1"}), task_of(3, 20)).reason),
      "1 right left");
}

HoleSpec hole_in(const char* wall, const char* center, const char* width) {
  HoleSpec hole;
  hole.wall = wall;
  hole.center = exactly(center);
  hole.width = exactly(width);
  hole.name = "door";
  return hole;
}

// At the start of a curve. Elsewhere the ends of holes in circles contain pi, or no rational point
// of the circle lies there.
TEST(CurvedHoles, EndsAreNamed) {
  Shaped disc = tests::shaped("circle", {{"radius", "1"}}, "0", "0");
  disc.spec.holes = {hole_in("circle", "1/10", "1/5")};
  const CertifiedEnd start = end_of(flying(disc, {"1/2", "0", "1", "0"}), task_of(3, 20));
  EXPECT_EQ(start.fate, CertifiedFate::escaped);
  EXPECT_EQ(tests::named_in(start.ties.at(0)), "1 door circle");
  disc.spec.holes = {hole_in("circle", "1", "1/2")};  // of the angles 3/4 and 5/4 precision tells
  const CertifiedEnd beside =
      end_of(flying(disc, {"0", "0", "73169/100000", "68164/100000"}), task_of(1, 20));
  EXPECT_TRUE(beside.ties.empty());
  disc.spec.holes = {hole_in("circle", "pi/2", "pi")};
  CertifiedTask task = task_of(1, 20);
  task.most_bits_a_doubt = 1 << 10;
  EXPECT_EQ(end_of(flying(disc, {"1/2", "0", "1", "0"}), task).fate, CertifiedFate::undecided);
  Shaped ellipse = tests::shaped("ellipse", {{"a", "1"}, {"b", "1/2"}}, "0", "0");
  ellipse.spec.holes = {hole_in("ellipse", "1/10", "1/5")};
  const CertifiedEnd vertex = end_of(flying(ellipse, {"2/5", "1/5", "3", "-1"}), task_of(1, 20));
  EXPECT_EQ(vertex.fate, CertifiedFate::escaped) << vertex.reason;
  EXPECT_EQ(tests::named_in(vertex.ties.at(0)), "1 door ellipse");
}

// A segment in the line of flight, but behind a wall, is not met. Turned by 3-4-5, so that balls
// cannot tell.
TEST(CertifiedTies, ASegmentBehindAWallMayLieInLine) {
  Shaped s = tests::shaped("polygon", {}, "0", "0");
  const auto turned = [](const char* a, const char* b) {
    const std::string x = std::string("(3*(") + a + ")-4*(" + b + "))/5",
                      y = std::string("(4*(") + a + ")+3*(" + b + "))/5";
    return ExactPoint{exactly(x), exactly(y)};
  };
  for (const auto& [a, b] : {std::pair{"0", "0"},
                             {"3", "0"},
                             {"3", "1"},
                             {"2", "1"},
                             {"2", "1/2"},
                             {"1", "1/2"},
                             {"1", "2"},
                             {"0", "2"}})
    s.spec.points["points"].push_back(turned(a, b));
  s.inside = turned("1/2", "1");
  const CertifiedEnd end =
      end_of(tests::system_of(s, {exactly("3"), exactly("4")}), task_of(1, 20));
  EXPECT_EQ(end.fate, CertifiedFate::completed) << end.reason;
  EXPECT_EQ(end.wall, 5);
  // Without the wall between, it runs into it.
  s.spec.points["points"][4] = turned("2", "3/2");
  s.spec.points["points"][5] = turned("1", "3/2");
  const CertifiedEnd along =
      end_of(tests::system_of(s, {exactly("3"), exactly("4")}), task_of(1, 20));
  EXPECT_EQ(along.fate, CertifiedFate::singular) << along.reason;
}

}  // namespace
}  // namespace carom
