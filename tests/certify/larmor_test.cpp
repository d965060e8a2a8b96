// Certified orbits in a magnetic field against themselves at more bits, the engine, exact answers
// and their own way back.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "carom/events/world.hpp"
#include "carom/files/system_file.hpp"
#include "carom/trust/trust.hpp"
#include "certify/inside.hpp"
#include "certify/number/ball.hpp"
#include "certify/number/enclosure_of.hpp"
#include "certify/number/exact_value.hpp"
#include "certify/systems.hpp"
#include "certify/wall/wall.hpp"
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

constexpr auto state_numbers = {&CertifiedState::t, &CertifiedState::x, &CertifiedState::y,
                                &CertifiedState::vx, &CertifiedState::vy};

struct Flown {
  std::vector<CertifiedHit> hits;
  CertifiedEnd end;
};
Flown run_of(const ExactSystem& system, std::uint64_t collisions, int digits) {
  Flown run;
  CertifiedOrbit orbit(system, task_of(collisions, digits));
  for (const CertifiedHit& hit : orbit) run.hits.push_back(hit);
  run.end = orbit.end_state();
  return run;
}

ExactSystem in_field(const Shaped& s, const ExactPoint& direction, const ExactNumber& omega) {
  ExactSystem system = tests::system_of(s, direction);
  system.omega = omega;
  return system;
}

// Larmor radii from a tenth of a table to a thousand times its size, of both signs.
ExactNumber random_field(tests::Dice& dice) {
  const char* const sizes[] = {"10", "4", "sqrt(3)", "1", "1/1.7", "0.3", "0.001"};
  const std::string size = sizes[dice.whole(0, 6)];
  return exactly(dice.whole(0, 1) == 0 ? size : "-" + size);
}

// Every enclosure is as small as was asked for and contains what a run at more than twice the
// digits finds.
TEST(CertifiedLarmor, ContainsItselfAtMoreBits) {
  tests::Dice dice(11);
  const std::vector<Shaped> shapes = tests::all_shapes();
  const long orbits = tests::cases(600, 10000);
  long pinned = 0, hits = 0;
  for (long k = 0; k < orbits; ++k) {
    const Shaped s =
        tests::with_random_start(shapes[static_cast<std::size_t>(k) % shapes.size()], dice);
    const geometry::Vector d = dice.direction();
    const ExactSystem system = in_field(s, {d.x, d.y}, random_field(dice));
    SCOPED_TRACE(s.spec.shape + ", orbit " + std::to_string(k) + ", omega " + system.omega.text());
    const auto collisions = static_cast<std::uint64_t>(dice.whole(1, 40));
    const int digits = dice.whole(1, 20);
    const Flown few = run_of(system, collisions, digits),
                many = run_of(system, collisions, 2 * digits + 20);
    ASSERT_TRUE(few.end.fate == CertifiedFate::completed || few.end.fate == CertifiedFate::pinned)
        << few.end.reason;
    ASSERT_EQ(few.end.fate, many.end.fate);
    ASSERT_EQ(few.hits.size(), many.hits.size());
    if (few.end.fate == CertifiedFate::pinned) {
      EXPECT_TRUE(few.hits.empty());  // an orbit that hits a wall comes back to it
      ++pinned;
    } else {
      ASSERT_EQ(few.hits.size(), collisions);
    }
    for (std::size_t i = 0; i < few.hits.size(); ++i) {
      ASSERT_EQ(few.hits[i].wall, many.hits[i].wall);
      ASSERT_EQ(few.hits[i].cell, many.hits[i].cell);
      for (const auto number : state_numbers) {
        ASSERT_TRUE(tests::holds(few.hits[i].*number, many.hits[i].*number)) << "hit " << i;
        ASSERT_LT((few.hits[i].*number).log2_error(), -3.3219 * digits);
      }
      ++hits;
    }
  }
  EXPECT_GT(pinned, 0);
  EXPECT_GT(hits, 5000);
}

