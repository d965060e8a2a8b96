// Lanes against the scalar engine: every orbit, bit for bit, on every instruction set of this
// machine.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "carom/events/world.hpp"
#include "carom/geometry/curve.hpp"
#include "carom/lanes/free_lanes.hpp"
#include "random_tables.hpp"

namespace carom {
namespace {
using tests::Dice;
using tests::Shape;

struct Case {
  std::vector<LaneStart> starts;
  double t_end = std::numeric_limits<double>::max();
  std::uint64_t limit = 300;
  std::vector<double> times;  ///< to report at
};

/// An end, and what was reported before.
struct Flown {
  LaneEnd end;
  std::vector<State> reports;
};

/// A start on a wall, or in the domain.
LaneStart random_start(const Table& table, const World& world, Dice& dice, double size,
                       double speed, double omega = 0.0) {
  LaneStart start;
  start.particle.speed = speed;
  start.particle.omega = omega;
  State& s = start.state;
  if (dice.whole(0, 3) == 0) {
    do {
      s.position = {dice.between(-1.5, 1.5) * size, dice.between(-1.5, 1.5) * size};
    } while (!world.contains(s.position));
    s.velocity = speed * dice.direction();
  } else {
    s.wall = dice.whole(0, static_cast<int>(table.walls.size()) - 1);
    const geometry::Curve& curve = table.walls[static_cast<std::size_t>(s.wall)].curve;
    s.u = geometry::end_parameter(curve) * dice.between(0.001, 0.999);
    s.position = geometry::point_at(curve, s.u);
    do {
      s.velocity = speed * dice.direction();
    } while (dot(s.velocity, geometry::normal_at(curve, s.u)) < 1e-3 * speed);
  }
  // The energy shell is the particle's own.
  const double square = dot(s.velocity, s.velocity);
  start.particle.speed = std::sqrt(square);
  return start;
}

std::uint64_t bits(double x) { return std::bit_cast<std::uint64_t>(x); }

class Listener : public Observer {
 public:
  void hit(const HitEvent& event) override {
    if (hit_times) hit_times->push_back(event.time.high);
  }
  void end(const EndEvent& event) override { time = event.time; }
  void sample(int, Time, const State& state) override { reports.push_back(state); }
  Time time;
  std::vector<State> reports;
  std::vector<double>* hit_times = nullptr;
};

Flown by_world(World& world, const LaneStart& start, const Case& all,
               std::vector<double>* hit_times = nullptr) {
  Listener listener;
  listener.hit_times = hit_times;
  world.sample_at(all.times);
  world.clear();
  world.limit_hits(all.limit);
  world.add(start.particle, start.state, start.hits);
  world.run_until(all.t_end, listener);
  return {{start.tag,
           world.fate(0),
           world.finished(0) ? listener.time : world.state(0).time,
           world.state(0),
           world.hole(0),
           world.hits(0),
           world.last_wall(0),
           {}},
          listener.reports};
}

/// Report times: any, those of hits, and the end of the run, which may be that of a hit, too. Some
/// start later than others.
void add_times(Case& all, const Table& table, Dice& dice) {
  World world(table);
  std::vector<double> hits;
  for (int i = 0; i < 5; ++i) by_world(world, all.starts[static_cast<std::size_t>(i)], all, &hits);
  if (hits.empty()) return;
  if (dice.coin())
    all.t_end = hits[static_cast<std::size_t>(
        dice.whole(0, std::min(4, static_cast<int>(hits.size()) - 1)))];
  const double last = std::min(*std::max_element(hits.begin(), hits.end()), all.t_end);
  for (int n = dice.whole(1, 40); n > 0; --n)
    all.times.push_back(
        dice.coin()
            ? hits[static_cast<std::size_t>(dice.whole(0, static_cast<int>(hits.size()) - 1))]
            : 1.2 * last * dice.between(0.0, 1.0));
  if (dice.coin()) all.times.push_back(0.0);
  if (dice.coin() && all.t_end < 1e300) all.times.push_back(all.t_end);
  if (dice.coin())
    for (std::size_t i = 0; i < all.starts.size(); i += 7)
      all.starts[i].state.time = Time(last * dice.between(0.0, 0.5));
  std::sort(all.times.begin(), all.times.end());
  all.times.erase(std::unique(all.times.begin(), all.times.end()), all.times.end());
}

void expect_same_but_state(const LaneEnd& a, const LaneEnd& b) {
  EXPECT_EQ(a.fate, b.fate) << name_of(a.fate) << " " << name_of(b.fate);
  EXPECT_EQ(a.hits, b.hits);
  EXPECT_EQ(a.hole, b.hole);
  EXPECT_EQ(a.last_wall, b.last_wall);
  EXPECT_EQ(bits(a.time.high), bits(b.time.high));
  EXPECT_EQ(bits(a.time.low), bits(b.time.low));
}

void expect_same(const LaneEnd& a, const LaneEnd& b) {
  expect_same_but_state(a, b);
  EXPECT_EQ(a.state.wall, b.state.wall);
  EXPECT_EQ(a.state.cell, b.state.cell);
  EXPECT_EQ(bits(a.state.u), bits(b.state.u));
  EXPECT_EQ(bits(a.state.position.x), bits(b.state.position.x));
  EXPECT_EQ(bits(a.state.position.y), bits(b.state.position.y));
  EXPECT_EQ(bits(a.state.velocity.x), bits(b.state.velocity.x));
  EXPECT_EQ(bits(a.state.velocity.y), bits(b.state.velocity.y));
}

void expect_same(const std::vector<State>& a, const std::vector<State>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    const bool same = bits(a[k].time.high) == bits(b[k].time.high) &&
                      bits(a[k].position.x) == bits(b[k].position.x) &&
                      bits(a[k].position.y) == bits(b[k].position.y) &&
                      bits(a[k].velocity.x) == bits(b[k].velocity.x) &&
                      bits(a[k].velocity.y) == bits(b[k].velocity.y) && a[k].cell == b[k].cell;
    ASSERT_TRUE(same) << "report " << k << " at " << b[k].time.high;
  }
}

struct Totals {
  std::uint64_t hits = 0, scalar = 0, reports = 0;
  std::map<Fate, int> fates;
};

void compare(const Table& table, Case& all, Totals& totals, const char* what) {
  World world(table);
  for (std::size_t i = 0; i < all.starts.size(); ++i) all.starts[i].tag = i;
  std::vector<Flown> expected;
  for (const LaneStart& start : all.starts) expected.push_back(by_world(world, start, all));
  for (const InstructionSet set : available_instruction_sets()) {
    FreeLanes lanes(table, {all.starts[0].particle}, set);
    lanes.limit_hits(all.limit);
    std::vector<std::vector<State>> reports(all.starts.size());
    lanes.sample_at(all.times, [&](std::uint64_t tag, std::size_t number, const State& state) {
      EXPECT_EQ(bits(all.times[number]), bits(state.time.high));
      reports[tag].push_back(state);
    });
    std::size_t next = 0, ended = 0;
    const auto source = [&](LaneStart& start) {
      if (next == all.starts.size()) return false;
      start = all.starts[next++];
      return true;
    };
    const auto named = [&](const LaneEnd& end) {
      return std::string(what) + " " + name_of(set) + " start " + std::to_string(end.tag);
    };
    lanes.run_until(all.t_end, source, [&](const LaneEnd& end) {
      ++ended;
      ++totals.fates[end.fate];
      SCOPED_TRACE(named(end));
      if (testing::Test::HasFailure()) return;
      expect_same(end, expected[end.tag].end);
      expect_same(reports[end.tag], expected[end.tag].reports);
      totals.reports += reports[end.tag].size();
    });
    EXPECT_EQ(ended, all.starts.size()) << what;
    totals.hits += lanes.effort().hits;
    totals.scalar += lanes.effort().scalar;
    if (testing::Test::HasFailure()) return;
    if (set != widest_instruction_set()) continue;
    next = 0;
    lanes.omit_end_states();
    lanes.run_until(all.t_end, source, [&](const LaneEnd& end) {
      SCOPED_TRACE(named(end));
      if (!testing::Test::HasFailure()) expect_same_but_state(end, expected[end.tag].end);
    });
  }
}

/// Holes on some walls, some from or to a joint.
void add_holes(Table& table, Dice& dice) {
  for (std::size_t i = 0; i < table.walls.size(); ++i) {
    double from = 0.0;
    const double end = geometry::end_parameter(table.walls[i].curve);
    for (int n = dice.whole(-2, 2); n > 0; --n) {
      Hole hole;
      hole.name = "hole";
      hole.wall = static_cast<int>(i);
      hole.from = dice.whole(0, 3) == 0 ? from : from + (end - from) * dice.between(0.05, 0.5);
      hole.to =
          dice.whole(0, 3) == 0 ? end : hole.from + (end - hole.from) * dice.between(0.02, 0.2);
      table.walls[i].holes.push_back(static_cast<int>(table.holes.size()));
      table.holes.push_back(hole);
      from = hole.to;
      if (!(from < end)) break;
    }
  }
}

class Lanes : public testing::TestWithParam<Shape> {};

/// Random tables of the shape and trajectories there: how they ended, and which engine decided.
/// `turn`: the sign of omega.
Totals compare_on_tables(Shape shape, int turn, long tables) {
  Dice dice(17 + static_cast<std::uint64_t>(shape) + static_cast<std::uint64_t>(1000 * (turn + 1)));
  Totals totals;
  for (long k = 0; k < tables && !testing::Test::HasFailure(); ++k) {
    const double size = dice.coin() ? 1.0 : dice.spread(1e-6, 1e6);
    Table table = tests::random_table(shape, size, {}, dice);
    if (dice.coin()) add_holes(table, dice);
    const World world(table);
    Case all;
    all.limit = static_cast<std::uint64_t>(dice.whole(1, 300));
    const double speed = dice.coin() ? 1.0 : dice.spread(1e-3, 1e3);
    const double omega = turn * dice.spread(0.01, 10.0) * speed / size;
    if (dice.coin()) all.t_end = dice.spread(1.0, 1000.0) * size / speed;
    for (int i = 0; i < 150; ++i)
      all.starts.push_back(random_start(table, world, dice, size, speed, omega));
    if (dice.coin()) add_times(all, table, dice);
    EXPECT_EQ(FreeLanes::hindrance(table, {all.starts[0].particle}), "");
    compare(table, all, totals, std::to_string(k).c_str());
  }
  EXPECT_GT(totals.fates[Fate::capped], 100);
  EXPECT_GT(totals.fates[Fate::survived], 100);
  EXPECT_GT(totals.fates[Fate::escaped], 100);
  EXPECT_GT(totals.reports, 1000u);
  EXPECT_EQ(totals.fates[Fate::lost], 0);
  testing::Test::RecordProperty("hits", std::to_string(totals.hits));
  testing::Test::RecordProperty("scalar", std::to_string(totals.scalar));
  return totals;
}

TEST_P(Lanes, FlyTheOrbitsOfTheWorld) {
  const Totals totals = compare_on_tables(GetParam(), 0, tests::cases(40, 4000));
  // Lanes do the work: but for rare doubts.
  EXPECT_LT(static_cast<double>(totals.scalar), 0.015 * static_cast<double>(totals.hits));
}
TEST_P(Lanes, FlyLarmorCirclesBothWays) {
  for (const int turn : {-1, 1}) {
    Totals totals = compare_on_tables(GetParam(), turn, tests::cases(30, 3000));
    // The scalar engine finds that a flight meets no wall.
    const int pinned = totals.fates[Fate::pinned];
    EXPECT_GT(pinned, 0);
    // Flat arcs and fields that bend a flight within a hundredth of their radius are of very
    // different lengths. An arc that a circle may leave elsewhere through its ellipse is left, too.
    const double share = GetParam() == Shape::elliptic_arcs ? 0.4
                         : GetParam() == Shape::arcs        ? 0.05
                                                            : 0.01;
    EXPECT_LT(static_cast<double>(totals.scalar) - pinned,
              share * static_cast<double>(totals.hits));
  }
}

std::string name_of_shape(const testing::TestParamInfo<Shape>& tested) {
  constexpr const char* names[] = {"polygon", "arcs",    "stadium", "mushroom",
                                   "discs",   "annulus", "ellipse", "elliptic_arcs"};
  return names[static_cast<int>(tested.param)];
}
INSTANTIATE_TEST_SUITE_P(Shapes, Lanes,
                         testing::Values(Shape::polygon, Shape::arcs, Shape::stadium,
                                         Shape::mushroom, Shape::discs, Shape::annulus,
                                         Shape::ellipse, Shape::elliptic_arcs),
                         name_of_shape);

// Arcs of exactly one ellipse are one curve to them; other arcs of nearly one are for the scalar
// engine.
TEST(LaneRuns, FlyAmongArcsOfOneEllipse) {
  for (const bool exactly : {true, false}) {
    Dice dice(exactly ? 23 : 24);
    Totals totals;
    for (long k = 0; k < tests::cases(exactly ? 24 : 12, 6000) && !HasFailure(); ++k) {
      const double size = dice.coin() ? 1.0 : dice.spread(1e-6, 1e6),
                   thinnest = exactly || dice.coin() ? 0.1 : 1e-3;
      Table table = tests::cut_ellipse(size, dice.coin(), exactly, thinnest, dice).cut;
      if (dice.coin()) add_holes(table, dice);
      const World world(table);
      Case all;
      const double omega = k % 8 == 0 ? 0.0 : dice.sign() * dice.spread(0.02, 5.0) / size;
      for (int i = 0; i < 50; ++i)
        all.starts.push_back(random_start(table, world, dice, size, 1.0, omega));
      compare(table, all, totals, std::to_string(k).c_str());
    }
    EXPECT_GT(totals.hits, 20'000u);
    EXPECT_EQ(totals.fates[Fate::lost], 0);
    if (!exactly) break;
    EXPECT_LT(static_cast<double>(totals.scalar), 0.03 * static_cast<double>(totals.hits));
  }
}

TEST(LaneRuns, LeaveTheOpenPlane) {
  Dice dice(5);
  const Table table = tests::discs({{-1.3, 0}, {1.3, 0}, {0, 2.2}});
  const World world(table);
  Case all;
  for (int i = 0; i < 2000; ++i) all.starts.push_back(random_start(table, world, dice, 3.0, 1.0));
  add_times(all, table, dice);
  Totals totals;
  compare(table, all, totals, "three discs");
  EXPECT_GT(totals.fates[Fate::unbounded], 1000);
  EXPECT_LT(totals.scalar, 100u);
  // From far away towards the rim of a disc: such a start is seen with all its rounding.
  Case far;
  for (int i = 0; i < 2000; ++i) {
    LaneStart start;
    const tests::Vector v = dice.direction();
    const double distance = dice.spread(10.0, 1e12);
    start.state.position =
        tests::Vector{0, 2.2} + (1.0 + 1e-9 * dice.between(-1, 1)) * left(v) - distance * v;
    start.state.velocity = v;
    start.particle.speed = std::sqrt(dot(v, v));
    far.starts.push_back(start);
  }
  compare(table, far, totals, "three discs from far");
}

// Cells are crossed as the scalar engine crosses them; flights over very many cells are its own.
TEST(LaneRuns, CrossTheCellsOfLattices) {
  Dice dice(7);
  Totals totals, in_rectangles;
  for (long k = 0; k < tests::cases(30, 3000) && !HasFailure(); ++k) {
    const double size = dice.coin() ? 1.0 : dice.spread(1e-6, 1e6), angle = dice.between(0.9, 2.2);
    std::vector<tests::Vector> centres;
    // Also of discs that nearly touch, in rows far apart.
    const bool thin = k % 6 == 0;
    for (int i = k % 3 == 0 ? 1 : dice.whole(1, 3); i > 0; --i)
      centres.push_back(
          thin ? tests::Vector{}
               : tests::Vector{size * (0.22 * i - 0.44), size * dice.between(-0.1, 0.1)});
    const double radius = thin          ? 0.4999 - dice.spread(1e-6, 0.3)
                          : k % 3 == 0  ? dice.between(0.05, 0.3)
                          : dice.coin() ? dice.between(0.02, 0.1)
                                        : dice.spread(0.004, 0.1);
    Table table;
    for (const tests::Vector& c : centres)
      tests::add_loop(table, {geometry::Circle{c, radius * size, false}});
    table.extent = Extent::lattice;
    // One disc among rectangles, some of them turned, not in their middle; or hexagons.
    const bool rectangles = k % 3 == 0;
    const tests::Vector first{size, dice.coin() ? 0.0 : (rectangles ? 0.75 : 0.1) * size};
    const double stretch = first.y != 0.0 ? dice.whole(1, 2)
                           : thin         ? dice.spread(1.2, 20.0)
                                  : dice.between(0.8, 1.6);  // at right angles to the last digit
    const tests::Vector second = rectangles
                                     ? stretch * tests::Vector{-first.y, first.x}
                                     : size * tests::Vector{std::cos(angle), std::sin(angle)};
    table.lattice = geometry::make_lattice(first, second, {0, 0});
    add_holes(table, dice);
    const World world(table);
    Case all;
    all.limit = static_cast<std::uint64_t>(dice.whole(1, rectangles ? 1000 : 100));
    if (dice.coin()) all.t_end = dice.spread(1.0, 300.0) * size;
    for (int i = 0; i < 100; ++i)
      all.starts.push_back(random_start(table, world, dice, 3.0 * size, 1.0));
    if (!FreeLanes::hindrance(table, {all.starts[0].particle}).empty()) continue;
    if (dice.coin()) add_times(all, table, dice);
    const Totals before = totals;
    compare(table, all, totals, std::to_string(k).c_str());
    if (!rectangles) continue;
    in_rectangles.hits += totals.hits - before.hits;
    in_rectangles.scalar += totals.scalar - before.scalar;
  }
  EXPECT_GT(totals.hits, 100000u);
  EXPECT_GT(totals.fates[Fate::escaped], 100);
  EXPECT_GT(totals.fates[Fate::survived], 100);
  // Among small discs flights often cross more cells than lanes follow.
  EXPECT_LT(static_cast<double>(totals.scalar), 0.15 * static_cast<double>(totals.hits));
  EXPECT_GT(in_rectangles.hits, 10000u);
  EXPECT_LT(static_cast<double>(in_rectangles.scalar),
            0.05 * static_cast<double>(in_rectangles.hits));
}

// Larmor circles among the discs of all cells that they may come to.
TEST(LaneRuns, TurnAmongTheDiscsOfLattices) {
  Dice dice(8);
  Totals totals;
  int tables = 0;
  for (long k = 0; k < tests::cases(40, 4000) && !HasFailure(); ++k) {
    const double size = dice.coin() ? 1.0 : dice.spread(1e-6, 1e6), angle = dice.between(0.9, 2.2),
                 speed = dice.coin() ? 1.0 : dice.spread(1e-3, 1e3);
    Table table;
    for (int i = dice.whole(1, 2); i > 0; --i)
      tests::add_loop(table,
                      {geometry::Circle{{size * (0.3 * i - 0.45), size * dice.between(-0.1, 0.1)},
                                        size * dice.between(0.02, 0.14),
                                        false}});
    table.extent = Extent::lattice;
    table.lattice = geometry::make_lattice(
        {size, 0.0},
        size * dice.between(1.0, 1.5) * tests::Vector{std::cos(angle), std::sin(angle)}, {0, 0});
    if (dice.coin()) add_holes(table, dice);
    const World world(table);
    Case all;
    all.limit = static_cast<std::uint64_t>(dice.whole(1, 300));
    if (dice.coin()) all.t_end = dice.spread(1.0, 300.0) * size / speed;
    const double radius = size * dice.spread(0.05, 2.0);
    for (int i = 0; i < 100; ++i)
      all.starts.push_back(
          random_start(table, world, dice, 3.0 * size, speed, dice.sign() * speed / radius));
    for (LaneStart& start : all.starts)
      start.particle.omega = std::copysign(start.particle.omega, all.starts[0].particle.omega);
    if (!FreeLanes::hindrance(table, {all.starts[0].particle}).empty()) continue;
    ++tables;
    if (dice.coin()) add_times(all, table, dice);
    compare(table, all, totals, std::to_string(k).c_str());
  }
  EXPECT_GT(tables, 10);
  EXPECT_GT(totals.hits, 50000u);
  EXPECT_GT(totals.reports, 1000u);
  for (const Fate fate : {Fate::escaped, Fate::survived, Fate::capped, Fate::pinned})
    EXPECT_GT(totals.fates[fate], 100) << name_of(fate);
  EXPECT_LT(static_cast<double>(totals.scalar) - totals.fates[Fate::pinned],
            0.01 * static_cast<double>(totals.hits));
}

// A hole that is all of a closed wall has no end that a start could touch.
TEST(LaneRuns, LeaveThroughAWallThatIsAllHole) {
  Dice dice(9);
  for (const bool ellipse : {false, true}) {
    Table table =
        ellipse ? tests::loop({geometry::Ellipse{{0, 0}, {1, 0}, 0.7, true}}) : tests::disc(1.0);
    const double end = geometry::end_parameter(table.walls[0].curve);
    table.holes.push_back({"hole", 0, 0.0, end});
    table.walls[0].holes = {0};
    Case all;
    for (int i = 0; i < 400; ++i) {
      LaneStart start;
      start.state.velocity =
          tests::Vector{1.0, i % 4 == 0 ? 0.0 : dice.sign() * dice.spread(1e-18, 1e-3)};
      start.particle.speed = std::sqrt(dot(start.state.velocity, start.state.velocity));
      start.particle.omega = i < 200 ? 0.0 : 0.3;
      if (i == 200) {
        Totals totals;
        compare(table, all, totals, "all hole");
        EXPECT_EQ(totals.fates.size(), 1u);
        EXPECT_GT(totals.fates[Fate::escaped], 0);
        all.starts.clear();
      }
      all.starts.push_back(start);
    }
    Totals totals;
    compare(table, all, totals, "all hole, field");
    EXPECT_EQ(totals.fates.size(), 1u);
    EXPECT_GT(totals.fates[Fate::escaped], 0);
  }
}

// Starts after the end of the run, and a table too large for any margin.
TEST(LaneRuns, LeaveTheUnusualToTheWorld) {
  const Table discs = tests::discs({{-1.3, 0}, {1.3, 0}, {0, 2.2}});
  Case late;
  late.t_end = 5.0;
  LaneStart away;
  away.state.position = {0, -1};
  away.state.velocity = {0, -1};
  away.state.time = Time(6.0);
  late.starts = {away};
  Totals totals;
  compare(discs, late, totals, "late");
  EXPECT_GT(totals.fates[Fate::survived], 0);
  Case huge;
  LaneStart start;
  start.state.position = {0.3e30, 0.4e30};
  start.state.velocity = {0.6, 0.8};
  start.particle.omega = 1e-29;
  huge.starts = {start};
  huge.limit = 5;
  Totals none;
  compare(tests::rectangle(1e30, 1e30), huge, none, "huge");
}

}  // namespace
}  // namespace carom
