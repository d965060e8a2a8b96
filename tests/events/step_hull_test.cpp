// What keeps a step off a wall, against points of the step's cubic.
#include "events/step/step_hull.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "carom/base/random.hpp"
#include "carom/geometry/curve.hpp"
#include "events/step/barriers_of.hpp"

namespace carom {

using namespace events;

namespace {

using geometry::Curve;
using geometry::Vector;

struct Step {
  Vector x0, v0, x1, v1;
};

Step random_step(RandomStream& random) {
  const auto about = [&](double size) {
    return Vector{size * (random.uniform() - 0.5), size * (random.uniform() - 0.5)};
  };
  const Vector x = about(6.0), way = about(0.6);
  return {x, way + about(0.2), x + way, way + about(0.2)};
}
StepHull<double> hull_of(const Step& s) { return {s.x0, s.v0, s.x1, s.v1, 1.0 / 3.0}; }

Vector point_of(const StepHull<double>& hull, double t) {
  const double s = 1.0 - t;
  const std::array<double, 4> weight = {s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t};
  Vector sum{};
  for (std::size_t k = 0; k < 4; ++k) sum = sum + weight[k] * hull.points[k];
  return sum;
}

std::vector<Curve> walls() {
  return {geometry::Segment{{-1.0, -1.2}, {0.7, 0.4}},
          geometry::Segment{{-2.0, 1.0}, {2.0, 1.0}},
          geometry::Circle{{0.3, -0.2}, 0.8, true},
          geometry::Circle{{0.3, -0.2}, 0.8, false},
          geometry::CircularArc{{1.0, 0.0}, {-1.0, 0.5}, 0.3, true},
          geometry::CircularArc{{1.0, 0.0}, {-1.0, 0.5}, 0.3, false},
          geometry::Ellipse{{0.1, 0.2}, {1.5, 0.4}, 0.5, true},
          geometry::Bezier{{-1.0, -1.0}, {1.0, 1.0}, {{{1.0, -1.5}, {-0.5, 1.5}}}, 3}};
}

TEST(StepHull, KeepsNoPathOffAWallThatItCrosses) {
  constexpr int parts = 200;
  RandomStream random(7, Purpose::initial_state, 0);
  int crossings = 0, off = 0, near = 0;
  for (const Curve& wall : walls()) {
    for (const Barrier<double>& b : barriers_of<double>(wall, Vector{0.25, -0.125}))
      for (int i = 0; i < 4000; ++i) {
        const StepHull<double> hull = hull_of(random_step(random));
        bool crosses = false;
        for (int k = 0; k < parts && !crosses; ++k) {
          const Vector p = point_of(hull, double(k) / parts),
                       q = point_of(hull, double(k + 1) / parts);
          crosses = b.gap(p) > 0.0 && b.gap(q) < 0.0 && b.covers(p) && b.covers(q);
        }
        const bool stays = stays_off(b, hull);
        EXPECT_FALSE(crosses && stays) << wall.index() << ' ' << i;
        crossings += crosses;
        (stays ? off : near) += 1;
      }
  }
  EXPECT_GT(crossings, 200);
  // Nearly all that miss a wall are told so.
  EXPECT_GT(off, 10 * near);
}

// A long wall's line says nothing: the piece is asked, too.
TEST(StepHull, AsksThePieceAsWellAsItsCurve) {
  const Barrier<double> line =
      barriers_of<double>(geometry::Segment{{0.0, 0.0}, {1.0, 0.0}}, Vector{}).front();
  const Step across{{3.0, 0.1}, {0.0, -0.2}, {3.0, -0.1}, {0.0, -0.2}};
  EXPECT_TRUE(stays_off(line, hull_of(across)));
  Step through = across;
  through.x0.x = through.x1.x = 0.5;
  EXPECT_FALSE(stays_off(line, hull_of(through)));
}

}  // namespace
}  // namespace carom
