// The event loop: fates, lattices, several particles, samples, corners.
#include "carom/events/world.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "events/recorder.hpp"

namespace carom::tests {
namespace {

Vector unwrapped(const Table& t, const State& s) {
  return s.position + t.lattice->translation(s.cell);
}

TEST(World, FliesStraightThroughASquare) {
  const Table table = square();
  World world(table);
  Recorder seen;
  world.add(particle(), start({0.25, 0.5}, {0.6, 0.8}));
  world.run_until(1.0, seen);
  ASSERT_EQ(seen.hits.size(), 1u);
  EXPECT_EQ(seen.hits[0].wall, 2);
  EXPECT_DOUBLE_EQ(seen.hits[0].time.value(), 0.625);
  EXPECT_EQ(seen.hits[0].position, Vector(0.625, 1.0));
  EXPECT_EQ(seen.hits[0].after, Vector(0.6, -0.8));
  const State end = world.state_at(0, 1.0);
  EXPECT_DOUBLE_EQ(end.position.x, 0.85);
  EXPECT_DOUBLE_EQ(end.position.y, 0.7);
}

TEST(World, EscapesThroughAHoleClosedAtItsStartAndOpenAtItsEnd) {
  Table table = square();
  table.holes.push_back({"gap", 0, 0.25, 0.5});
  table.walls[0].holes = {0};
  const auto fate_below = [&](double x) {
    World world(table);
    Recorder seen;
    world.add(particle(), start({x, 0.5}, {0.0, -1.0}));
    world.run_until(0.75, seen);
    return world.fate(0);
  };
  EXPECT_EQ(fate_below(0.25), Fate::escaped);
  EXPECT_EQ(fate_below(0.375), Fate::escaped);
  EXPECT_EQ(fate_below(0.5), Fate::survived);
  EXPECT_EQ(fate_below(std::nextafter(0.25, 0.0)), Fate::survived);
  EXPECT_EQ(fate_below(std::nextafter(0.5, 0.0)), Fate::escaped);
}

// A state after the end was one of the straight line outside of the table.
TEST(World, OneThatHasEndedStaysWhereItEnded) {
  Table table = square();
  table.holes.push_back({"gap", 0, 0.25, 0.5});
  table.walls[0].holes = {0};
  World world(table);
  Recorder seen;
  world.add(particle(), start({0.375, 0.5}, {0.0, -1.0}));
  world.run_until(3.0, seen);
  ASSERT_EQ(world.fate(0), Fate::escaped);
  const State later = world.state_at(0, 100.0);
  EXPECT_EQ(later.position, Vector(0.375, 0.0));
  EXPECT_EQ(later.time.value(), 0.5);
}

TEST(World, TurnsBackInARightAngle) {
  const Table table = square();
  World world(table);
  Recorder seen;
  world.add(particle(0.0, 1.0), start({0.5, 0.5}, {-std::sqrt(0.5), -std::sqrt(0.5)}));
  world.run_until(1.0, seen);
  ASSERT_EQ(seen.hits.size(), 1u);
  EXPECT_EQ(seen.hits[0].reflections, 2);
  EXPECT_EQ(world.hits(0), 2u);
  EXPECT_EQ(seen.hits[0].position, Vector(0, 0));
  EXPECT_DOUBLE_EQ(seen.hits[0].after.x, -seen.hits[0].before.x);
  EXPECT_DOUBLE_EQ(seen.hits[0].after.y, -seen.hits[0].before.y);
  // … and on through the opposite corner and back, for good.
  world.run_until(100.0, seen);
  EXPECT_EQ(world.fate(0), Fate::survived);
  for (const HitEvent& hit : seen.hits) EXPECT_EQ(hit.reflections, 2);
}

TEST(World, AnAngleThatIsNoPiOverNIsSingular) {
  const Table table = polygon({{0, 0}, {2, 0}, {1, 1.5}});
  World world(table);
  Recorder seen;
  world.add(particle(), start({1.0, 0.5}, {0.0, 1.0}));
  world.run_until(10.0, seen);
  ASSERT_EQ(seen.ends.size(), 1u);
  EXPECT_EQ(seen.ends[0].fate, Fate::singular);
  EXPECT_DOUBLE_EQ(seen.ends[0].time.value(), 1.0);
}

TEST(World, ATangentDiscIsNoHit) {
  const Table table = sinai();
  World world(table);
  Recorder seen;
  world.add(particle(), start({0.25, 0.125}, {0.0, 1.0}));  // touches the disc at (0.25, 0.5)
  world.run_until(0.875, seen);
  ASSERT_EQ(seen.hits.size(), 1u);
  EXPECT_EQ(seen.hits[0].wall, 2);
}

TEST(World, TwoTouchingDiscsMakeACusp) {
  const Table table = discs({{0, 0}, {2, 0}});
  World world(table);
  Recorder seen;
  world.add(particle(), start({1.0, 3.0}, {0.0, -1.0}));
  world.run_until(10.0, seen);
  ASSERT_EQ(seen.ends.size(), 1u);
  EXPECT_EQ(seen.ends[0].fate, Fate::singular);
  EXPECT_DOUBLE_EQ(seen.ends[0].time.value(), 3.0);
}

TEST(World, PinnedOrbitsAreKnownAtOnce) {
  const Table table = square();
  World world(table);
  Recorder seen;
  world.add(particle(10.0), start({0.5, 0.5}, {1.0, 0.0}));
  world.run_until(1e9, seen);
  ASSERT_EQ(seen.ends.size(), 1u);
  EXPECT_EQ(seen.ends[0].fate, Fate::pinned);
  EXPECT_EQ(world.decisions().filter + world.decisions().exact, 1u);
  // A cyclotron orbit between the discs of a lattice, across cell edges.
  const Table gas = lorentz({4, 0}, {0, 4});
  World wide(gas);
  Recorder there;
  wide.add(particle(-1.0, std::sqrt(0.953125)),
           start({1.375, 1.25}, {0.75, -0.625}));  // circles about (2, 2), the cells' corner
  wide.run_until(1e9, there);
  ASSERT_EQ(there.ends.size(), 1u);
  EXPECT_EQ(there.ends[0].fate, Fate::pinned);
}

TEST(World, LeavesTheOpenPlane) {
  const Table table = discs({{0, 0}});
  World world(table);
  Recorder seen;
  world.add(particle(), start({-3.0, 0.0}, {1.0, 0.0}));
  world.run_until(100.0, seen);
  ASSERT_EQ(seen.ends.size(), 1u);
  EXPECT_EQ(seen.ends[0].fate, Fate::unbounded);
  EXPECT_DOUBLE_EQ(seen.ends[0].time.value(), 2.0);  // its last hit
  EXPECT_EQ(seen.ends[0].hits, 1u);
}

TEST(World, RefusesStartsOutsideTheTable) {
  const Table table = sinai();
  World world(table);
  EXPECT_THROW(world.add(particle(), start({0.5, 0.5}, {1, 0})), std::invalid_argument);
  EXPECT_THROW(world.add(particle(), start({1.5, 0.5}, {1, 0})), std::invalid_argument);
  EXPECT_TRUE(world.contains({0.1, 0.1}));
  EXPECT_FALSE(world.contains({0.5, 0.3}));
  EXPECT_FALSE(world.contains({0.0, 0.5}));  // on a wall
}

TEST(World, RefusesAVelocityOffTheEnergyShell) {
  const Table table = square();
  World world(table);
  EXPECT_THROW(world.add(particle(0.0, 1.0), start({0.5, 0.5}, {1.0, 1e-6})),
               std::invalid_argument);
  EXPECT_NO_THROW(world.add(particle(0.0, 2.0), start({0.5, 0.5}, {1.2, 1.6})));
}

TEST(World, CellsAreCountedAndPositionsUnwrapped) {
  // Down a corridor of the square lattice: 25 cells, no hit.
  const Table table = lorentz({4, 0}, {0, 4});
  World world(table);
  Recorder seen;
  world.sample_at({100.0});
  world.add(particle(), start({0.0, 2.0}, {1.0, 0.0}));  // along the edges of the cells
  world.run_until(100.0, seen);
  EXPECT_TRUE(seen.hits.empty());
  ASSERT_EQ(seen.samples.size(), 1u);
  EXPECT_EQ(unwrapped(table, seen.samples[0].second), Vector(100.0, 2.0));
  // Across cells to a disc: (0, 2) -> disc at (8, 4) hit at (7, 4) from the west.
  World other(table);
  Recorder there;
  other.add(particle(), start({2.0, 0.0}, {0.8, 0.6}));
  other.run_until(8.0, there);
  ASSERT_FALSE(there.hits.empty());
  const HitEvent& hit = there.hits[0];
  const Vector centre = table.lattice->translation(hit.cell);
  const Vector place = hit.position + centre;
  EXPECT_NEAR(place.x - 2.0, hit.time.value() * 0.8, 1e-13);
  EXPECT_NEAR(place.y, hit.time.value() * 0.6, 1e-13);
  EXPECT_FALSE(hit.cell == geometry::Cell{});
}

TEST(World, ALatticeIsItsUnfoldedPlane) {
  // The same orbit among explicit discs of the open plane, as long as it stays among them.
  const Vector first{2.5, 0.25}, second{1.0, 2.375};
  const Table gas = lorentz(first, second);
  std::vector<Vector> centres;
  for (int m = -12; m <= 12; ++m)
    for (int n = -12; n <= 12; ++n) centres.push_back(gas.lattice->translation({m, n}));
  const Table plane = discs(centres);
  for (const double omega : {0.0, 0.25, -0.7}) {
    World folded(gas), unfolded(plane);
    Recorder a, b;
    folded.add(particle(omega), start({1.25, 0.125}, {0.28, 0.96}));
    unfolded.add(particle(omega), start({1.25, 0.125}, {0.28, 0.96}));
    folded.limit_hits(12);
    unfolded.limit_hits(12);
    folded.run_until(1e3, a);
    unfolded.run_until(1e3, b);
    ASSERT_EQ(a.hits.size(), b.hits.size());
    for (std::size_t i = 0; i < a.hits.size(); ++i) {
      const Vector x = a.hits[i].position + gas.lattice->translation(a.hits[i].cell);
      EXPECT_NEAR(x.x, b.hits[i].position.x, 1e-6);  // chaos amplifies rounding by about 4 a hit
      EXPECT_NEAR(x.y, b.hits[i].position.y, 1e-6);
    }
  }
}

TEST(World, ObservationChangesNothing) {
  const Table table = stadium();
  for (const double omega : {0.0, 0.8}) {
    World plain(table), sampled(table);
    Recorder a, b;
    sampled.sample_every(0.01);
    plain.add(particle(omega), start({0.1, 0.2}, {0.6, 0.8}));
    sampled.add(particle(omega), start({0.1, 0.2}, {0.6, 0.8}));
    plain.run_until(200.0, a);
    sampled.run_until(60.0, b);
    sampled.run_until(200.0, b);
    EXPECT_EQ(b.samples.size(), 20001u);
    ASSERT_EQ(a.hits.size(), b.hits.size());
    for (std::size_t i = 0; i < a.hits.size(); ++i) {
      EXPECT_EQ(a.hits[i].u, b.hits[i].u);
      EXPECT_EQ(a.hits[i].after, b.hits[i].after);
      EXPECT_EQ(a.hits[i].time, b.hits[i].time);
    }
    for (const auto& [t, s] : b.samples) EXPECT_NEAR(dot(s.velocity, s.velocity), 1.0, 4e-15);
  }
}

TEST(World, SeveralParticlesDoNotSeeEachOther) {
  const Table table = stadium();
  World together(table);
  Recorder all;
  std::vector<State> starts;
  for (int i = 0; i < 7; ++i)
    starts.push_back(start({0.1 * i, 0.05 * i}, i % 2 ? Vector{0.6, 0.8} : Vector{-0.8, 0.6}));
  for (int i = 0; i < 7; ++i)
    together.add(particle(0.1 * i, 1.0), starts[static_cast<std::size_t>(i)]);
  together.run_until(50.0, all);
  double last = 0.0;
  for (const HitEvent& hit : all.hits) {
    EXPECT_GE(hit.time.value(), last);
    last = hit.time.value();
  }
  for (int i = 0; i < 7; ++i) {
    World alone(table);
    Recorder one;
    alone.add(particle(0.1 * i, 1.0), starts[static_cast<std::size_t>(i)]);
    alone.run_until(50.0, one);
    std::size_t k = 0;
    for (const HitEvent& hit : all.hits) {
      if (hit.particle != i) continue;
      ASSERT_LT(k, one.hits.size());
      EXPECT_EQ(hit.time, one.hits[k].time);
      EXPECT_EQ(hit.after, one.hits[k].after);
      ++k;
    }
    EXPECT_EQ(k, one.hits.size());
  }
}

TEST(World, ContinuesFromAStoredState) {
  const Table table = stadium();
  World whole(table), first(table), second(table);
  Recorder a, b, c;
  whole.add(particle(0.5), start({0.1, 0.2}, {0.6, 0.8}));
  whole.run_until(100.0, a);
  first.add(particle(0.5), start({0.1, 0.2}, {0.6, 0.8}));
  first.run_until(40.0, b);
  second.add(particle(0.5), first.state(0), first.hits(0));
  second.run_until(100.0, c);
  ASSERT_EQ(a.hits.size(), b.hits.size() + c.hits.size());
  EXPECT_EQ(a.hits.back().time, c.hits.back().time);
  EXPECT_EQ(a.hits.back().after, c.hits.back().after);
  EXPECT_EQ(whole.hits(0), second.hits(0));
}

TEST(World, TheCapEndsATrajectory) {
  const Table table = stadium();
  World world(table);
  Recorder seen;
  world.limit_hits(5);
  world.add(particle(), start({0.1, 0.2}, {0.6, 0.8}));
  world.run_until(1e9, seen);
  EXPECT_EQ(seen.hits.size(), 5u);
  ASSERT_EQ(seen.ends.size(), 1u);
  EXPECT_EQ(seen.ends[0].fate, Fate::capped);
  EXPECT_EQ(seen.ends[0].time, seen.hits.back().time);
}

TEST(World, InflatedBoundsChangeNoBit) {
  for (const Table& table : {square(), stadium(), sinai(), lorentz({2.2, 0}, {1.1, 1.9}), disc(1.5),
                             loop({Ellipse{{0, 0}, {1, 0}, 0.75, true}})})
    for (const double omega : {0.0, 0.6, -2.0}) {
      Recorder usual, inflated, exact;
      const std::pair<double, Recorder*> runs[] = {
          {1.0, &usual}, {0x1p20, &inflated}, {1e300, &exact}};
      for (const auto& [inflation, recorder] : runs) {
        World world(table, {inflation});
        world.add(particle(omega),
                  start({table.extent == Extent::lattice ? 1.05 : 0.125, 0.1}, {0.6, 0.8}));
        world.run_until(25.0, *recorder);
      }
      ASSERT_EQ(usual.hits.size(), inflated.hits.size());
      ASSERT_EQ(usual.hits.size(), exact.hits.size());
      for (std::size_t i = 0; i < usual.hits.size(); ++i) {
        EXPECT_EQ(usual.hits[i].time, inflated.hits[i].time);
        EXPECT_EQ(usual.hits[i].after, exact.hits[i].after);
        EXPECT_EQ(usual.hits[i].u, exact.hits[i].u);
      }
    }
}

}  // namespace
}  // namespace carom::tests
