// Paths within steps that are aimed at a joint of two walls, down to nearly along one of them: one
// of the two turns them back, or the joint ends them, but none slips between.
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "carom/events/world.hpp"
#include "carom/table/table_spec.hpp"
#include "random_tables.hpp"
#include "recorder.hpp"

namespace carom {
namespace {

using geometry::Vector;
using tests::Dice;
using tests::Recorder;
using tests::Shape;

Vector turned(Vector v, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * v.x - s * v.y, s * v.x + c * v.y};
}
Vector unit(Vector v) { return (1.0 / std::sqrt(dot(v, v))) * v; }

/// Along the wall at its start or at its end.
Vector tangent(const geometry::Curve& curve, bool at_end) {
  const double u = at_end ? geometry::end_parameter(curve) : 0.0;
  return unit(-1.0 * left(geometry::normal_at(curve, u)));
}

enum class Kind { random, many_sides, wedge, obstacle, turned_wedge, flat_arc, curves, lens };

/// `shape`: of random tables.
Table table_of(Kind kind, Shape shape, double size, Vector at, Dice& dice) {
  const auto corners = [&](int n, double radius, bool clockwise) {
    std::vector<Vector> points;
    for (int k = 0; k < n; ++k)
      points.push_back(
          at + turned({radius, 0.0}, (clockwise ? -6.283185307179586 : 6.283185307179586) * k / n));
    return points;
  };
  switch (kind) {
    case Kind::random:
      return tests::random_table(shape, size, shape == Shape::mushroom ? Vector{} : at, dice);
    case Kind::many_sides:
      return tests::polygon(corners(dice.whole(8, 400), size, false));
    case Kind::wedge:
      return tests::polygon(
          {at, at + Vector{size, 0.0}, at + Vector{size, size * dice.spread(1e-4, 0.3)}});
    case Kind::turned_wedge: {  // the tip at the origin, the walls of lengths of their own: rounded
                                // differently
      const Vector along = turned({1.0, 0.0}, dice.between(0.0, 6.28));
      return tests::polygon(
          {{0.0, 0.0},
           size * along,
           (size * dice.spread(0.1, 10.0)) * turned(along, dice.spread(1e-3, 1.0))});
    }
    case Kind::flat_arc: {  // rounded more than the side that it meets at the tip
      const double offset = dice.spread(2.0, 2e4), rise = 1.0 / offset + dice.spread(1e-3, 0.5);
      const Vector side = {size * dice.spread(1e-3, 0.9), 0.0}, far = {size, size * rise};
      const bool outwards =
          dice.coin() || side.x < 0.4 * size;  // else it would cross the longer side
      return tests::loop(
          {geometry::Segment{{0.0, 0.0}, side}, geometry::Segment{side, far},
           geometry::CircularArc{far, {0.0, 0.0}, outwards ? offset : -offset, outwards}});
    }
    case Kind::curves: {
      TableSpec spec;
      spec.shape = "spline";
      const int n = dice.whole(4, 9);
      for (int k = 0; k < n; ++k) {
        const Vector x =
            at + turned({size * dice.between(0.7, 1.0), 0.0}, 6.283185307179586 * k / n);
        spec.points["points"].push_back({ExactNumber(x.x), ExactNumber(x.y)});
      }
      return build_table(spec);
    }
    case Kind::lens: {  // two corners between curves
      const Vector a = at - Vector{size, 0.0}, b = at + Vector{size, 0.0};
      const auto up = [&](double x) { return at + Vector{x * size, size * dice.spread(0.1, 1.0)}; };
      const auto down = [&](double x) {
        return at - Vector{x * size, size * dice.spread(0.1, 1.0)};
      };
      return tests::loop({geometry::Bezier{b, a, {{up(0.4), up(-0.4)}}, 3},
                          geometry::Bezier{a, b, {{down(0.4), down(0.0), down(-0.4)}}, 4}});
    }
    case Kind::obstacle:
      break;
  }
  Table table = tests::polygon(corners(4, size, false));
  const std::vector<Vector> inner = corners(dice.whole(3, 60), 0.4 * size, true);
  std::vector<geometry::Curve> sides;
  for (std::size_t i = 0; i < inner.size(); ++i)
    sides.push_back(geometry::Segment{inner[i], inner[(i + 1) % inner.size()]});
  tests::add_loop(table, sides);
  return table;
}

struct Count {
  long flown = 0, singular = 0;
};

void aim_at_joints(Kind kind, Shape shape, const ForceSpec& forces, Dice& dice, Count& count,
                   double far = 30.0) {
  const Vector force = forces.potentials.empty() ? Vector{} : forces.potentials.front().force;
  const double size = dice.spread(0.3, 5.0);
  const Vector at =
      dice.coin() ? Vector{} : Vector{dice.between(-far, far), dice.between(-far, far)};
  const Table table = table_of(kind, shape, size, at, dice);
  Dynamics dynamics;
  dynamics.everywhere = true;
  dynamics.forces = ForceField::build(forces, {Particle{}}, std::nullopt);
  dynamics.integrator.scheme = "velocity-verlet";
  dynamics.integrator.step = size * dice.spread(0.01, 0.3);
  World world(table, dynamics);
  world.limit_hits(1000);  // in wedges and along arcs
  for (int k = 0; k < 60; ++k) {
    const auto b =
        static_cast<std::size_t>(dice.whole(0, static_cast<int>(table.walls.size()) - 1));
    const Wall& begins = table.walls[b];
    const Wall& ends = table.walls[static_cast<std::size_t>(begins.previous)];
    const Vector joint = geometry::point_at(begins.curve, 0.0);
    const double angle = dice.coin() ? dice.spread(1e-9, 0.3) : dice.spread(0.01, 0.3);
    const Vector back = dice.coin() ? turned(-1.0 * tangent(ends.curve, true), -angle)
                                    : turned(tangent(begins.curve, false), angle);
    // Backwards along the parabola from the joint.
    const double t = size * dice.spread(0.003, 0.3), speed = dice.spread(0.5, 2.0);
    Vector start = joint + (speed * t) * back + (0.5 * t * t) * force;
    const Vector velocity = (-speed) * back - t * force;
    for (int n = dice.whole(0, 3); n > 0; --n)
      start.x = std::nextafter(start.x, dice.coin() ? 1e30 : -1e30);
    if (!world.contains(start)) continue;
    world.clear();
    world.add(tests::particle(0.0, std::sqrt(dot(velocity, velocity))),
              tests::start(start, velocity));
    Recorder recorder;
    world.run_until(3.0 * t, recorder);
    ++count.flown;
    count.singular += world.fate(0) == Fate::singular;
    EXPECT_NE(world.fate(0), Fate::lost) << world.report(0);
    if (world.fate(0) == Fate::survived) {
      EXPECT_TRUE(world.state(0).wall >= 0 || world.contains(world.state_at(0, 3.0 * t).position))
          << "angle " << angle << ", start " << start.x << " " << start.y << ", joint " << joint.x
          << " " << joint.y;
    }
  }
}

TEST(JointsInSteps, AreWatertight) {
  Dice dice(77);
  ForceSpec none, pull;
  PotentialSpec linear;
  linear.kind = PotentialSpec::Kind::linear;
  linear.force = {0.3, -0.7};
  pull.potentials.push_back(linear);
  const std::pair<Kind, Shape> tables[] = {
      {Kind::random, Shape::polygon},       {Kind::random, Shape::arcs},
      {Kind::random, Shape::stadium},       {Kind::random, Shape::mushroom},
      {Kind::random, Shape::elliptic_arcs}, {Kind::many_sides, Shape::polygon},
      {Kind::wedge, Shape::polygon},        {Kind::obstacle, Shape::polygon},
      {Kind::turned_wedge, Shape::polygon}, {Kind::flat_arc, Shape::polygon},
      {Kind::curves, Shape::polygon},       {Kind::lens, Shape::polygon}};
  for (const auto& [kind, shape] : tables)
    for (const ForceSpec* forces : {&none, &pull}) {
      Count count;
      const long all = tests::cases(30, 6000);
      for (long k = 0; k < all; ++k) aim_at_joints(kind, shape, *forces, dice, count);
      EXPECT_GT(count.flown, 13 * all);
      // Common tangents of walls turn back nearly all.
      if (shape == Shape::stadium) {
        EXPECT_LT(count.singular, count.flown / 20);
      }
    }
}

// So far from the origin that a wall is rounded to a millionth of its length, parts of a path may
// seem bent by rounding.
TEST(JointsInSteps, AreWatertightFarAway) {
  Dice dice(78);
  for (const Shape shape : {Shape::polygon, Shape::stadium}) {
    Count count;
    for (long k = 0; k < tests::cases(100, 6000); ++k)
      aim_at_joints(Kind::random, shape, {}, dice, count, 1e8);
    EXPECT_GT(count.flown, 1000);
  }
}

// Near its tip a needle is so thin that a particle on one side is on the other, too: it went
// through, or to and fro.
TEST(JointsInSteps, TipsOfNeedlesAreSingular) {
  for (const double width : {1e-4, 1e-6}) {
    Table table = tests::polygon({{-4, -4}, {4, -4}, {4, 4}, {-4, 4}});
    tests::add_loop(table, {geometry::Segment{{0.3, 0.2}, {1.3, 0.2}},
                            geometry::Segment{{1.3, 0.2}, {1.3, 0.2 - width}},
                            geometry::Segment{{1.3, 0.2 - width}, {0.3, 0.2}}});
    Dynamics dynamics;
    dynamics.everywhere = true;
    dynamics.forces = ForceField::build({}, {Particle{}}, std::nullopt);
    dynamics.integrator.scheme = "velocity-verlet";
    dynamics.integrator.step = 0.1;
    World world(table, dynamics);
    world.limit_hits(100);
    for (const double along : {0.6, -0.6})
      for (const double thickness : {1e-18, 1e-16, 1e-15, 3e-15, 1e-13}) {
        const Vector velocity{along, -0.8};
        world.clear();
        world.add(tests::particle(0.0, 1.0),
                  tests::start(Vector{0.3 + thickness / width, 0.2} - 0.25 * velocity, velocity));
        Recorder recorder;
        world.run_until(0.5, recorder);
        EXPECT_EQ(world.fate(0), thickness < 1e-14 ? Fate::singular : Fate::survived)
            << width << " " << thickness;
        EXPECT_LE(recorder.hits.size(), 1u);
      }
  }
}

// The tip of a wedge lies at the origin, where numbers are fine, and so is the wall along the axis;
// the other one is off by what its far end is rounded to. A particle that comes along that one may
// stand beyond the first.
TEST(JointsInSteps, AreAsWideAsTheWallThatIsRoundedMore) {
  struct Case {
    Vector far, start, velocity;
    double step;
  };
  for (const Case& c : {Case{{0x1.2367a579cd57dp-1, 0x1.32d796cf4d5ccp-3},
                             {0x1.cf326f386c14bp-4, 0x1.e6a184b701affp-6},
                             {-0x1.6ca3c784fa02fp-1, -0x1.7f1666d81638p-3},
                             0x1.9bdc3eb5ea17ap-8},
                        Case{{0x1.12a1cadaae971p+1, 0x1.dfc7448726692p-3},
                             {0x1.733b0cd68ebccp-2, 0x1.44445c06dd7adp-5},
                             {-0x1.156323489d827p+0, -0x1.e49753a71a4ddp-4},
                             0x1.561bb6645da05p-4},
                        Case{{0x1.019101232b1e4p+2, 0x1.7930350c5d7e3p-1},
                             {0x1.1723dd53f7b83p+0, 0x1.984c66cae1afep-3},
                             {-0x1.8f69c26643036p+0, -0x1.241c671ad8203p-2},
                             0x1.64c43b519262fp-3}}) {
    Dynamics dynamics;
    dynamics.everywhere = true;
    dynamics.forces = ForceField::build({}, {Particle{}}, std::nullopt);
    dynamics.integrator.scheme = "velocity-verlet";
    dynamics.integrator.step = c.step;
    const Table table = tests::polygon({{0, 0}, {c.far.x, 0}, c.far});
    World world(table, dynamics);
    world.add(tests::particle(0.0, std::sqrt(dot(c.velocity, c.velocity))),
              tests::start(c.start, c.velocity));
    Recorder recorder;
    world.run_until(1.0, recorder);
    EXPECT_EQ(world.fate(0), Fate::singular) << world.report(0);
  }
}

}  // namespace
}  // namespace carom
