// Certified orbits against published digits, exact answers, themselves at more bits, and the
// engine.
#include "carom/certify/certified_orbit.hpp"

#include <gtest/gtest.h>

#include <ranges>

#include "carom/events/world.hpp"
#include "certify/inside.hpp"
#include "certify/number/enclosure_of.hpp"
#include "certify/number/exact_value.hpp"
#include "certify/systems.hpp"
#include "certify/wall/ball_table.hpp"
#include "certify/way_back.hpp"
#include "random_tables.hpp"

namespace carom {
namespace {

using certify::Ball;
using certify::ball_of;
using certify::Precision;
using tests::exactly;
using tests::Shaped;
using tests::task_of;

std::vector<CertifiedHit> hits_of(const ExactSystem& system, std::uint64_t collisions, int digits) {
  std::vector<CertifiedHit> hits;
  CertifiedOrbit orbit(system, task_of(collisions, digits));
  for (const CertifiedHit& hit : orbit) hits.push_back(hit);
  return hits;
}

ExactPoint random_direction(tests::Dice& dice) {
  const geometry::Vector d = dice.direction();
  return {d.x, d.y};
}

// Bornemann, Laurie, Wagon, Waldvogel: The SIAM 100-Digit Challenge (2004), problem 2.
TEST(CertifiedOrbit, PhotonAmongMirrorsHasItsHundredDigits) {
  Shaped mirrors = tests::shaped("lorentz", {{"spacing", "1"}, {"radius", "1/3"}}, "1/2", "1/10");
  mirrors.spec.words["lattice"] = "square";
  CertifiedTask task = task_of(0, 100);
  task.t_max = exactly("10");
  CertifiedOrbit orbit(tests::system_of(mirrors, {1.0, 0.0}), task);
  const CertifiedEnd& end = orbit.finish();
  EXPECT_EQ(end.fate, CertifiedFate::completed);
  EXPECT_EQ(end.collisions, 14u);
  const Precision precision(500);
  const Ball distance = sqrt(square(ball_of(end.x)) + square(ball_of(end.y)));
  EXPECT_EQ(distance.decimals(30), "0.995262919443354160890311809427");
  EXPECT_LT(distance.radius().log2(), -332.0);  // 100 digits
}

// The walls in balls are the walls of the table, which were rounded.
TEST(CertifiedOrbit, TablesAreThoseWritten) {
  const Precision precision(100);
  for (const Shaped& s : tests::all_shapes()) {
    SCOPED_TRACE(s.spec.shape);
    const Table table = build_table(s.spec);
    const certify::BallTable exact = certify::ball_table(s.spec);
    ASSERT_EQ(exact.walls.size(), table.walls.size());
    for (std::size_t k = 0; k < table.walls.size(); ++k) {
      const certify::WallOf<Ball>& w = exact.walls[k];
      const geometry::Curve& curve = table.walls[k].curve;
      EXPECT_EQ(w.closed, geometry::is_closed(curve));
      const geometry::Vector from = geometry::start_point(curve), to = geometry::end_point(curve);
      EXPECT_NEAR(w.from.x.to_double(), from.x, 1e-15);
      EXPECT_NEAR(w.from.y.to_double(), from.y, 1e-15);
      EXPECT_NEAR(w.to.x.to_double(), to.x, 1e-15);
      EXPECT_NEAR(w.to.y.to_double(), to.y, 1e-15);
      if (w.form == certify::Form::segment) continue;
      const geometry::Vector centre = geometry::centre(curve);
      EXPECT_NEAR(w.centre.x.to_double(), centre.x, 1e-14);
      EXPECT_NEAR(w.centre.y.to_double(), centre.y, 1e-14);
    }
    ASSERT_EQ(exact.lattice.has_value(), table.lattice.has_value());
  }
}

// Every enclosure is as small as was asked for and contains what a run at more than twice the
// digits finds.
TEST(CertifiedOrbit, ContainsItselfAtMoreBits) {
  tests::Dice dice(1);
  const std::vector<Shaped> shapes = tests::all_shapes();
  const long orbits = tests::cases(1000, 10000);
  for (long k = 0; k < orbits; ++k) {
    const Shaped s =
        tests::with_random_start(shapes[static_cast<std::size_t>(k) % shapes.size()], dice);
    SCOPED_TRACE(s.spec.shape + ", orbit " + std::to_string(k));
    const ExactSystem system = tests::system_of(s, random_direction(dice));
    const std::uint64_t collisions = static_cast<std::uint64_t>(dice.whole(1, 40));
    const int digits = dice.whole(1, 20);
    const auto few = hits_of(system, collisions, digits),
               many = hits_of(system, collisions, 2 * digits + 20);
    ASSERT_EQ(few.size(), collisions);
    ASSERT_EQ(many.size(), collisions);
    for (std::size_t i = 0; i < few.size(); ++i) {
      ASSERT_EQ(few[i].wall, many[i].wall);
      ASSERT_EQ(few[i].cell, many[i].cell);
      for (const auto number : {&CertifiedState::t, &CertifiedState::x, &CertifiedState::y,
                                &CertifiedState::vx, &CertifiedState::vy}) {
        ASSERT_TRUE(tests::holds(few[i].*number, many[i].*number)) << "hit " << i;
        ASSERT_LT((few[i].*number).log2_error(), -3.3219 * digits);
      }
    }
  }
}

// In a rectangle the orbit unfolds to a straight line: heights of hits on the sides are rational.
TEST(CertifiedOrbit, UnfoldsInTheSquare) {
  const Shaped square =
      tests::shaped("rectangle", {{"width", "1"}, {"height", "1"}}, "1/10", "1/5");
  const Precision precision(400);
  long side = 0;
  for (const CertifiedHit& hit :
       hits_of(tests::system_of(square, {exactly("7"), exactly("2")}), 500, 60)) {
    if (hit.wall != 1 && hit.wall != 3) continue;
    ++side;  // x has run to `side` in the unfolded plane, y by 2/7 of the way from 1/10
    const Ball height = certify::value_of(exactly("1/5+2/7*(" + std::to_string(side) + "-1/10)"));
    const long floor = static_cast<long>(std::floor(height.to_double()));
    const Ball rest = height - Ball(static_cast<double>(floor));
    const Ball folded = floor % 2 == 0 ? rest : Ball(1) - rest;
    ASSERT_TRUE(ball_of(hit.y).overlaps(folded)) << side;
    ASSERT_TRUE(ball_of(hit.x).contains(Ball(side % 2 == 0 ? 0 : 1)));
  }
  EXPECT_GT(side, 300);
}

// An orbit of a hundred hits run back from where it ended comes to its start.
TEST(CertifiedOrbit, RunsBack) {
  tests::Dice dice(2);
  for (long k = 0; k < tests::cases(5, 50); ++k) {
    for (const Shaped& s : tests::all_shapes()) {
      const ExactSystem system = tests::system_of(s, random_direction(dice));
      SCOPED_TRACE(s.spec.shape + ", start " + std::to_string(k));
      CertifiedOrbit hits(system, task_of(100, 6));
      if (hits.finish().fate != CertifiedFate::completed) continue;  // along a corridor
      tests::expect_to_run_back(system, system, hits.end_state().t.text(3), 100);
    }
  }
}

struct Walls : Observer {
  void hit(const HitEvent& event) override {
    for (int i = 0; i < event.reflections; ++i) walls.push_back(event.wall);
  }
  std::vector<int> walls;
};

// Views take hits one by one, and may stop before the orbit does.
TEST(CertifiedOrbit, IsARange) {
  const Shaped stadium =
      tests::shaped("stadium", {{"half_length", "1"}, {"radius", "1"}}, "1/10", "1/5");
  ExactStart start;
  start.position = stadium.inside;
  start.direction = {exactly("3"), exactly("1")};
  CertifiedOrbit orbit = certified_orbit(stadium.spec, start, 1000, 10);
  std::uint64_t arcs = 0;
  for (const CertifiedHit& hit :
       orbit | std::views::take(20) |
           std::views::filter([](const CertifiedHit& h) { return h.wall % 2 == 1; })) {
    EXPECT_NEAR(std::hypot(std::fabs(hit.x.to_double()) - 1.0, hit.y.to_double()), 1.0, 1e-9);
    ++arcs;
  }
  EXPECT_GT(arcs, 2u);
}

// Doubles follow for some ten hits.
TEST(CertifiedOrbit, MeetsTheWallsOfTheEngine) {
  tests::Dice dice(3);
  const std::vector<Shaped> shapes = tests::all_shapes();
  const long orbits = tests::cases(300, 10000);
  long different = 0;
  for (long k = 0; k < orbits; ++k) {
    const Shaped& s = shapes[static_cast<std::size_t>(k) % shapes.size()];
    const geometry::Vector d = dice.direction();
    const ExactSystem system = tests::system_of(s, {d.x, d.y});
    World world(*system.table);
    State state;
    state.position = {s.inside.x.to_double(), s.inside.y.to_double()};
    state.velocity = (1.0 / std::sqrt(dot(d, d))) * d;
    world.add(Particle{}, state);
    world.limit_hits(8);
    Walls seen;
    world.run_until(1e300, seen);
    std::vector<int> walls;
    for (const CertifiedHit& hit : hits_of(system, 8, 5)) walls.push_back(hit.wall);
    if (walls != seen.walls) ++different;
  }
  EXPECT_EQ(different, 0);
}

}  // namespace
}  // namespace carom
