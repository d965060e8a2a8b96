// The tangent map against the engine: differences of orbits, areas, growth.
#include <gtest/gtest.h>

#include <cmath>

#include "carom/events/world.hpp"
#include "carom/geometry/curve_frame.hpp"
#include "carom/motion/tangent.hpp"
#include "random_tables.hpp"

namespace carom::tests {
namespace {

// The first hit of a state, and the state that it leaves.
struct First : Observer {
  void hit(const HitEvent& e) override {
    if (!found) event = e;
    found = true;
  }
  HitEvent event;
  bool found = false;
};
First first_hit(World& world, const Particle& particle, const State& start) {
  world.clear();
  First first;
  world.limit_hits(1);
  world.add(particle, start);
  world.run_until(1e9, first);
  return first;
}

// Birkhoff coordinates on a wall.
struct Birkhoff {
  double s = 0.0, p = 0.0;  ///< p: v_parallel over the speed
};
Birkhoff coordinates(const Table& table, const HitEvent& e) {
  const geometry::CurveFrame frame =
      geometry::frame_of(table.walls[static_cast<std::size_t>(e.wall)].curve);
  return {geometry::arc_length_at(frame, e.u), dot(e.after, geometry::tangent_at(frame, e.u))};
}
State state_at(const Table& table, int wall, Birkhoff b) {
  const geometry::CurveFrame frame =
      geometry::frame_of(table.walls[static_cast<std::size_t>(wall)].curve);
  State state;
  state.wall = wall;
  state.u = geometry::parameter_at_length(frame, b.s);
  state.position = geometry::point_at(frame, state.u);
  state.velocity = b.p * geometry::tangent_at(frame, state.u) +
                   std::sqrt(1.0 - b.p * b.p) * geometry::normal_at(frame, state.u);
  return state;
}
// The deviation of the flow whose Birkhoff coordinates are (ds, dp) at the wall.
Deviation flow_deviation(const Table& table, const State& state, double ds, double dp) {
  const geometry::CurveFrame frame =
      geometry::frame_of(table.walls[static_cast<std::size_t>(state.wall)].curve);
  const Vector t = geometry::tangent_at(frame, state.u), n = geometry::normal_at(frame, state.u);
  const double curvature = geometry::curvature_at(frame, state.u);
  const double p = dot(state.velocity, t), q = dot(state.velocity, n);
  // v = p t + q n with t' = curvature n, n' = -curvature t.
  return {ds * t, (curvature * ds) * (p * n - q * t) + dp * t - (dp * p / q) * n};
}
// (s, p) of a deviation after a hit, as it is seen at the wall.
Birkhoff seen(const Table& table, const HitEvent& e, const Deviation& d, double omega) {
  const geometry::CurveFrame frame =
      geometry::frame_of(table.walls[static_cast<std::size_t>(e.wall)].curve);
  const Vector t = geometry::tangent_at(frame, e.u), n = geometry::normal_at(frame, e.u);
  const AtWall at = at_wall(n, e.after, omega);
  const double s = dot(at.arc, d), turn = dot(at.angle, d);
  // dp = dv . t + v . dt
  return {s,
          dot(turn * left(e.after), t) + s * geometry::curvature_at(frame, e.u) * dot(e.after, n)};
}

TEST(TangentMap, IsTheDerivativeOfTheEngineAndKeepsAreas) {
  Dice dice(5);
  int compared = 0;
  const int kinds = static_cast<int>(Shape::count);
  for (int i = 0; compared < 2000; ++i) {
    ASSERT_LT(i, 100000);
    const Table table = random_table(static_cast<Shape>(i % kinds), 1.0, {0, 0}, dice, 3.0);
    Particle particle;
    particle.omega = i % 3 == 0 ? 0.0 : dice.between(-2, 2);
    const int wall = dice.whole(0, static_cast<int>(table.walls.size()) - 1);
    const double length = geometry::length(table.walls[static_cast<std::size_t>(wall)].curve);
    const Birkhoff b{length * dice.between(0.01, 0.99), dice.between(-0.95, 0.95)};
    World world(table);
    const State start = state_at(table, wall, b);
    const First middle = first_hit(world, particle, start);
    if (!middle.found || middle.event.reflections != 1) continue;
    const HitEvent& e = middle.event;
    const geometry::CurveFrame frame =
        geometry::frame_of(table.walls[static_cast<std::size_t>(e.wall)].curve);
    const Vector n = geometry::normal_at(frame, e.u);
    if (dot(e.after, n) < 0.2) continue;  // differences would need smaller steps
    const FlightTangent flight = flight_tangent(particle.omega, e.flight_time);
    const ReflectionTangent reflection =
        reflection_tangent(n, geometry::curvature_at(frame, e.u), e.before, particle.omega);
    double matrix[2][2];
    bool usable = true;
    for (int column = 0; column < 2; ++column) {
      const double ds = column == 0 ? 1.0 : 0.0, dp = 1.0 - ds, h = 0x1p-22;
      const Birkhoff image =
          seen(table, e, reflection(flight(flow_deviation(table, start, ds, dp))), particle.omega);
      matrix[0][column] = image.s;
      matrix[1][column] = image.p;
      const First more =
          first_hit(world, particle, state_at(table, wall, {b.s + h * ds, b.p + h * dp}));
      const First less =
          first_hit(world, particle, state_at(table, wall, {b.s - h * ds, b.p - h * dp}));
      usable = more.found && less.found && more.event.wall == e.wall && less.event.wall == e.wall;
      if (!usable) break;
      const Birkhoff x = coordinates(table, more.event), y = coordinates(table, less.event);
      if (std::fabs(x.s - y.s) > 0.5) usable = false;  // once around
      if (!usable) break;
      const double size = 1.0 + std::fabs(image.s) + std::fabs(image.p);
      EXPECT_NEAR((x.s - y.s) / (2 * h), image.s, 1e-5 * size * size * size)
          << table.walls[0].name << i;
      EXPECT_NEAR((x.p - y.p) / (2 * h), image.p, 1e-5 * size * size * size)
          << table.walls[0].name << i;
    }
    if (!usable) continue;
    ++compared;
    // Positions alone change orientation at a wall; (s, p) keeps it, and area.
    const double size = 1.0 + std::fabs(matrix[0][0] * matrix[1][1]);
    EXPECT_NEAR(matrix[0][0] * matrix[1][1] - matrix[0][1] * matrix[1][0], 1.0, 1e-11 * size) << i;
  }
}

// Carries one deviation along an orbit, renormalised when it grows.
struct Growth : Observer {
  Growth(const Table& table, double w) : omega(w) {
    for (const Wall& wall : table.walls) frames.push_back(geometry::frame_of(wall.curve));
  }
  void hit(const HitEvent& e) override {
    const geometry::CurveFrame& frame = frames[static_cast<std::size_t>(e.wall)];
    d = flight_tangent(omega, e.flight_time)(d);
    d = reflection_tangent(geometry::normal_at(frame, e.u), geometry::curvature_at(frame, e.u),
                           e.before, omega)(d);
    const double norm = std::sqrt(dot(d, d));
    ++hits;
    time = e.time.value();
    size = std::exp(logarithm) * norm;
    if (norm < 1e10) return;
    logarithm += std::log(norm);
    d = (1.0 / norm) * d;
  }
  double exponent() const { return (logarithm + 0.5 * std::log(dot(d, d))) / time; }
  double omega;
  std::vector<geometry::CurveFrame> frames;
  Deviation d{{0.3, -0.2}, {0.1, 0.5}};
  double logarithm = 0.0, time = 0.0, size = 0.0;
  long hits = 0;
};
Growth grown(const Table& table, double omega, State start, std::uint64_t hits) {
  World world(table);
  world.limit_hits(hits);
  Particle particle;
  particle.omega = omega;
  world.add(particle, start);
  Growth growth(table, omega);
  world.run_until(1e9, growth);
  return growth;
}

TEST(TangentMap, GrowsByTheLyapunovExponent) {
  State start;
  start.position = {0.123, 0.234};
  start.velocity = {0.6, 0.8};
  // The stadium's error is understated by intermittency.
  EXPECT_NEAR(grown(stadium(), 0.0, start, 400000).exponent(), 0.4297, 0.004);
  start.position = {0.9, 0.95};
  const Table torus = [] {
    Table t = loop({geometry::Circle{{0.5, 0.5}, 0.4, false}});
    t.extent = Extent::lattice;
    t.lattice = geometry::make_lattice({1, 0}, {0, 1}, {0.5, 0.5});
    return t;
  }();
  EXPECT_NEAR(grown(torus, 0.0, start, 200000).exponent(), 2.73845, 0.02);
}

TEST(TangentMap, GrowsLinearlyInIntegrableTables) {
  State start;
  start.position = {0.2, 0.3};
  start.velocity = {0.6, 0.8};
  for (const double omega : {0.0, 0.7}) {
    const double once = grown(disc(1.0), omega, start, 10000).size;
    const double twice = grown(disc(1.0), omega, start, 20000).size;
    EXPECT_NEAR(twice / once, 2.0, 0.02) << omega;
  }
  const double once = grown(square(), 0.0, start, 10000).size;
  EXPECT_NEAR(grown(square(), 0.0, start, 20000).size / once, 2.0, 1e-3);
}

}  // namespace
}  // namespace carom::tests
