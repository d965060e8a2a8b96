// Certified escapes: through which hole, after how many collisions, when.
#include <gtest/gtest.h>

#include "carom/events/world.hpp"
#include "certify/number/enclosure_of.hpp"
#include "certify/number/exact_value.hpp"
#include "certify/systems.hpp"
#include "certify/wall/ball_table.hpp"
#include "certify/wall/hole.hpp"
#include "random_tables.hpp"

namespace carom {
namespace {

using certify::Ball;
using certify::ball_of;
using certify::Precision;
using tests::exactly;
using tests::Shaped;

HoleSpec hole_in(const std::string& wall, const ExactNumber& center, const ExactNumber& width) {
  HoleSpec hole;
  hole.wall = wall;
  hole.center = center;
  hole.width = width;
  return hole;
}

// A hole of a tenth of the length somewhere in every wall; over the start of closed ones now and
// then.
Shaped with_holes(Shaped s, tests::Dice& dice) {
  const Table table = build_table(s.spec);
  for (const Wall& wall : table.walls) {
    const double length = geometry::length(wall.curve);
    const double width = dice.between(0.02, 0.15) * length;
    const double margin = geometry::is_closed(wall.curve) ? 0.0 : 0.5000001 * width;
    s.spec.holes.push_back(hole_in(wall.name, dice.between(margin, length - margin), width));
  }
  return s;
}

// Every other orbit flies in a field, of both signs.
ExactNumber field_of(long k) {
  const char* const fields[] = {"0", "3/4", "0", "-sqrt(2)"};
  return exactly(fields[k / 16 % 4]);
}

CertifiedTask until(const char* t, int digits) {
  CertifiedTask task;
  task.t_max = exactly(t);
  task.digits = digits;
  return task;
}

CertifiedEnd end_of(const ExactSystem& system, const CertifiedTask& task) {
  CertifiedOrbit orbit(system, task);
  return orbit.finish();
}

struct Ending : Observer {
  void end(const EndEvent& event) override { time = event.time.value(); }
  double time = 0.0;
};

// The ends of holes in balls are those of the table, which were rounded.
TEST(CertifiedHoles, HolesEndAsWritten) {
  tests::Dice dice(11);
  const Precision precision(200);
  for (int round = 0; round < 20; ++round) {
    for (const Shaped& closed : tests::all_shapes()) {
      const Shaped s = with_holes(closed, dice);
      SCOPED_TRACE(s.spec.shape);
      const ExactSystem system = tests::system_of(s, {1.0, 0.0});
      const certify::BallTable table = certify::ball_table(s.spec);
      for (const auto& hole : certify::ball_holes(system, table.walls)) {
        const certify::WallOf<Ball>& w = table.walls[static_cast<std::size_t>(hole.wall)];
        const Wall& wall = system.table->walls[static_cast<std::size_t>(hole.wall)];
        const Hole& first = system.table->holes[static_cast<std::size_t>(hole.hole)];
        Hole last = first;  // one over the start of a closed curve is two in the table
        for (const Hole& other : system.table->holes)
          if (other.name == first.name) last = other;
        for (const double share : {0.01, 0.5, 0.99}) {
          for (const Hole& part : {first, last}) {
            const geometry::Vector p =
                geometry::point_at(wall.curve, part.from + share * (part.to - part.from));
            EXPECT_EQ(certify::in_hole(hole, w, certify::BallVector{p.x, p.y}),
                      certify::Verdict::yes);
          }
        }
        for (const double share : {0.01, 0.5, 0.99}) {
          const double from = last.to < first.to ? last.to : first.to,
                       to = last.to < first.to ? first.from : last.from;
          const bool over_start = last.from != first.from;
          const double outside = over_start ? from + share * (to - from) : share * first.from;
          if (!over_start && first.from == 0.0) continue;
          const geometry::Vector p = geometry::point_at(wall.curve, outside);
          EXPECT_EQ(certify::in_hole(hole, w, certify::BallVector{p.x, p.y}), certify::Verdict::no);
        }
      }
    }
  }
}

// On an ellipse the enclosed end has the arc length that was written, by the sum of many chords.
TEST(CertifiedHoles, ArcLengthOfAnEllipseIsCertified) {
  const Precision precision(200);
  for (const char* b : {"0.3", "1", "1.7"}) {
    Shaped s = tests::shaped("ellipse", {{"a", "1"}, {"b", b}}, "0.1", "0.1");
    s.spec.holes.push_back(hole_in("ellipse", exactly("2"), exactly("1/2")));
    const certify::BallTable table = certify::ball_table(s.spec);
    const auto holes = certify::ball_holes(tests::system_of(s, {1.0, 0.0}), table.walls);
    ASSERT_EQ(holes.size(), 1u);
    const double ratio = exactly(b).to_double();
    for (const auto& [point, length] : {std::pair{holes[0].first, 1.75}, {holes[0].last, 2.25}}) {
      EXPECT_LT(point.x.radius().log2(), -180.0);
      const double angle = std::atan2(point.y.to_double(), point.x.to_double());
      double sum = 0.0;
      const int chords = 20000;
      for (int i = 0; i < chords; ++i) {
        const double at = (angle < 0 ? angle + 6.283185307179586 : angle) / chords * (i + 0.5);
        const double step = (angle < 0 ? angle + 6.283185307179586 : angle) / chords;
        sum += step *
               std::sqrt(std::sin(at) * std::sin(at) + ratio * ratio * std::cos(at) * std::cos(at));
      }
      EXPECT_NEAR(sum, length, 1e-8);
    }
  }
}

// Doubles follow for some ten hits: they leave through the same hole, as late.
TEST(CertifiedHoles, LeavesAsTheEngineDoes) {
  tests::Dice dice(12);
  const std::vector<Shaped> shapes = tests::all_shapes();
  const long orbits = tests::cases(600, 10000);
  long escaped = 0, in_fields = 0;
  for (long k = 0; k < orbits; ++k) {
    const Shaped s = with_holes(shapes[static_cast<std::size_t>(k) % shapes.size()], dice);
    SCOPED_TRACE(s.spec.shape + ", orbit " + std::to_string(k));
    const geometry::Vector d = dice.direction();
    ExactSystem system = tests::system_of(s, {d.x, d.y});
    system.omega = field_of(k);
    Particle particle;
    particle.omega = system.omega.to_double();
    World world(*system.table);
    State state;
    state.position = {s.inside.x.to_double(), s.inside.y.to_double()};
    state.velocity = (1.0 / std::sqrt(dot(d, d))) * d;
    world.add(particle, state);
    world.limit_hits(10);
    Ending ending;
    world.run_until(1e300, ending);
    CertifiedTask task = until("1000000", 10);
    task.collisions = 10;
    const CertifiedEnd end = end_of(system, task);
    ASSERT_EQ(end.fate == CertifiedFate::escaped, world.fate(0) == Fate::escaped);
    ASSERT_EQ(end.collisions, world.hits(0));
    if (end.fate != CertifiedFate::escaped) continue;
    ++escaped;
    in_fields += particle.omega != 0.0;
    ASSERT_EQ(system.table->holes[static_cast<std::size_t>(end.hole)].name,
              system.table->holes[static_cast<std::size_t>(world.hole(0))].name);
    ASSERT_EQ(end.wall, world.last_wall(0));
    ASSERT_NEAR(end.t.to_double(), ending.time, 1e-6);
    if (particle.omega != 0.0) continue;
    const State there = world.state(0);  // after the last reflection: it flies straight
    ASSERT_NEAR(end.vx.to_double(), there.velocity.x, 1e-6);
    ASSERT_NEAR(end.vy.to_double(), there.velocity.y, 1e-6);
  }
  EXPECT_GT(escaped, orbits / 5);
  EXPECT_GT(in_fields, orbits / 20);
}

// Long after doubles have lost the orbit: the same escape with many more digits, inside the same
// balls.
TEST(CertifiedHoles, TheSameEscapeAtMoreDigits) {
  tests::Dice dice(13);
  const std::vector<Shaped> shapes = tests::all_shapes();
  for (long k = 0; k < tests::cases(100, 3000); ++k) {
    Shaped s = shapes[static_cast<std::size_t>(k) % shapes.size()];
    SCOPED_TRACE(s.spec.shape + ", orbit " + std::to_string(k));
    const Table table = build_table(s.spec);
    const Wall& wall = table.walls.front();
    const double length = geometry::length(wall.curve);
    s.spec.holes.push_back(hole_in(wall.name, 0.37 * length, 0.02 * length));
    const geometry::Vector d = dice.direction();
    ExactSystem system = tests::system_of(s, {d.x, d.y});
    system.omega = field_of(k);
    const CertifiedEnd few = end_of(system, until("100", 12)),
                       many = end_of(system, until("100", 50));
    ASSERT_EQ(few.fate, many.fate);
    ASSERT_EQ(few.collisions, many.collisions);
    ASSERT_EQ(few.hole, many.hole);
    for (const auto number : {&CertifiedState::t, &CertifiedState::x, &CertifiedState::y,
                              &CertifiedState::vx, &CertifiedState::vy}) {
      // Either may have turned out smaller than was asked for.
      ASSERT_TRUE(ball_of(few.*number).overlaps(ball_of(many.*number)))
          << (few.*number).log2_error() << " " << (many.*number).log2_error();
      ASSERT_LT((many.*number).log2_error(), -3.3219 * 50);
      ASSERT_LT((few.*number).log2_error(), -3.3219 * 12);
    }
  }
}

// In the square the orbit unfolds to a straight line: the hit in which it leaves is found by
// counting.
TEST(CertifiedHoles, UnfoldsToTheHole) {
  Shaped square = tests::shaped("rectangle", {{"width", "1"}, {"height", "1"}}, "1/10", "1/5");
  square.spec.holes.push_back(hole_in("right", exactly("0.7005"), exactly("1/1000")));
  // x = 1 is met after 9/10 + 2k of the way, at height 1/5 + (sqrt(3)/2)(9/10 + 2k), unfolded.
  const Precision precision(300);
  const Ball slope = certify::value_of(exactly("sqrt(3)/2"));
  long k = 0;
  Ball folded;
  double way = 0.0;
  for (;; ++k) {
    way = 2.0 * static_cast<double>(k);
    const Ball height = certify::value_of(exactly("1/5")) +
                        slope * (certify::value_of(exactly("9/10")) + Ball(way));
    const double floor = std::floor(height.to_double());
    folded = height - Ball(floor);
    if (std::fmod(floor, 2.0) != 0.0) folded = Ball(1) - folded;
    if (folded.to_double() >= 0.7 && folded.to_double() < 0.701) break;
  }
  ASSERT_GT(k, 100);
  const CertifiedEnd end =
      end_of(tests::system_of(square, {exactly("2"), exactly("sqrt(3)")}), until("1000000", 40));
  EXPECT_EQ(end.fate, CertifiedFate::escaped);
  EXPECT_TRUE(ball_of(end.y).overlaps(folded));
  EXPECT_TRUE(ball_of(end.x).contains(Ball(1)));
  // It has met vertical walls 2k times, and a horizontal one for each whole height.
  const double heights = std::floor(
      (certify::value_of(exactly("1/5")) + slope * (certify::value_of(exactly("9/10")) + Ball(way)))
          .to_double());
  EXPECT_EQ(static_cast<double>(end.collisions), way + heights);
  EXPECT_GT(sign(ball_of(end.vx)), Sign::zero);
}

}  // namespace
}  // namespace carom
