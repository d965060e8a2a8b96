// Paths whose velocities say one thing about a wall and whose positions another: a scheme's
// velocity is not quite the derivative of its positions. No particle is lost.
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "carom/events/world.hpp"
#include "random_tables.hpp"
#include "recorder.hpp"

namespace carom {
namespace {

using geometry::Vector;
using tests::Dice;
using tests::Recorder;

Dynamics stepped(const char* scheme, double step, PotentialSpec::Kind kind) {
  Dynamics dynamics;
  dynamics.everywhere = true;
  ForceSpec forces;
  forces.potentials.emplace_back().kind = kind;
  dynamics.forces = ForceField::build(forces, {Particle{}}, std::nullopt);
  dynamics.integrator.scheme = scheme;
  dynamics.integrator.step = step;
  return dynamics;
}

/// Hits until a time, of a particle that survives it within the table or on its wall.
std::size_t hits_of(World& world, Vector position, Vector velocity, double until) {
  world.clear();
  world.add(tests::particle(0.0, 1.0), tests::start(position, velocity));
  Recorder recorder;
  world.run_until(until, recorder);
  EXPECT_EQ(world.fate(0), Fate::survived) << world.report(0);
  return recorder.hits.size();
}

// A force turns the path back at the wall. Where it ends a step beyond the wall with a velocity
// that points inwards already, it has crossed.
TEST(SignsInSteps, PositionsDecideWherePathsGraze) {
  const Table table = tests::polygon({{-0.7, -0.5}, {0.6, -0.5}, {0.6, 0.8}, {-0.7, 0.8}});
  {
    World world(table, stepped("velocity-verlet", 0.1, PotentialSpec::Kind::henon_heiles));
    EXPECT_EQ(hits_of(world, {-0.6972111531894416, -0.12228690936143356},
                      {-0.054245774450409456, 0.3478292622985819}, 0.3),
              1u);
  }
  for (const char* scheme : {"velocity-verlet", "spreiter-walter"}) {
    World world(table, stepped(scheme, 0.1, PotentialSpec::Kind::henon_heiles));
    Dice dice(7);
    for (long k = 0; k < tests::cases(2000, 400000); ++k) {
      // The velocity across the wall is used up near it.
      const double speed = dice.spread(1e-3, 0.1), y = dice.between(-0.2, 0.4),
                   force = 0.7 * (1.0 + 2.0 * y);
      const double way =
          speed * speed / (2.0 * force) * (1.0 + dice.sign() * dice.spread(1e-4, 0.3));
      hits_of(world, {-0.7 + way, y}, {-speed, dice.between(-0.4, 0.4)}, 3.0 * speed / force);
    }
  }
}

// Nearly along a wall, parts of a path stay unclear however short they are: then the positions at
// their ends decide.
TEST(SignsInSteps, PositionsDecideNearlyAlongAWall) {
  const Table table = tests::polygon({{-0.7, 0}, {0.6, 0}, {0.6, 0.8}, {-0.7, 0.8}});
  {
    World world(table, stepped("velocity-verlet", 0.01, PotentialSpec::Kind::harmonic));
    EXPECT_EQ(hits_of(world, {-0.071081201562877894, 2.2832078435004426e-09},
                      {0.50686264114538115, -3.2121610352691017e-09}, 3.0),
              1u);
  }
  for (const auto& [scheme, step] : {std::pair{"velocity-verlet", 0.1}, {"forest-ruth-4", 0.1}}) {
    for (const PotentialSpec::Kind kind :
         {PotentialSpec::Kind::harmonic, PotentialSpec::Kind::henon_heiles}) {
      World world(table, stepped(scheme, step, kind));
      Dice dice(5);
      for (long k = 0; k < tests::cases(40, 2000); ++k)
        hits_of(world, {dice.between(-0.7, 0.6), dice.spread(1e-9, 1e-2)},
                {dice.sign() * dice.between(0.2, 1.0), -dice.spread(1e-9, 1e-2)}, 20.0);
    }
  }
}

}  // namespace
}  // namespace carom
