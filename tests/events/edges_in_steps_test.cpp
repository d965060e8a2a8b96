// Edges of supports where they meet others.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "carom/events/energy.hpp"
#include "carom/events/world.hpp"
#include "carom/files/system_file.hpp"
#include "carom/starts/sampler.hpp"
#include "random_tables.hpp"
#include "recorder.hpp"

namespace carom::tests {
namespace {

Dynamics bumps(const PotentialSpec& bump, const char* scheme, double step) {
  ForceSpec spec;
  spec.potentials.push_back(bump);
  Dynamics d;
  d.forces = ForceField::build(spec, {Particle{}}, std::nullopt);
  d.integrator.scheme = scheme;
  d.integrator.step = step;
  return d;
}

double energy(const State& s, const Dynamics& d, const Table& table) {
  const Particle p;
  return energy_of({&p, 1}, {&s, 1}, d, table).total();
}

// Does the run come to its end, within so many times 256 events?
bool ends(World& world, double until, long most = 400) {
  Observer silent;
  long asked = 0;
  world.run_until(until, silent, [&] { return ++asked > 16 * most; });
  return asked <= 16 * most;
}

Table square() { return polygon({{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}); }

PotentialSpec three_bumps() {
  PotentialSpec bump;
  bump.kind = PotentialSpec::Kind::fermi;
  bump.height = 0.1;
  bump.radius = 0.1;
  bump.softness = 0.005;
  bump.centers = {{0, 0}, {0.25, 0.1}, {0.1, 0.3}};
  return bump;
}

// At t = 14.2467 this particle crosses the edge of one support within another, where the gap rounds
// to more than 0.
TEST(EdgesInSteps, AnEdgeThatIsHeldEndsNoStep) {
  const Table table = square();
  const Dynamics dynamics = bumps(three_bumps(), "velocity-verlet", 0.0045240182404161907);
  const State at = start({0.88510033188189552, 0.20096750684441766},
                         {-0.55691887986372834, -0.062057780626760657});
  World world(table, dynamics);
  world.add(particle(0.0, std::sqrt(dot(at.velocity, at.velocity))), at);
  ASSERT_TRUE(ends(world, 20.0));
  EXPECT_EQ(world.fate(0), Fate::survived);
  EXPECT_NEAR(energy(world.state_at(0, 20.0), dynamics, table), energy(at, dynamics, table), 1e-4);
}

TEST(EdgesInSteps, CopiesOnALatticeHoldEachOther) {
  SystemOverrides how;
  how.set = {{"potential[0].softness", "0.0105"}, {"integrator.step", "0.02"}};
  const System system = load_system("soft-lorentz", how).system;
  ASSERT_FALSE(system.dynamics.forces->everywhere());
  for (const std::uint64_t trajectory : {3u, 7u, 9u}) {
    World world(*system.table, system.dynamics);
    world.add(system.particles[0], Sampler(system).draw(world, trajectory, 0));
    EXPECT_TRUE(ends(world, 2000.0, 2000)) << trajectory;
  }
}

// Where two edges cross a particle may leave one support and enter the other at once. Orbits are
// aimed there by going backwards: the other bump acts, so the energy is kept as where everything is
// integrated, and so is the orbit.
TEST(EdgesInSteps, WhereTwoEdgesCrossNoBumpIsMissed) {
  Dice dice(7);
  Table plane;
  plane.extent = Extent::open_plane;
  for (long n = cases(1000, 50000); n > 0; --n) {
    PotentialSpec bump;
    bump.kind = PotentialSpec::Kind::gaussian;
    bump.height = dice.spread(0.01, 0.2) * dice.sign();
    bump.width = dice.spread(0.01, 0.05);
    bump.centers = {{dice.between(-0.5, 0.5), dice.between(-0.5, 0.5)}};
    const double radius = std::sqrt(2.0 * 36.85) * bump.width;
    bump.centers.push_back(bump.centers[0] + radius * dice.between(0.3, 1.9) * dice.direction());
    const Dynamics dynamics = bumps(bump, "", 0.3 * bump.width);
    Dynamics everywhere = dynamics;
    everywhere.everywhere = true;
    const std::vector<Support> supports = dynamics.forces->supports();
    ASSERT_EQ(supports.size(), 2u);
    const Vector between = supports[1].center - supports[0].center;
    const double square = dot(between, between);
    const double across = std::sqrt(supports[0].radius * supports[0].radius / square - 0.25);
    const Vector crossing =
        supports[0].center + 0.5 * between + (across * dice.sign()) * left(between);
    const double time = dice.spread(0.003, 0.5);
    World back(plane, everywhere), world(plane, dynamics), stepped(plane, everywhere);
    back.add(particle(), start(crossing, dice.direction()));
    Observer silent;
    back.run_until(time, silent);
    const State there = back.state_at(0, time);
    const State at = start(there.position, -there.velocity);
    State end[2];
    for (World* w : {&world, &stepped}) {
      w->add(particle(0.0, std::sqrt(dot(at.velocity, at.velocity))), at);
      ASSERT_TRUE(ends(*w, 1.5)) << n;
      end[w == &stepped] = w->state_at(0, 1.5);
    }
    const Vector apart = end[0].position - end[1].position;
    EXPECT_LT(std::sqrt(dot(apart, apart)), 1e-6) << n;
    EXPECT_NEAR(energy(end[0], dynamics, plane), energy(end[1], dynamics, plane), 1e-8) << n;
  }
}

// Where an edge meets a wall, or a corner, the wall comes first. Orbits are aimed there to a few
// ulps, from inside the support by going backwards and from outside along a line: all do what they
// do where everything is integrated, but at corners.
TEST(EdgesInSteps, WhereAnEdgeMeetsAWallTheWallComesFirst) {
  Dice dice(11);
  long hits = 0;
  const long all = cases(1500, 100000);
  for (long n = all; n > 0; --n) {
    PotentialSpec bump;
    bump.kind = PotentialSpec::Kind::gaussian;
    bump.height = dice.spread(0.01, 0.2) * dice.sign();
    bump.width = dice.spread(0.005, 0.03);
    const double radius = std::sqrt(2.0 * 36.85) * bump.width;
    const double tilt = dice.coin() ? 0.0 : dice.between(-0.3, 0.3), bend = dice.between(0.8, 10.0);
    const int kind = dice.whole(0, 2);
    const Vector left_end{-1, -tilt}, right_end{1, tilt},
        corner{dice.between(-0.5, 0.5), dice.between(-0.2, 0.2)};
    const Table table =
        kind == 0 ? polygon({left_end, right_end, {1, 1.5}, {-1, 1.5}})
        : kind == 1
            ? loop({CircularArc{left_end, right_end, bend, true}, Segment{right_end, {1, 1.5}},
                    Segment{{1, 1.5}, {-1, 1.5}}, Segment{{-1, 1.5}, left_end}})
            : polygon({left_end, corner, right_end, {1, 1.5}, {-1, 1.5}});
    const geometry::Curve& wall = table.walls[0].curve;
    const double u = geometry::end_parameter(wall) * (kind == 2 ? 1.0 : dice.between(0.3, 0.7));
    const Vector meeting = geometry::point_at(wall, u), normal = geometry::normal_at(wall, u);
    const Vector up = (1.0 / std::sqrt(dot(normal, normal))) * normal;
    const double lean = dice.between(-1.2, 1.2);
    const Vector to_centre = std::cos(lean) * up + std::sin(lean) * left(up);
    bump.centers = {meeting + radius * to_centre};
    const Dynamics dynamics = bumps(bump, "", 0.3 * bump.width);
    Dynamics everywhere = dynamics;
    everywhere.everywhere = true;
    Table plane;
    plane.extent = Extent::open_plane;
    World back(plane, everywhere), world(table, dynamics), stepped(table, everywhere);
    const double turn = dice.between(-1.4, 1.4);
    back.add(particle(), start(meeting, std::cos(turn) * up + std::sin(turn) * left(up)));
    Observer silent;
    const double time = dice.spread(0.003, 0.3);
    back.run_until(time, silent);
    const State there = back.state_at(0, time);
    State at = start(there.position, -there.velocity);
    for (int k = dice.whole(0, 4); k > 0; --k) {
      double& x = dice.coin() ? at.position.x : at.position.y;
      x = std::nextafter(x, dice.coin() ? 9.0 : -9.0);
    }
    if (!world.contains(at.position)) continue;
    Recorder seen[2];
    for (World* w : {&world, &stepped}) {
      w->add(particle(0.0, std::sqrt(dot(at.velocity, at.velocity))), at);
      w->run_until(2.0 * time, seen[w == &stepped]);
    }
    ASSERT_NE(world.fate(0), Fate::lost) << n << world.report(0);
    const bool goes_on = world.fate(0) == Fate::survived;
    EXPECT_TRUE(!goes_on || world.contains(world.state_at(0, 2.0 * time).position)) << n;
    if (kind == 2) continue;  // an exact flight tells which particle just passes the corner
    ASSERT_EQ(world.fate(0), stepped.fate(0)) << n << world.report(0) << stepped.report(0);
    ASSERT_EQ(seen[0].hits.size(), seen[1].hits.size()) << n;
    hits += static_cast<long>(seen[0].hits.size());
    if (!goes_on) continue;
    const Vector apart =
        world.state_at(0, 2.0 * time).position - stepped.state_at(0, 2.0 * time).position;
    EXPECT_LT(std::sqrt(dot(apart, apart)), 1e-6) << n;
  }
  EXPECT_GT(hits, all / 3);
}

// Random bumps, some of them over walls, with and without field: every run ends, no particle is
// lost, and the energy changes as it does where everything is integrated.
TEST(EdgesInSteps, OrbitsAmongOverlappingBumpsRunBack) {
  Dice dice(5);
  const Table table = square();
  long flown = 0;
  for (long n = cases(40, 2000); n > 0; --n) {
    PotentialSpec bump;
    const bool fermi = dice.coin();
    bump.kind = fermi ? PotentialSpec::Kind::fermi : PotentialSpec::Kind::gaussian;
    bump.height = dice.spread(0.01, 0.2) * dice.sign();
    bump.radius = dice.between(0.02, 0.15);
    bump.softness = dice.spread(0.002, 0.01);
    bump.width = dice.spread(0.01, 0.05);
    for (int k = dice.whole(2, 5); k > 0; --k)
      bump.centers.push_back({dice.between(-0.9, 0.9), dice.between(-0.9, 0.9)});
    const double length = fermi ? bump.softness : bump.width;
    const Dynamics dynamics = bumps(bump, "", length * dice.between(0.2, 0.5));
    Dynamics everywhere = dynamics;
    everywhere.everywhere = true;
    World world(table, dynamics), stepped(table, everywhere);
    const double omega = dice.coin() ? 0.0 : dice.between(-2.0, 2.0);
    for (int k = 0; k < 5; ++k) {
      const State at = start({dice.between(-1, 1), dice.between(-1, 1)},
                             dice.spread(0.5, 1.5) * dice.direction());
      double change[2];
      for (World* w : {&world, &stepped}) {
        w->clear();
        w->add(particle(omega, std::sqrt(dot(at.velocity, at.velocity))), at);
        ASSERT_TRUE(ends(*w, 20.0)) << n;
        EXPECT_TRUE(w->fate(0) == Fate::survived || w->fate(0) == Fate::pinned) << w->report(0);
        change[w == &stepped] =
            std::fabs(energy(w->state_at(0, 20.0), dynamics, table) - energy(at, dynamics, table));
      }
      EXPECT_LT(change[0], 1e-6 + 30.0 * change[1]);
      ++flown;
    }
  }
  EXPECT_GT(flown, 100);
}

}  // namespace
}  // namespace carom::tests