struct Walls : Observer {
  void hit(const HitEvent& event) override {
    for (int i = 0; i < event.reflections; ++i) walls.push_back(event.wall);
    trust.hit(event);
  }
  /// Against the system as it is written: its numbers are not doubles.
  explicit Walls(const ExactSystem& system)
      : trust(*system.table, TrustRecorder::usual_tolerance, written(system)) {}
  static std::shared_ptr<const trust::WrittenSystem> written(const ExactSystem& system) {
    LoadedSystem loaded;
    loaded.exact = system;
    loaded.system.table = system.table;
    return written_system(loaded);
  }
  std::vector<int> walls;
  TrustRecorder trust;
};

// As far as an orbit of doubles is trusted it meets the walls of the true one.
TEST(CertifiedLarmor, MeetsTheWallsOfTheEngine) {
  tests::Dice dice(12);
  const std::vector<Shaped> shapes = tests::all_shapes();
  const long orbits = tests::cases(300, 10000);
  std::uint64_t trusted = 0;
  for (long k = 0; k < orbits; ++k) {
    const Shaped& s = shapes[static_cast<std::size_t>(k) % shapes.size()];
    const geometry::Vector d = dice.direction();
    ExactSystem system = in_field(s, {d.x, d.y}, random_field(dice));
    SCOPED_TRACE(s.spec.shape + ", orbit " + std::to_string(k) + ", omega " + system.omega.text());
    World world(*system.table);
    State state;
    state.position = {s.inside.x.to_double(), s.inside.y.to_double()};
    state.velocity = (1.0 / std::sqrt(dot(d, d))) * d;
    system.start.position = {state.position.x, state.position.y};
    system.start.direction = {state.velocity.x, state.velocity.y};
    system.omega = system.omega.to_double();
    Particle particle;
    particle.omega = system.omega.to_double();
    world.add(particle, state);
    world.limit_hits(100);
    Walls seen(system);
    seen.trust.follow(particle, state, 0);
    world.run_until(1e300, seen);
    const Flown run = run_of(system, 100, 5);
    ASSERT_EQ(run.end.fate == CertifiedFate::pinned, seen.walls.empty());
    const std::uint64_t hits = std::min<std::uint64_t>(seen.walls.size(), seen.trust.trust(0).hits);
    for (std::size_t i = 0; i < hits; ++i)
      ASSERT_EQ(run.hits.at(i).wall, seen.walls[i]) << "hit " << i;
    trusted += hits;
  }
  EXPECT_GT(trusted, static_cast<std::uint64_t>(20 * orbits));
}

// An orbit of a hundred hits run back in the opposite field from where it ended comes to its start.
TEST(CertifiedLarmor, RunsBack) {
  tests::Dice dice(13);
  for (int k = 0; k < 5; ++k) {
    for (const Shaped& s : tests::all_shapes()) {
      const geometry::Vector d = dice.direction();
      const ExactSystem system = in_field(s, {d.x, d.y}, random_field(dice));
      SCOPED_TRACE(s.spec.shape + ", omega " + system.omega.text());
      CertifiedOrbit hits(system, task_of(100, 6));
      if (hits.finish().fate == CertifiedFate::pinned) continue;
      ASSERT_EQ(hits.end_state().fate, CertifiedFate::completed);
      ExactSystem opposite = system;
      opposite.omega = exactly("-(" + system.omega.text() + ")");
      tests::expect_to_run_back(system, opposite, hits.end_state().t.text(3), 100);
    }
  }
}

// In a disc hits follow each other by equal turns about its centre, after equal times.
TEST(CertifiedLarmor, TurnsEquallyInTheDisc) {
  const Shaped disc = tests::shaped("circle", {{"radius", "1"}}, "1/2", "0");
  const Precision precision(600);
  for (const char* omega : {"1", "-1", "2.1", "1e-9", "-1e6"}) {
    SCOPED_TRACE(omega);
    ExactSystem system = in_field(disc, {exactly("3"), exactly("1")}, exactly(omega));
    if (std::string(omega) == "-1e6") system.start.position = {exactly("1-1e-7"), 0.0};
    const std::vector<CertifiedHit> hits = run_of(system, 200, 60).hits;
    ASSERT_EQ(hits.size(), 200u);
    const auto at = [&](std::size_t i) {
      return certify::BallVector{ball_of(hits[i].x), ball_of(hits[i].y)};
    };
    const Ball turn = dot(at(0), at(1)), time = ball_of(hits[1].t) - ball_of(hits[0].t);
    for (std::size_t i = 1; i < hits.size(); ++i) {
      ASSERT_TRUE(dot(at(i), at(i)).contains(Ball(1)));
      ASSERT_TRUE(dot(at(i - 1), at(i)).overlaps(turn)) << i;
      ASSERT_TRUE((ball_of(hits[i].t) - ball_of(hits[i - 1].t)).overlaps(time)) << i;
    }
  }
}

