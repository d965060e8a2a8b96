// Errors of single hits: the series against libquadmath, points of written walls against the
// definition of curves.
#include "trust/exact_hit.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "certify/wall/start.hpp"
#include "geometry/quad.hpp"
#include "random_tables.hpp"
#include "tables_by_hand.hpp"

namespace carom::tests {

using namespace trust;

namespace {

Quad quad(const Twofold& x) { return Quad(x.high) + Quad(x.low); }

TEST(ExactHit, SineAndCosineHaveTwentyDigits) {
  Dice dice(13);
  for (int i = 0; i < 20000; ++i) {
    const double x = dice.sign() * dice.spread(1e-12, 4.0);
    Twofold sin, cos;
    sin_cos(sin, cos, Twofold(x));
    ASSERT_LT(std::fabs(double((quad(sin) - sine(Quad(x))) / sine(Quad(x)))), 0x1p-70) << x;
    ASSERT_LT(std::fabs(double(quad(cos) - cosine(Quad(x)))), 0x1p-70) << x;
  }
}

TEST(ExactHit, PointsOfWallsAreThoseOfTheCurves) {
  Dice dice(14);
  Table table = stadium();
  for (const geometry::Curve& curve :
       {geometry::Curve(geometry::Ellipse{{0.1, 0.2}, {2.0, 0.7}, 0.6, false}),
        geometry::Curve(
            geometry::EllipticArc{{1.0, 0.0}, {0.0, 0.5}, {1.0, 0.3}, 0.4, 0.3, true})}) {
    table.walls.emplace_back();
    table.walls.back().curve = curve;
  }
  const WrittenSystem written = as_stored(table, Particle{});
  for (std::size_t k = 0; k < table.walls.size(); ++k) {
    const QuadCurve curve(table.walls[k].curve);
    for (int i = 0; i < 100; ++i) {
      const double u = dice.between(0.0, geometry::last_parameter(table.walls[k].curve));
      const TwofoldVector p = certify::point_with_parameter(written.table.walls[k], u);
      const QuadVector q = curve.point(u);
      ASSERT_LT(std::fabs(double(quad(p.x) - q.x)) + std::fabs(double(quad(p.y) - q.y)), 1e-28)
          << k;
    }
  }
}

}  // namespace
}  // namespace carom::tests
