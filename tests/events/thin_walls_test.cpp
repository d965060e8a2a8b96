// Ellipses so thin and discs so small that what is rounded of a flight to them is large beside
// them: hits lie where the exact flight leads, on the side that the particle comes from.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "carom/base/error.hpp"
#include "carom/events/world.hpp"
#include "geometry/quad.hpp"
#include "random_tables.hpp"
#include "table/thin_walls.hpp"

namespace carom {
namespace {

using tests::Dice;
using tests::quad;
using tests::Quad;
using tests::QuadCurve;
using tests::QuadVector;
using tests::Vector;

constexpr double u = 0x1p-53;
long hits_of_all = 0;

/// Follows straight flights in four-fold numbers.
class Witness : public Observer {
 public:
  Witness(const Table& table, bool straight) : straight_(straight) {
    for (const Wall& wall : table.walls) curves_.emplace_back(wall.curve);
  }
  void start(const State& s) { last_ = quad(s.position); }

  void hit(const HitEvent& e) override {
    const QuadCurve& w = curves_[static_cast<std::size_t>(e.wall)];
    const QuadVector at = w.point(e.u), normal = w.normal(at), v = quad(e.before);
    const Quad across = dot(normal, v);
    if (!w.segment) {
      ++hits;
      const double length = std::sqrt(double(dot(normal, normal)));
      if (double(across) > 16.0 * u * length) ++from_behind;
      if (straight_) {
        // The distance of a line from the centre, where the curve is the unit circle.
        const auto side = [&](const QuadVector& x) {
          const QuadVector e1 = image(w, x - w.centre), d = image(w, v);
          return double(cross(d, e1) / tests::root(dot(d, d)));
        };
        sideways = std::max(sideways, std::fabs(side(at) - side(last_)));
        const double incidence = -double(across) / length;
        const double flown = double(dot(at - last_, v) / dot(v, v));
        late = std::max(late, std::fabs(e.flight_time - flown) * incidence);
      }
      // Reflected by the exact normal.
      const QuadVector after = v - (Quad(2) * across / dot(normal, normal)) * normal;
      if (double(across) < 0.0) turned = std::max(turned, tests::largest(after - quad(e.after)));
    }
    last_ = at;
  }
  long hits = 0, from_behind = 0;
  double sideways = 0.0, late = 0.0, turned = 0.0;

 private:
  static QuadVector image(const QuadCurve& w, const QuadVector& e) {
    const Quad area = cross(w.a, w.b);
    return {cross(e, w.b) / area, cross(w.a, e) / area};
  }
  const bool straight_;
  std::vector<QuadCurve> curves_;
  QuadVector last_;
};

/// A thin wall, or one where the formulas do: then squares of size/smallest are rounded.
bool is_thin(const Table& table) { return table::has_thin_walls(table); }
double largest_shift(const Table& table, double size, double smallest) {
  return is_thin(table) ? 16.0 * u * size / smallest : 0x1p-16;
}

void fly(const Table& table, double size, double smallest, Dice& dice, const std::string& what) {
  for (const double omega : {0.0, 0.7, -3.0}) {
    World world(table);
    for (int k = 0; k < 4; ++k) {
      Witness witness(table, omega == 0.0);
      Particle particle;
      State start;
      const double at = dice.between(0.1, 0.9);
      start.wall = 0;  // the floor
      start.u = at;
      start.position = {3.0 * at, 0.0};
      start.velocity = {dice.between(-1.0, 1.0), dice.between(0.3, 1.0)};
      particle.speed = std::sqrt(dot(start.velocity, start.velocity));
      particle.omega = omega;
      world.clear();
      world.limit_hits(omega == 0.0 ? 60 : 10);  // the exact stage is slow in a field
      witness.start(start);
      const int i = world.add(particle, start);
      world.run_until(1e4, witness);
      EXPECT_EQ(world.fate(i), Fate::capped) << what << ": " << world.report(i);
      EXPECT_EQ(witness.from_behind, 0) << what;
      EXPECT_LT(witness.sideways, largest_shift(table, size, smallest)) << what;
      if (is_thin(table)) {
        EXPECT_LT(witness.late, 64.0 * u * size) << what;
        EXPECT_LT(witness.turned, 64.0 * u) << what;
      }
      hits_of_all += witness.hits;
    }
  }
}

TEST(ThinWalls, EllipsesAreHitWhereTheFlightLeads) {
  Dice dice(3);
  hits_of_all = 0;
  for (long k = 0; k < tests::cases(12, 3000); ++k) {
    const double b = dice.spread(1e-9, 1e-2), a = dice.between(0.3, 1.4);
    Table table = tests::rectangle(3.0, 3.0);
    tests::add_loop(table, {geometry::Ellipse{{1.5, 1.5}, a * dice.direction(), b / a, false}});
    fly(table, 3.0, b, dice, "b = " + std::to_string(std::log10(b)));
  }
  EXPECT_GT(hits_of_all, 500);
}

TEST(ThinWalls, SmallDiscsAreHitWhereTheFlightLeads) {
  Dice dice(4);
  hits_of_all = 0;
  for (long k = 0; k < tests::cases(30, 3000); ++k) {
    // Two discs that nearly touch, so that a particle which comes between them hits them often.
    const double r = dice.spread(1e-9, 1e-2), gap = r * dice.spread(1e-3, 1.0);
    Table table = tests::rectangle(3.0, 3.0);
    const Vector d = (1.0 + 0.5 * gap / r) * r * dice.direction();
    tests::add_loop(table, {geometry::Circle{{1.5 + d.x, 1.5 + d.y}, r, false}});
    tests::add_loop(table, {geometry::Circle{{1.5 - d.x, 1.5 - d.y}, r, false}});
    for (int n = 0; n < 4; ++n) {
      // Aimed at the discs.
      Witness witness(table, true);
      Particle particle;
      State start;
      start.wall = 0;
      start.u = dice.between(0.1, 0.9);
      start.position = {3.0 * start.u, 0.0};
      const Vector target{1.5 + r * dice.between(-2.0, 2.0), 1.5 + r * dice.between(-2.0, 2.0)};
      start.velocity = target - start.position;
      particle.speed = std::sqrt(dot(start.velocity, start.velocity));
      World world(table);
      world.limit_hits(20);
      witness.start(start);
      const int i = world.add(particle, start);
      world.run_until(1e4, witness);
      EXPECT_EQ(world.fate(i), Fate::capped) << world.report(i);
      EXPECT_EQ(witness.from_behind, 0) << r;
      EXPECT_LT(witness.sideways, largest_shift(table, 3.0, r)) << r;
      if (is_thin(table)) {
        EXPECT_LT(witness.late, 64.0 * u * 3.0) << r;
      }
      hits_of_all += witness.hits;
    }
  }
  EXPECT_GT(hits_of_all, 50);
}

TEST(ThinWalls, ThinnerOnesAreRefused) {
  for (const double b : {1e-3, 1e-9, 1e-10, 1e-15}) {
    for (const bool circle : {false, true}) {
      Table table = tests::rectangle(3.0, 3.0);
      if (circle)
        tests::add_loop(table, {geometry::Circle{{1.5, 1.5}, b, false}});
      else
        tests::add_loop(table, {geometry::Ellipse{{1.5, 1.5}, {1.4, 0.0}, b / 1.4, false}});
      if (b < 3e-10)
        EXPECT_THROW(World{table}, InputError) << b;
      else
        EXPECT_NO_THROW(World{table}) << b;
    }
  }
}

}  // namespace
}  // namespace carom
