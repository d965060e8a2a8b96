// Exits of Larmor circles from elliptic arcs, next to where an arc ends.
#include <gtest/gtest.h>

#include <cmath>

#include "certify/enclosure/tangent.hpp"
#include "certify/flight/larmor_wall.hpp"
#include "certify/systems.hpp"
#include "certify/wall/table_builder.hpp"
#include "random_tables.hpp"

namespace carom {
namespace {

using certify::Ball;
using certify::BallVector;
using certify::Dual;
using certify::Interval;
using certify::Kappa;
using certify::Precision;
using certify::VectorOf;
using certify::WallOf;
using tests::exactly;
using tests::Shaped;

template <class N>
using DualVector = VectorOf<Dual<N>>;

// The place and how it moves with the start.
template <class N>
Kappa<Dual<N>> moving_exit(const WallOf<N>& w, const VectorOf<N>& P, const VectorOf<N>& v,
                           const certify::MotionOf<N>& motion) {
  const N one(1), zero{};
  const DualVector<N> position{{P.x, {one, zero, zero, zero}}, {P.y, {zero, one, zero, zero}}};
  const DualVector<N> velocity{{v.x, {zero, zero, one, zero}}, {v.y, {zero, zero, zero, one}}};
  return certify::ellipse_exit<N>(w, position, velocity, motion, false);
}

Interval around(const Ball& x) { return certify::interval_of(x); }

// An arc that ends within 2^-100 of where the Larmor circle leaves the ellipse for the first time,
// and holds where it leaves it for the second time. Intervals cannot know which of the two is on
// the wall, and must not say the other.
TEST(LarmorExits, ExitsNextToAnArcsEndAreDecided) {
  tests::Dice dice(61);
  const Precision precision(400);
  long cases = 0, known = 0;
  while (cases < 200) {
    const double ratio = dice.between(0.3, 0.8);
    WallOf<Ball> w =
        certify::ellipse_wall<Ball>(BallVector{0, 0}, BallVector{1, 0}, Ball(ratio), true);
    const double angle = dice.between(-3.0, 3.0);
    const BallVector P{dice.between(-0.5, 0.5), 0.5 * ratio * dice.between(-1, 1)};
    const BallVector v{std::cos(angle), std::sin(angle)};
    certify::MotionOf<Ball> motion;
    motion.speed2 = dot(v, v);
    motion.inverse_speed2 = Ball(1) / motion.speed2;
    motion.turns = true;
    motion.half_omega = dice.between(0.6, 1.0);
    const certify::EllipseFlight<Ball> flight(
        certify::larmor_form<Ball, Ball>(w, P, v, motion, false),
        certify::kappa_scale(w, v, motion.half_omega));
    std::vector<BallVector> leaves;
    std::vector<Kappa<Ball>> places;
    for (const auto& exit : certify::LarmorExits<Ball>(flight.chords(), 5)) {
      ASSERT_TRUE(exit.certain);
      places.push_back(flight.place(exit));
      leaves.push_back(
          certify::larmor_state<Ball, Ball>(places.back(), P, v, motion.half_omega).position);
    }
    if (leaves.size() < 2) continue;
    const double start = dice.between(-3.0, 3.0);
    w.closed = false;
    w.from = {std::cos(start), ratio * std::sin(start)};
    const Ball beside = Ball(dice.sign() * std::ldexp(1.0, dice.whole(-120, -100)));
    const BallVector normal{leaves[0].x, leaves[0].y / Ball(ratio * ratio)};
    const BallVector end = leaves[0] + beside * left(normal);
    w.to = {end.x.midpoint(), end.y.midpoint()};
    w.chord = w.to - w.from;
    if (on_arc(w, leaves[1]) != certify::Verdict::yes) continue;
    ++cases;
    const bool first = on_arc(w, leaves[0]) == certify::Verdict::yes;
    const Kappa<Ball>& truth = places[first ? 0 : 1];
    const auto exact = moving_exit<Ball>(w, P, v, motion);
    ASSERT_TRUE((exact.p.value / exact.q.value).overlaps(truth.p / truth.q));

    const WallOf<Interval> fast = certify::converted<Interval>(w, around);
    const certify::MotionOf<Interval> fast_motion{
        around(motion.speed2), around(motion.inverse_speed2), true, around(motion.half_omega), 64};
    const auto seen = moving_exit<Interval>(fast, {around(P.x), around(P.y)},
                                            {around(v.x), around(v.y)}, fast_motion);
    const Interval place = seen.p.value / seen.q.value;
    if (!(place.low > -HUGE_VAL && place.high < HUGE_VAL))
      continue;  // it says that it does not know
    ++known;
    const double kappa = (truth.p / truth.q).to_double();
    EXPECT_LE(place.low, kappa);
    EXPECT_GE(place.high, kappa);
  }
  EXPECT_EQ(known, 0);  // they are too close for doubles
}

// Circles that pass a joint of elliptic arcs by 10^-30: balls tell on which side.
TEST(LarmorExits, ExitsBesideAJointAreDecided) {
  Shaped s = tests::all_shapes().back();
  ASSERT_EQ(s.spec.loops.at(0).pieces.at(1).kind, PieceSpec::Kind::ellipse);
  long both_sides = 0;
  for (const auto& [x, y] : {std::pair{"3/10", "3/10"}, {"1/2", "1/5"}, {"2/5", "7/10"}}) {
    for (const auto& [u, v] : {std::pair{"0", "1"}, {"1", "0"}, {"0", "0"}}) {
      // Through J = (u, v) from P along (1, 0): 2 omega d_y + omega^2 d^2 = 0 with d = J - P.
      const std::string dx = std::string("(") + u + "-" + x + ")",
                        dy = std::string("(") + v + "-" + y + ")";
      const std::string omega = "-2*" + dy + "/(" + dx + "^2+" + dy + "^2)";
      s.inside = {exactly(x), exactly(y)};
      int walls[2] = {-1, -1};
      for (const int side : {0, 1}) {
        ExactSystem system = tests::system_of(s, {exactly("1"), exactly("0")});
        system.omega = exactly(omega + (side == 0 ? "+1/10^30" : "-1/10^30"));
        CertifiedOrbit few(system, tests::task_of(3, 10)), many(system, tests::task_of(3, 40));
        for (const CertifiedHit& hit : few) {
          if (walls[side] < 0) walls[side] = hit.wall;
          const auto same = many.next();
          ASSERT_TRUE(same.has_value());
          EXPECT_EQ(hit.wall, same->wall);
          EXPECT_TRUE(tests::holds(hit.x, same->x) && tests::holds(hit.vx, same->vx) &&
                      tests::holds(hit.t, same->t));
        }
        EXPECT_EQ(few.end_state().fate, CertifiedFate::completed) << few.end_state().reason;
      }
      both_sides += walls[0] != walls[1];
    }
  }
  EXPECT_GT(both_sides, 2);
}

}  // namespace
}  // namespace carom
