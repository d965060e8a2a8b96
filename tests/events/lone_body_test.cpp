// A body alone makes its hits in a loop of its own (FreeFlights::apply_hits). Beside a second body
// it does not, and must have the same hits.
#include <gtest/gtest.h>

#include <stdexcept>

#include "events/recorder.hpp"

namespace carom::tests {
namespace {

struct OfTheFirst : Recorder {
  void hit(const HitEvent& e) override {
    if (e.particle == 0) Recorder::hit(e);
  }
};

struct Orbit {
  const Table& table;
  double omega = 0.0;
  Vector from = {0.31, 0.2};
  double inflation = 1.0;
  std::uint64_t hits = 2000;
};

World world_of(const Orbit& orbit, int bodies) {
  World world(orbit.table, {.filter_inflation = orbit.inflation});
  world.limit_hits(orbit.hits);
  world.add(particle(orbit.omega), start(orbit.from, {0.6, 0.8}));
  if (bodies > 1)
    world.add(particle(orbit.omega), start(orbit.from + Vector{-0.01, 0.01}, {0.8, -0.6}));
  return world;
}

void expect_same(const std::vector<HitEvent>& a, const std::vector<HitEvent>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a[i].wall, b[i].wall) << i;
    ASSERT_EQ(a[i].u, b[i].u) << i;
    ASSERT_EQ(a[i].time, b[i].time) << i;
    ASSERT_EQ(a[i].flight_time, b[i].flight_time) << i;
    ASSERT_EQ(a[i].cell, b[i].cell) << i;
    ASSERT_EQ(a[i].position, b[i].position) << i;
    ASSERT_EQ(a[i].before, b[i].before) << i;
    ASSERT_EQ(a[i].after, b[i].after) << i;
  }
}

/// Stops with an exception now and then, as an observer may, and asks where the particle is.
struct Unruly : Recorder {
  const World* world = nullptr;
  void hit(const HitEvent& e) override {
    Recorder::hit(e);
    const State state = world->state(0);
    EXPECT_EQ(state.cell, e.cell);
    EXPECT_EQ(state.position, e.position);
    EXPECT_EQ(state.velocity, e.after);
    EXPECT_EQ(state.time, e.time);
    EXPECT_EQ(world->hits(0), hits.size());
    if (hits.size() % 97 == 0) throw std::runtime_error("enough for now");
  }
};

void expect_the_hits_beside_another(const Orbit& orbit) {
  OfTheFirst alone, beside;
  World one = world_of(orbit, 1), two = world_of(orbit, 2);
  one.run_until(1e300, alone);
  two.run_until(1e300, beside);
  expect_same(alone.hits, beside.hits);
  ASSERT_EQ(alone.ends.size(), 1u);
  EXPECT_EQ(one.fate(0), two.fate(0));

  World interrupted = world_of(orbit, 1);
  Unruly unruly;
  unruly.world = &interrupted;
  for (bool over = false; !over;) {
    try {
      interrupted.run_until(1e300, unruly);
      over = true;
    } catch (const std::runtime_error&) {
    }
  }
  expect_same(unruly.hits, alone.hits);
}

TEST(LoneBody, HasTheHitsThatItHasBesideAnother) {
  const Table tables[] = {square(),  polygon({{0, 0}, {1, 0}, {1.2, 0.7}, {0.4, 1.1}, {-0.2, 0.6}}),
                          stadium(), mushroom(1.0, 0.5, 0.7),
                          disc(1.0), sinai()};
  for (const Table& table : tables)
    for (const double omega : {0.0, 0.4, -1.3}) expect_the_hits_beside_another({table, omega});
}

TEST(LoneBody, HasThemInALattice) {
  // Discs that are near each other, flights over many cells, two discs in a cell, and one across
  // its edges.
  const Table tables[] = {lorentz({2.2, 0}, {1.1, 1.9}), lorentz({9, 0}, {2, 7}),
                          with_disc(lorentz({5, 0}, {0, 5}), {1.6, 1.7}, 0.5),
                          with_disc(lorentz({5, 0}, {0, 5}), {2.4, 2.3}, 0.5)};
  for (const Table& table : tables) {
    for (const double omega : {0.0, 0.4, -1.3})
      expect_the_hits_beside_another({table, omega, {1.0, 0.55}});
    // Decided in exact arithmetic.
    expect_the_hits_beside_another({table, 0.0, {1.0, 0.55}, 1e13, 300});
  }
}

TEST(LoneBody, StopsAtTheLastTimeAndGoesOn) {
  const Table table = square();
  OfTheFirst whole, parts;
  World one = world_of({table}, 1), other = world_of({table}, 1);
  one.run_until(300.0, whole);
  for (int k = 1; k <= 600; ++k) other.run_until(0.5 * k, parts);
  EXPECT_GT(whole.hits.size(), 300u);
  expect_same(whole.hits, parts.hits);
}

}  // namespace
}  // namespace carom::tests
