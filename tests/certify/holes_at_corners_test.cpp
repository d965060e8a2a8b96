// Holes that end at a corner or joint, or beside it by less than doubles tell: by the numbers as
// they were written.
#include <gtest/gtest.h>

#include "carom/base/error.hpp"
#include "certify/systems.hpp"
#include "certify/tie_names.hpp"
#include "certify/wall/hole.hpp"

namespace carom {
namespace {

using tests::exactly;
using tests::Shaped;
using tests::task_of;

HoleSpec door(const std::string& wall, const std::string& center, const std::string& width) {
  HoleSpec hole;
  hole.wall = wall;
  hole.center = exactly(center);
  hole.width = exactly(width);
  hole.name = "door";
  return hole;
}

CertifiedEnd end_of(const Shaped& s, const ExactPoint& direction, std::uint64_t collisions = 2) {
  CertifiedOrbit orbit(tests::system_of(s, direction), task_of(collisions, 20));
  return orbit.finish();
}

// A tilted square of which a side has a hole that ends exactly at the corner, and a ray into that.
struct Tilted {
  Shaped square;
  std::string p, q, side;
  ExactPoint to_corner(const std::string& aside = "0") const {
    return {exactly(p + "+" + q + "-(" + aside + ")*(" + q + "-" + p + ")"),
            exactly(q + "-" + p + "+(" + aside + ")*(" + p + "+" + q + ")")};
  }
};
Tilted tilted(int p, int q) {
  Tilted t;
  t.p = "(" + std::to_string(p) + "/10)";
  t.q = "(" + std::to_string(q) + "/10)";
  t.side = "sqrt(" + t.p + "^2+" + t.q + "^2)";
  t.square.spec.shape = "polygon";
  t.square.spec.points["points"] = {{exactly("0"), exactly("0")},
                                    {exactly(t.p), exactly(t.q)},
                                    {exactly(t.p + "-" + t.q), exactly(t.p + "+" + t.q)},
                                    {exactly("-" + t.q), exactly(t.p)}};
  t.square.inside = {exactly("(" + t.p + "-" + t.q + ")/2"),
                     exactly("(" + t.p + "+" + t.q + ")/2")};
  return t;
}

// The side of the square is rational, or (as for 1, 2) the root of no square: then it is not told.
TEST(HolesAtCorners, HolesMayEndExactlyAtCorners) {
  for (const auto& [p, q] : {std::pair{3, 4}, {4, 3}, {8, 6}, {5, 12}, {8, 15}}) {
    Tilted t = tilted(p, q);
    SCOPED_TRACE(t.side);
    t.square.spec.holes = {door("side_1", t.side + "-1/40", "1/20")};
    const CertifiedEnd end = end_of(t.square, t.to_corner());
    ASSERT_EQ(end.fate, CertifiedFate::singular);
    ASSERT_EQ(tests::named_in(end.reason), "1 side_1 side_2");
    // On one side neighbours leave, on the other they are reflected.
    const CertifiedFate beside = end_of(t.square, t.to_corner("1/10^30"), 1).fate,
                        other = end_of(t.square, t.to_corner("-1/10^30"), 1).fate;
    ASSERT_NE(beside == CertifiedFate::escaped, other == CertifiedFate::escaped);
  }
  Tilted t = tilted(1, 2);
  t.square.spec.holes = {door("side_1", t.side + "-1/40", "1/20")};
  EXPECT_EQ(end_of(t.square, t.to_corner()).fate, CertifiedFate::undecided);
}

TEST(HolesAtCorners, HolesMayEndShortOfCorners) {
  for (const auto& [p, q] : {std::pair{1, 2}, {3, 4}, {2, 7}}) {
    Tilted t = tilted(p, q);
    SCOPED_TRACE(t.side);
    t.square.spec.holes = {door("side_1", t.side + "-1/40-1/10^20", "1/20")};
    const CertifiedEnd end = end_of(t.square, t.to_corner());
    EXPECT_EQ(end.fate, CertifiedFate::completed);
    EXPECT_EQ(end.ties.size(), 1u);
    for (const char* aside : {"1/10^30", "-1/10^30"})
      EXPECT_EQ(end_of(t.square, t.to_corner(aside)).fate, CertifiedFate::completed) << aside;
  }
  // At its start: side_2 begins in that corner.
  for (const auto& [center, fate] :
       {std::pair{"1/40", CertifiedFate::singular}, {"1/40+1/10^20", CertifiedFate::completed}}) {
    Tilted t = tilted(1, 2);
    t.square.spec.holes = {door("side_2", center, "1/20")};
    EXPECT_EQ(end_of(t.square, t.to_corner()).fate, fate) << center;
  }
}

// Where an arc ends is known by its length, which contains pi: a hole that ends there is not told
// from one beside.
TEST(HolesAtCorners, HolesMayEndAtJointsOfArcs) {
  for (const char* r : {"1", "1.1", "1/3"}) {
    SCOPED_TRACE(r);
    const std::string radius = std::string("(") + r + ")";
    Shaped s = tests::shaped("stadium", {{"half_length", "1"}, {"radius", r}}, "1/2", "0");
    const ExactPoint into_joint{exactly("1/2"), exactly(radius)};
    EXPECT_EQ(end_of(s, into_joint, 1).fate, CertifiedFate::completed);
    s.spec.holes = {door("right", "pi*" + radius + "-1/20-1/10^20", "1/10")};
    EXPECT_EQ(end_of(s, into_joint, 1).fate, CertifiedFate::completed);
    s.spec.holes = {door("right", "pi*" + radius + "-1/20", "1/10")};
    EXPECT_EQ(end_of(s, into_joint, 1).fate, CertifiedFate::undecided);
    s.spec.holes = {door("right", "1/20", "1/10")};
    EXPECT_EQ(end_of(s, {exactly("1/2"), exactly("-" + radius)}, 1).fate, CertifiedFate::singular);
  }
}

// A hole in all of a wall but 10^-20 of it leaves a piece of wall.
TEST(HolesAtCorners, AllOfAWall) {
  Shaped s = tests::shaped("rectangle", {{"width", "1"}, {"height", "1"}}, "1/2", "1/2");
  const ExactPoint to_the_piece{exactly("1"), exactly("1-1/10^20")},
      below{exactly("1"), exactly("1-3/10^20")};
  s.spec.holes = {door("right", "1/2-1/2/10^20", "1-1/10^20")};
  EXPECT_EQ(end_of(s, to_the_piece, 1).wall, 1);
  EXPECT_EQ(end_of(s, to_the_piece, 1).fate, CertifiedFate::completed);
  EXPECT_EQ(end_of(s, below, 1).fate, CertifiedFate::escaped);
  s.spec.holes = {door("right", "1/2", "1")};
  EXPECT_EQ(end_of(s, to_the_piece, 1).fate, CertifiedFate::escaped);
  Shaped round = tests::shaped("circle", {{"radius", "1"}}, "0", "0");
  round.spec.holes = {door("circle", "1", "2*pi")};
  EXPECT_EQ(end_of(round, {exactly("1"), exactly("0")}, 1).fate, CertifiedFate::escaped);
  round.spec.holes = {door("circle", "pi", "2*pi-1/10^20")};
  const CertifiedEnd piece = end_of(round, {exactly("1"), exactly("0")}, 1);
  EXPECT_EQ(piece.fate, CertifiedFate::completed);
}

TEST(HolesAtCorners, TheReachOfAHoleIsCertified) {
  Shaped s = tests::shaped("stadium", {{"half_length", "1"}, {"radius", "2"}}, "0", "0");
  const ExactSystem system = tests::system_of(s, {1.0, 0.0});
  const auto start = [](const char* center, const char* width) {
    return certify::before_start(door("left", center, width));
  };
  const auto end = [&](const char* wall, const char* center, const char* width) {
    return certify::past_end(system, door(wall, center, width));
  };
  EXPECT_EQ(start("1/3", "2/3"), Sign::zero);
  EXPECT_EQ(start("pi+1/10^300", "2*pi"), Sign::positive);
  EXPECT_EQ(start("pi-1/10^3000", "2*pi"), Sign::negative);
  EXPECT_EQ(end("left", "pi+1/10^300", "2*pi"), Sign::positive);
  EXPECT_EQ(end("left", "pi-1/10^3000", "2*pi"), Sign::negative);
  EXPECT_EQ(end("left", "pi", "2*pi"), Sign::undecided);
  EXPECT_EQ(end("top", "1", "2"), Sign::zero);
  EXPECT_EQ(end("top", "1-1/10^300", "2"), Sign::negative);
}

}  // namespace
}  // namespace carom
