// Larmor circles that cross an elliptic arc up to four times.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "events/recorder.hpp"

namespace carom::tests {
namespace {

using geometry::EllipticArc;

// A thin half ellipse over its axis: orbits of a radius like its height cross the arc several
// times.
Table thin_arc() {
  return loop({Segment{{-1, 0}, {1, 0}}, EllipticArc{{1, 0}, {-1, 0}, {1, 0}, 0.25, 0.0, true}});
}

TEST(EllipticArc, FilterAndExactStageSeeTheSameExits) {
  const Table table = thin_arc();
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::uint64_t hits = 0;
  for (int i = 0; i < 60; ++i) {
    const double omega = (uniform(random) - 0.5) * 12.0;
    World filter(table), exact(table, {1e300});
    State s;
    do {
      s.position = {2 * uniform(random) - 1, 0.25 * uniform(random)};
    } while (!filter.contains(s.position));
    const double angle = 6.28 * uniform(random);
    s.velocity = {std::cos(angle), std::sin(angle)};
    Recorder a, b;
    filter.add(particle(omega), s);
    exact.add(particle(omega), s);
    filter.run_until(4.0, a);
    exact.run_until(4.0, b);
    ASSERT_EQ(a.hits.size(), b.hits.size()) << i;
    for (std::size_t k = 0; k < a.hits.size(); ++k) {
      ASSERT_EQ(a.hits[k].wall, b.hits[k].wall);
      ASSERT_EQ(a.hits[k].u, b.hits[k].u);
      ASSERT_EQ(a.hits[k].time, b.hits[k].time);
    }
    for (const EndEvent& end : a.ends) EXPECT_NE(end.fate, Fate::lost);
    hits += a.hits.size();
  }
  EXPECT_GT(hits, 500u);
}

TEST(EllipticArc, NoOrbitIsLost) {
  const Table table = thin_arc();
  World world(table);
  Recorder seen;
  for (const double omega : {0.5, -3.0, 6.0, -9.0}) {
    world.add(particle(omega), start({0.1, 0.1}, {0.6, 0.8}));
    world.add(particle(omega), start({-0.4, 0.05}, {-0.8, 0.6}));
  }
  world.run_until(2000.0, seen);
  for (int i = 0; i < world.size(); ++i) EXPECT_NE(world.fate(i), Fate::lost) << world.report(i);
}

}  // namespace
}  // namespace carom::tests
