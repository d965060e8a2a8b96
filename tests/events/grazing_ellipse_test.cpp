// In a field among ellipses, grazing: where the roots of the quartic cannot be told apart in
// doubles.
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "carom/events/world.hpp"
#include "carom/geometry/formulas.hpp"
#include "carom/geometry/prepared_curve.hpp"
#include "random_tables.hpp"

namespace carom {
namespace {

using geometry::PreparedCurve;
using geometry::Vector;

// How far each hit lies off its ellipse, in units of its larger axis.
class Distance : public Observer {
 public:
  Distance(const Table& table, double size) : curve_(table.walls[0].curve), size_(size) {}
  void hit(const HitEvent& e) override {
    const auto on =
        geometry::on_ellipse(e.position - curve_.centre, curve_.first_axis, curve_.second_axis);
    const double slope = std::sqrt(dot(on.gradient, on.gradient));
    largest = std::max(largest, std::fabs(on.step) / (slope * size_));
  }
  double largest = 0.0;

 private:
  PreparedCurve curve_;
  double size_;
};

TEST(GrazingEllipse, HitsLieOnIt) {
  tests::Dice dice(58);
  for (long k = 0; k < tests::cases(2000, 400'000); ++k) {
    const double size = dice.coin() ? 1.0 : dice.spread(1e-18, 1e18),
                 ratio = dice.spread(1e-3, 1.0);
    const Table table =
        tests::loop({geometry::Ellipse{{0, 0}, size * dice.direction(), ratio, true}});
    const PreparedCurve w(table.walls[0].curve);
    Particle particle;
    particle.omega = dice.sign() * dice.spread(1e-10, 100.0) / size;
    State start;
    start.wall = 0;
    start.u =
        std::max(dice.coin() ? 0.25 * dice.whole(0, 3) * w.last() : w.last() * dice.unit(), 1e-9);
    const auto frame = w.frame(start.u);
    start.position = frame.point;
    const double length = std::sqrt(dot(frame.normal, frame.normal)),
                 angle = dice.spread(1e-12, 1.0), along = dice.sign();
    const Vector n{frame.normal.x / length, frame.normal.y / length};
    start.velocity = std::sin(angle) * n + (along * std::cos(angle)) * Vector{-n.y, n.x};
    particle.speed = std::sqrt(dot(start.velocity, start.velocity));
    World world(table);
    world.limit_hits(12);
    Distance distance(table, size);
    try {
      world.add(particle, start);
    } catch (const std::invalid_argument&) {  // along the wall, or out of it, to the last digit
      continue;
    }
    world.run_until(1e300, distance);
    EXPECT_NE(world.fate(0), Fate::lost) << k << ": " << world.report(0);
    EXPECT_LT(distance.largest, 1e-10)
        << k << ": ratio " << ratio << ", omega " << particle.omega * size << ", angle " << angle;
  }
}

}  // namespace
}  // namespace carom
