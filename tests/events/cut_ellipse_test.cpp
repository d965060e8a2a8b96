// An ellipse that was cut into arcs is the ellipse: a particle on one arc is, nearly, on
// the ellipses of all others.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "events/recorder.hpp"
#include "random_tables.hpp"

namespace carom::tests {
namespace {

struct Orbit {
  std::vector<HitEvent> hits;
  DecisionCounts decisions;
  std::string report;
};
Orbit orbit(const Table& table, double omega, const State& start, std::uint64_t hits,
            DecisionOptions options = {}) {
  World world(table, options);
  Recorder seen;
  world.limit_hits(hits);
  world.add(particle(omega, std::sqrt(dot(start.velocity, start.velocity))), start);
  world.run_until(1e300, seen);
  return {seen.hits, world.decisions(), world.report(0)};
}

double distance(Vector a, Vector b) { return std::sqrt(dot(a - b, a - b)); }

/// Random flights; without field each eighth.
struct Scene {
  double size, omega;
  bool obstacle, exactly;
  CutEllipse tables;
  State start;
};
Scene scene(long k, double thinnest, Dice& dice) {
  Scene s{};
  s.size = dice.coin() ? 1.0 : dice.spread(1e-6, 1e6);
  s.obstacle = dice.coin();
  s.exactly = dice.whole(0, 4) == 0;
  s.tables = cut_ellipse(s.size, s.obstacle, s.exactly, thinnest, dice);
  s.omega = k % 8 == 0 ? 0.0 : dice.sign() * dice.spread(0.02, 5.0) / s.size;
  const World world(s.tables.whole);
  do {
    s.start.position = {s.size * dice.between(-2.0, 2.0), s.size * dice.between(-2.0, 2.0)};
  } while (!world.contains(s.start.position));
  s.start.velocity = dice.direction();
  return s;
}

TEST(CutEllipse, HasTheOrbitsOfTheWholeOne) {
  Dice dice(71);
  DecisionCounts decisions;
  std::uint64_t hits = 0, compared = 0, on_arcs = 0;
  const long all = cases(300, 30'000);
  for (long k = 0; k < all; ++k) {
    const Scene s = scene(k, 0.05, dice);  // rounded joints of a thinner one make another table
    const Orbit cut = orbit(s.tables.cut, s.omega, s.start, 60),
                whole = orbit(s.tables.whole, s.omega, s.start, 60);
    decisions += cut.decisions;
    hits += cut.hits.size();
    for (const HitEvent& hit : cut.hits) on_arcs += !s.obstacle || hit.wall > 0 ? 1u : 0u;
    // As long as a start that is moved by far more than rounding makes the same orbit.
    State moved = s.start;
    moved.position = moved.position + 1e-10 * s.size * dice.direction();
    const Orbit other = orbit(s.tables.whole, s.omega, moved, 60);
    double far = 1e-9 * s.size;
    for (std::size_t i = 0; i < std::min(whole.hits.size(), other.hits.size()); ++i) {
      far = std::max(far, distance(whole.hits[i].position, other.hits[i].position));
      if (far > 1e-5 * s.size) break;
      ASSERT_LT(i, cut.hits.size()) << k << ": " << cut.report;
      ASSERT_LT(distance(cut.hits[i].position, whole.hits[i].position), far) << k << ", hit " << i;
      ASSERT_EQ(s.obstacle && cut.hits[i].wall > 0, s.obstacle && whole.hits[i].wall > 0)
          << k << ", hit " << i;
      ++compared;
    }
  }
  EXPECT_GT(compared, 33 * static_cast<std::uint64_t>(all));
  EXPECT_GT(on_arcs, 25 * static_cast<std::uint64_t>(all));
  EXPECT_LT(static_cast<double>(decisions.exact), 1e-3 * static_cast<double>(hits));
}

TEST(CutEllipse, AllStagesSeeTheSameExits) {
  Dice dice(72);
  for (long k = 0; k < cases(40, 4000); ++k) {
    const Scene s = scene(k, k % 2 == 0 ? 0.1 : 1e-3, dice);
    const Orbit filter = orbit(s.tables.cut, s.omega, s.start, 40);
    for (const DecisionOptions other :
         {DecisionOptions{1e300, 16}, DecisionOptions{100.0, 16}, DecisionOptions{1.0, 1}}) {
      const Orbit same = orbit(s.tables.cut, s.omega, s.start, 40, other);
      ASSERT_EQ(filter.hits.size(), same.hits.size()) << k;
      for (std::size_t i = 0; i < filter.hits.size(); ++i) {
        ASSERT_EQ(filter.hits[i].wall, same.hits[i].wall) << k;
        ASSERT_EQ(filter.hits[i].u, same.hits[i].u) << k;
        ASSERT_EQ(filter.hits[i].time, same.hits[i].time) << k;
      }
    }
  }
}

// From the last of some hits, with velocity and field turned round, back to the first one; as far
// as rounding lets.
TEST(CutEllipse, OrbitsRunBack) {
  Dice dice(73);
  long back = 0;
  DecisionCounts decisions;
  const long all = cases(150, 15'000);
  for (long k = 0; k < all; ++k) {
    const Scene s = scene(k, k % 2 == 0 ? 0.1 : 1e-3, dice);
    constexpr std::uint64_t most = 6;
    World there(s.tables.cut);
    there.limit_hits(most);
    there.add(particle(s.omega, std::sqrt(dot(s.start.velocity, s.start.velocity))), s.start);
    Recorder forth;
    there.run_until(1e300, forth);
    if (forth.hits.size() < most) continue;
    // A start moved by 1e-10 tells how much a short orbit magnifies errors.
    State moved = s.start;
    moved.position = moved.position + 1e-10 * s.size * dice.direction();
    const Orbit other = orbit(s.tables.cut, s.omega, moved, most);
    double far = 0.0;
    for (std::size_t i = 0; i < std::min<std::size_t>(other.hits.size(), most); ++i)
      far = std::max(far, distance(other.hits[i].position, forth.hits[i].position));
    if (other.hits.size() < most || far > 1e-7 * s.size) continue;
    State turned = there.state(0);
    turned.velocity = -forth.hits.back().before;
    const Orbit home = orbit(s.tables.cut, -s.omega, turned, most - 1);
    decisions += home.decisions;
    ASSERT_EQ(home.hits.size(), most - 1) << k;
    EXPECT_EQ(home.hits.back().wall, forth.hits.front().wall) << k;
    EXPECT_LT(distance(home.hits.back().position, forth.hits.front().position), 1e-5 * s.size) << k;
    ++back;
  }
  EXPECT_GT(back, all / 2);
  EXPECT_LT(static_cast<double>(decisions.exact), 5e-3 * static_cast<double>(back * 5));
}

}  // namespace
}  // namespace carom::tests