// From the middle of a square against the right wall: where the circle about (1/2, 1/2 - 1/omega)
// crosses it.
TEST(CertifiedLarmor, FirstHitIsThatByHand) {
  const Shaped square = tests::shaped("rectangle", {{"width", "1"}, {"height", "1"}}, "1/2", "1/2");
  const Precision precision(1000);
  for (const char* omega : {"1", "-1", "1/1000000000000", "-1e-40"}) {
    SCOPED_TRACE(omega);
    const Flown run =
        run_of(in_field(square, {exactly("1"), exactly("0")}, exactly(omega)), 1, 100);
    const std::string rho = std::string("(1/(") + omega + "))";
    // The angle alpha of the turn has the sine 1/(2 rho); y = 1/2 - rho (1 - cos alpha).
    const Ball y =
        certify::value_of(exactly("1/2-1/(4*" + rho + ")/(1+sqrt(1-1/(4*" + rho + "^2)))"));
    ASSERT_EQ(run.hits.at(0).wall, 1);
    EXPECT_TRUE(ball_of(run.hits[0].y).contains(y));
    EXPECT_TRUE(ball_of(run.hits[0].x).contains(Ball(1)));
    EXPECT_LT(run.hits[0].y.log2_error(), -332.0);
    Ball angle;
    const Ball sine = certify::value_of(exactly("1/(2*" + rho + ")"));
    arb_asin(angle.raw(), sine.raw(), Precision::bits());
    EXPECT_TRUE(ball_of(run.hits[0].t).contains(angle * certify::value_of(exactly(rho))));
  }
}

// A whole circle that meets no wall, in the square or between the discs of a lattice.
TEST(CertifiedLarmor, EndsPinned) {
  const Shaped square = tests::shaped("rectangle", {{"width", "1"}, {"height", "1"}}, "1/2", "1/2");
  const Shaped discs = tests::shaped("lorentz", {{"spacing", "2.2"}, {"radius", "1"}}, "1.1", "0");
  for (const char* omega : {"8", "-12", "1000000"}) {
    for (const Shaped& s : {square, discs}) {
      SCOPED_TRACE(s.spec.shape + omega);
      const Flown run = run_of(in_field(s, {exactly("0"), exactly("1")}, exactly(omega)), 5, 20);
      const bool free = s.spec.shape == "rectangle" || std::string(omega) == "1000000";
      EXPECT_EQ(run.end.fate, free ? CertifiedFate::pinned : CertifiedFate::completed);
      if (free) {
        EXPECT_EQ(run.end.collisions, 0u);
      }
    }
  }
}

// The square loses about .46 bits a hit in its chaotic part, less near islands.
TEST(CertifiedLarmor, LosesLittleInTheMagneticSquare) {
  const Shaped square = tests::shaped("rectangle", {{"width", "1"}, {"height", "1"}}, "0.3", "0.2");
  tests::Dice dice(14);
  std::vector<double> rates;
  for (int k = 0; k < 15; ++k) {
    const geometry::Vector d = dice.direction();
    CertifiedOrbit orbit(in_field(square, {d.x, d.y}, exactly("1/0.5075")), task_of(500, 20));
    if (orbit.finish().fate == CertifiedFate::completed)
      rates.push_back(orbit.effort().tangent_bits / 500.0);
  }
  ASSERT_GT(rates.size(), 10u);
  std::sort(rates.begin(), rates.end());
  EXPECT_GT(rates[rates.size() / 2], 0.2);
  EXPECT_LT(rates[rates.size() / 2], 0.7);
  EXPECT_LT(rates.back(), 1.0);
}

}  // namespace
}  // namespace carom
