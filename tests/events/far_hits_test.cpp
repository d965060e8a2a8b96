// Hits on discs much smaller than the flight: where the flight's rounding is large beside the
// radius.
#include <gtest/gtest.h>

#include <cmath>

#include "carom/events/world.hpp"
#include "carom/geometry/prepared_curve.hpp"
#include "random_tables.hpp"

namespace carom {
namespace {

using tests::Dice;
using tests::Vector;

class OnTheCircle : public Observer {
 public:
  OnTheCircle(const geometry::PreparedCurve& disc, double speed) : disc_(disc), speed_(speed) {}
  void hit(const HitEvent& event) override {
    const Vector d = event.position - disc_.centre;
    const long double x = d.x, y = d.y;
    const double off = static_cast<double>(std::sqrt(x * x + y * y) -
                                           std::sqrt(static_cast<long double>(disc_.r2)));
    worst = std::max(worst, std::fabs(off) / disc_.point_error);
    energy = std::max(energy, std::fabs(dot(event.after, event.after) / (speed_ * speed_) - 1.0));
    ++hits;
  }
  double worst = 0.0, energy = 0.0;
  long hits = 0;

 private:
  const geometry::PreparedCurve& disc_;
  double speed_;
};

TEST(FarHits, LieOnTheirCircle) {
  Dice dice(8);
  for (const double radius : {0.1, 0.01, 1e-3, 1e-4}) {
    Table table;
    tests::add_loop(table, {geometry::Circle{{0.1, 0.2}, radius, false}});
    table.extent = Extent::lattice;
    table.lattice = geometry::make_lattice({1, 0}, {0, 1}, {0, 0});
    const geometry::PreparedCurve disc(table.walls[0].curve);
    World world(table);
    for (int k = 0; k < 20; ++k) {
      world.clear();
      Particle particle;
      State start;
      start.position = {-0.3, -0.4};
      start.velocity = dice.direction();
      particle.speed = std::sqrt(dot(start.velocity, start.velocity));
      OnTheCircle check(disc, particle.speed);
      world.limit_hits(20);
      world.add(particle, start);
      world.run_until(1e9, check);
      EXPECT_LT(check.worst, 1.0) << radius;
      EXPECT_LT(check.energy, 64 * geometry::unit_roundoff) << radius;
      EXPECT_GT(check.hits, 0);
    }
  }
}

}  // namespace
}  // namespace carom
