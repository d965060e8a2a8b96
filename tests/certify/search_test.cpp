// Where on a lattice walls are looked for.
#include <gtest/gtest.h>

#include "certify/ball_table.hpp"
#include "certify/scene.hpp"
#include "certify/systems.hpp"

namespace carom {
namespace {

using certify::Ball;
using certify::Interval;
using certify::Precision;

// A disc that only some of the enclosed flights meet, too far from the middle one to come near any of its pieces.
TEST(LatticeSearch, LooksAsFarAsTheEnclosureReaches) {
  const Precision precision(100);
  const tests::Shaped torus = tests::shaped("sinai", {{"side", "1"}, {"radius", "1/10"}}, "0", "0");
  certify::BallTable table = certify::ball_table(torus.spec);
  const certify::Whereabouts where = certify::whereabouts_of(table);
  for (const double omega : {0.0, 1e-6}) {
    certify::SceneOf<Ball> balls;
    balls.walls = table.walls;
    balls.lattice = table.lattice;
    balls.motion.speed2 = balls.motion.inverse_speed2 = Ball(1);
    balls.motion.half_omega = omega / 2;
    balls.motion.turns = omega != 0.0;
    const auto scene = certify::converted<Interval>(balls, [](const Ball& x) { return certify::interval_of(x); });
    const geometry::Vector P0{0.5, 0.9}, v0{1.0, 0.0};
    const certify::VectorOf<Interval> P{{0.499, 0.501}, {0.605, 1.195}}, v{{0.9998, 1.0}, {-0.02, 0.02}};
    EXPECT_EQ(scene.next(where, P, v, -1, P0, v0).answer, certify::Choice::undecided) << omega;
    // A narrow one passes between the rows, for longer than is looked for (or until it has turned).
    const certify::VectorOf<Interval> line{{0.5, 0.5}, {1.0, 1.0}}, along{{1.0, 1.0}, {0.0, 0.0}};
    if (omega == 0.0) {
      EXPECT_EQ(scene.next(where, line, along, -1, {0.5, 1.0}, v0).answer, certify::Choice::too_far);
    }
  }
}

}  // namespace
}  // namespace carom
