// Where on a lattice walls are looked for.
#include <gtest/gtest.h>

#include <cmath>

#include "certify/enclosure/point_enclosure.hpp"
#include "certify/flight/scene.hpp"
#include "certify/systems.hpp"
#include "certify/wall/ball_table.hpp"

namespace carom {
namespace {

using certify::Ball;
using certify::Interval;
using certify::Precision;
using tests::exactly;

// A disc that only some of the enclosed flights meet, too far from the middle one to come near any
// of its pieces.
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
    const auto scene =
        certify::converted<Interval>(balls, [](const Ball& x) { return certify::interval_of(x); });
    const geometry::Vector P0{0.5, 0.9}, v0{1.0, 0.0};
    const certify::VectorOf<Interval> P{{0.499, 0.501}, {0.605, 1.195}},
        v{{0.9998, 1.0}, {-0.02, 0.02}};
    EXPECT_EQ(scene.next(where, P, v, -1, P0, v0).answer, certify::Choice::undecided) << omega;
    // A narrow one passes between the rows, for longer than is looked for (or until it has turned).
    const certify::VectorOf<Interval> line{{0.5, 0.5}, {1.0, 1.0}}, along{{1.0, 1.0}, {0.0, 0.0}};
    if (omega == 0.0) {
      EXPECT_EQ(scene.next(where, line, along, -1, {0.5, 1.0}, v0).answer,
                certify::Choice::too_far);
    }
  }
}

// The disc that stands for a wall holds it, and no more than it where an arc is flat.
TEST(LatticeSearch, DiscsHoldTheirWalls) {
  const Precision precision(100);
  std::vector<tests::Shaped> shapes = tests::all_shapes();
  tests::Shaped lens = tests::shaped("path", {}, "0", "0");
  LoopSpec loop;
  loop.start = {exactly("1/4"), exactly("1/2")};
  PieceSpec above, below;
  above.kind = below.kind = PieceSpec::Kind::arc;
  above.via = {exactly("1/2"), exactly("1/2+1/10000")};
  above.to = {exactly("3/4"), exactly("1/2")};
  below.via = {exactly("1/2"), exactly("1/2-1/10000")};
  below.to = loop.start;
  loop.pieces = {above, below};
  lens.spec.loops = {loop};
  for (const certify::Whereabouts::Disc& disc :
       certify::whereabouts_of(certify::ball_table(lens.spec)).discs) {
    EXPECT_NEAR(disc.radius, 0.25, 1e-6);
  }
  shapes.push_back(lens);
  long points = 0, narrow = 0;
  for (const tests::Shaped& s : shapes) {
    const certify::BallTable table = certify::ball_table(s.spec);
    const certify::Whereabouts where = certify::whereabouts_of(table);
    for (std::size_t k = 0; k < table.walls.size(); ++k) {
      const certify::WallOf<Ball>& w = table.walls[k];
      if (w.form == certify::Form::segment) continue;
      const bool ellipse = w.form == certify::Form::ellipse;
      const Ball radius = ellipse ? Ball(1) : sqrt(w.radius2);
      const auto semi_axis = [](const certify::BallVector& v) { return Ball(1) / dot(v, v) * v; };
      const certify::BallVector a =
          ellipse ? semi_axis(w.along) : certify::BallVector{radius, Ball(0)};
      const certify::BallVector b =
          ellipse ? semi_axis(w.across) : certify::BallVector{Ball(0), radius};
      for (int i = 0; i < 4000; ++i) {
        const certify::BallVector X =
            w.centre + Ball(std::cos(i * 0.001571)) * a + Ball(std::sin(i * 0.001571)) * b;
        if (certify::on_arc(w, X) != certify::Verdict::yes) continue;
        const certify::BallVector d =
            X - certify::BallVector{where.discs[k].centre.x, where.discs[k].centre.y};
        ASSERT_LE(sqrt(dot(d, d)).to_double(), where.discs[k].radius * (1.0 + 1e-12))
            << s.spec.shape << " " << k;
        ++points;
      }
      narrow += where.discs[k].radius <
                0.999 * (ellipse ? sqrt(dot(a, a)).to_double() : radius.to_double());
    }
  }
  EXPECT_GT(points, 20000);
  EXPECT_GT(narrow, 3);
}

// Numbers that a few bits tell badly: the disc holds all walls that they may mean, and nothing is
// looked for by it.
TEST(LatticeSearch, DiscsHoldAllWallsOfWideBalls) {
  const Precision precision(64);
  const tests::Shaped torus = tests::shaped("sinai", {{"side", "4"}, {"radius", "1"}}, "0", "0");
  certify::BallTable table = certify::ball_table(torus.spec);
  EXPECT_TRUE(std::isfinite(certify::whereabouts_of(table).rounding));
  table.walls[0].radius2 = Ball(1.0).widened(certify::Bound(0.44));
  EXPECT_GE(certify::whereabouts_of(table).discs[0].radius, 1.2);
  EXPECT_FALSE(std::isfinite(certify::whereabouts_of(table).rounding));
  certify::BallTable skewed = certify::ball_table(torus.spec);
  skewed.lattice->first.y = Ball(0).widened(certify::Bound(1e-9));
  EXPECT_FALSE(std::isfinite(certify::whereabouts_of(skewed).rounding));
}

TEST(PointEnclosure, NoRadiusOfCurvatureIsBelowTheLeast) {
  const Precision precision(64);
  const auto least = [](const certify::WallOf<Ball>& wall) {
    return certify::least_radius(
        certify::converted<Interval>(wall, [](const Ball& x) { return certify::interval_of(x); }));
  };
  const certify::BallVector origin{Ball(0), Ball(0)};
  const Ball wide = Ball(1.0).widened(certify::Bound(0.25));  // 3/4 to 5/4
  EXPECT_LE(least(certify::circle_wall(origin, wide, true)), 0.75);
  EXPECT_GE(least(certify::circle_wall(origin, Ball(1), true)), 1.0 - 1e-15);
  const auto ellipse = [&](const Ball& a, const Ball& ratio) {
    return least(certify::ellipse_wall(origin, {a, Ball(0)}, ratio, true));
  };
  EXPECT_NEAR(ellipse(Ball(2), Ball(0.5)), 0.5, 1e-14);  // b^2/a
  EXPECT_LE(ellipse(Ball(2), Ball(0.5)), 0.5);
  EXPECT_NEAR(ellipse(Ball(2), Ball(1.5)), 4.0 / 3.0, 1e-14);  // a^2/b
  EXPECT_LE(ellipse(Ball(2) * wide, Ball(0.5)), 0.375);
}

}  // namespace
}  // namespace carom
