// Holes of half a turn, arcs that start where angles jump, fields and distances beyond doubles.
#include <gtest/gtest.h>

#include "carom/base/error.hpp"
#include "certify/systems.hpp"
#include "certify/wall/hole.hpp"

namespace carom {
namespace {

using certify::Ball;
using certify::Bound;
using certify::Verdict;
using tests::exactly;
using tests::Shaped;
using tests::task_of;

// Whether it is more than half a turn is not known, but of most points both answers say the same.
TEST(CertifiedExtremes, AHoleOfHalfATurnLetsOrbitsOut) {
  certify::WallOf<Ball> circle;
  circle.form = certify::Form::circle;
  circle.closed = true;
  circle.centre = {0, 0};
  circle.radius2 = 1;
  certify::HoleOf<Ball> hole;
  hole.wide = Verdict::undecided;
  hole.first = {1, 0};
  hole.last = {-1, Ball(0).widened(Bound(0x1p-20))};
  const auto verdict = [&](double x, double y) {
    return certify::in_hole(hole, circle, {Ball(x), Ball(y)});
  };
  EXPECT_EQ(verdict(0, 1), Verdict::yes);
  EXPECT_EQ(verdict(0.6, 0.8), Verdict::yes);
  EXPECT_EQ(verdict(0, -1), Verdict::no);
  EXPECT_EQ(verdict(-0.6, -0.8), Verdict::no);
  EXPECT_EQ(verdict(-1, 0x1p-22), Verdict::undecided);
  EXPECT_EQ(verdict(-1, -0x1p-22), Verdict::undecided);
}

// Half an ellipse, whose arc starts on the negative major axis.
TEST(CertifiedExtremes, ArcsMayStartOnTheNegativeAxis) {
  Shaped s = tests::shaped("path", {}, "0.1", "-0.15");
  LoopSpec loop;
  loop.start = {exactly("-sqrt(2)/2"), exactly("-sqrt(2)/2")};
  PieceSpec half;
  half.kind = PieceSpec::Kind::ellipse;
  half.via = {exactly("sqrt(2)/4"), exactly("-sqrt(2)/4")};
  half.to = {exactly("sqrt(2)/2"), exactly("sqrt(2)/2")};
  half.ratio = exactly("1/2");
  half.angle = exactly("pi/4");
  PieceSpec back;
  back.to = loop.start;
  loop.pieces = {half, back};
  s.spec.loops = {loop};
  HoleSpec hole;
  hole.wall = "wall_1";
  hole.center = exactly("1.2");
  hole.width = exactly("0.3");
  s.spec.holes = {hole};
  CertifiedOrbit through(tests::system_of(s, {exactly("1"), exactly("-1")}), task_of(5, 20));
  EXPECT_EQ(through.finish().fate, CertifiedFate::escaped) << through.end_state().reason;
  EXPECT_EQ(through.end_state().collisions, 0u);
  CertifiedOrbit beside(tests::system_of(s, {exactly("1"), exactly("0")}), task_of(1, 20));
  EXPECT_EQ(beside.finish().fate, CertifiedFate::completed) << beside.end_state().reason;
}

// In a field that is zero in doubles the flight is straight to all digits that are asked for.
TEST(CertifiedExtremes, FieldsMayBeSmallerThanDoubles) {
  const Shaped s = tests::shaped("sinai", {{"side", "1"}, {"radius", "1/5"}}, "0.1", "0.2");
  ExactSystem system = tests::system_of(s, {exactly("0.6"), exactly("0.7")});
  CertifiedOrbit straight(system, task_of(5, 20));
  for (const char* omega : {"1/10^320", "-1/10^400", "1/10^200"}) {
    system.omega = exactly(omega);
    CertifiedOrbit turning(system, task_of(5, 20));
    EXPECT_EQ(turning.finish().fate, CertifiedFate::completed) << turning.end_state().reason;
    EXPECT_EQ(turning.end_state().x.text(20), straight.finish().x.text(20));
    EXPECT_EQ(turning.end_state().t.text(20), straight.finish().t.text(20));
  }
}

TEST(CertifiedExtremes, AStartTooFarFromItsCellIsUndecided) {
  const Shaped s = tests::shaped("sinai", {{"side", "1"}, {"radius", "1/5"}}, "10^20+1/10", "1/5");
  CertifiedOrbit orbit(tests::system_of(s, {exactly("3"), exactly("4")}), task_of(5, 20));
  EXPECT_EQ(orbit.finish().fate, CertifiedFate::undecided);
  EXPECT_EQ(orbit.end_state().reason.find("'disc'"), std::string::npos) << orbit.end_state().reason;
}

TEST(CertifiedExtremes, SpeedsWithoutASquareAreRefused) {
  ExactSystem system =
      tests::system_of(tests::shaped("rectangle", {{"width", "1"}, {"height", "1"}}, "0.2", "0.3"),
                       {exactly("0.6"), exactly("0.7")});
  for (const char* speed : {"1/10^160", "1/10^400", "10^160"}) {
    system.speed = exactly(speed);
    EXPECT_THROW(CertifiedOrbit(system, task_of(5, 20)), InputError) << speed;
  }
}

}  // namespace
}  // namespace carom
