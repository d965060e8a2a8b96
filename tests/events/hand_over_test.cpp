// Exact flights and integration check each other, and hand over at the edges of supports.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "carom/events/energy.hpp"
#include "carom/events/world.hpp"
#include "carom/files/system_file.hpp"
#include "carom/starts/sampler.hpp"

namespace carom {
namespace {

using geometry::Vector;

struct Recorder : Observer {
  std::vector<HitEvent> hits;
  std::vector<State> samples;
  void hit(const HitEvent& event) override { hits.push_back(event); }
  void sample(int, Time, const State& state) override { samples.push_back(state); }
};

Vector unwrapped(const System& system, const State& s) {
  return system.table->lattice ? s.position + system.table->lattice->translation(s.cell)
                               : s.position;
}

double energy(const System& system, const State& state) {
  return energy_of({system.particles.data(), 1}, {&state, 1}, system.dynamics, *system.table)
      .total();
}

Dynamics steps(const System& system, double step, const char* scheme = "") {
  Dynamics d = system.dynamics;
  d.everywhere = true;
  d.integrator.step = step;
  d.integrator.scheme = scheme;
  return d;
}

// Hits that two orbits share: same wall, nearly the same place.
std::size_t common(const Recorder& a, const Recorder& b, double tolerance) {
  std::size_t k = 0;
  while (k < a.hits.size() && k < b.hits.size() && a.hits[k].wall == b.hits[k].wall &&
         std::fabs(a.hits[k].u - b.hits[k].u) < tolerance)
    ++k;
  return k;
}

// Without forces a step of any splitting scheme is the exact flight: all that steps can add is
// rounding, which chaos amplifies.
TEST(HandOver, StepsRepeatFlights) {
  struct Case {
    const char* name;
    std::size_t least;
  };
  for (const Case& c : {Case{"stadium", 20}, Case{"mushroom", 20}, Case{"sinai", 10},
                        Case{"lorentz-triangular", 15}, Case{"circle", 400},
                        Case{"magnetic-square", 50}, Case{"ellipse-magnetic", 300}}) {
    const LoadedSystem loaded = load_system(c.name);
    const System& system = loaded.system;
    Table closed = *system.table;
    closed.holes.clear();
    for (Wall& wall : closed.walls) wall.holes.clear();
    World exact(closed), stepped(closed, steps(system, 0.1));
    const State start = Sampler(system).draw(exact, 1, 0);
    exact.add(system.particles[0], start);
    stepped.add(system.particles[0], start);
    Recorder a, b;
    exact.run_until(1000.0, a);
    stepped.run_until(1000.0, b);
    EXPECT_GE(common(a, b, 1e-3), c.least) << c.name;
    EXPECT_EQ(stepped.fate(0), Fate::survived) << stepped.report(0);
    const Vector v = stepped.state(0).velocity;
    EXPECT_NEAR(std::sqrt(dot(v, v)) / system.particles[0].speed, 1.0, 1e-12) << c.name;
  }
}

// With a magnetic field He's scheme does not contain the Larmor motion: it follows the exact orbit
// with its own order.
TEST(HandOver, SchemesFollowTheExactOrbitWithTheirOrder) {
  LoadedSystem loaded = load_system("magnetic-square");
  System& system = loaded.system;
  for (const auto& [scheme, order] : {std::pair{"he-2", 2}, std::pair{"he-4", 4}}) {
    double error[2];
    for (int level = 0; level < 2; ++level) {
      World exact(*system.table),
          stepped(*system.table, steps(system, 0.04 / (1 << level), scheme));
      const State start = Sampler(system).draw(exact, 3, 0);
      exact.add(system.particles[0], start);
      stepped.add(system.particles[0], start);
      Recorder a, b;
      exact.run_until(3.0, a);
      stepped.run_until(3.0, b);
      ASSERT_GE(a.hits.size(), 3u);
      ASSERT_EQ(a.hits.size(), b.hits.size());
      const Vector d = exact.state_at(0, 3.0).position - stepped.state_at(0, 3.0).position;
      error[level] = std::sqrt(dot(d, d));
    }
    EXPECT_NEAR(std::log2(error[0] / error[1]), order, 0.2) << scheme;
  }
}

const char* const dilute = R"(
[lattice]
vectors = [[1, 0], [0, 1]]
[[potential]]
kind = "fermi"
height = 2
radius = 0.02
softness = 0.001
lattice = true
[field]
B = FIELD
[particles]
energy = 0.5
[initial]
kind = "uniform"
[integrator]
step = 0.001
[run]
t_max = 100
)";

LoadedSystem dilute_system(const std::string& field) {
  std::string text = dilute;
  text.replace(text.find("FIELD"), 5, field);
  return read_system(text, "dilute");
}

// The supports cover one per cent of the cell: flying where nothing acts gives the orbit that
// integrating everything gives, until chaos has amplified rounding, with a small part of the
// events.
TEST(HandOver, FlyingBetweenBumpsIsTheSameMotion) {
  for (const char* field : {"0", "0.5", "-1"}) {
    const LoadedSystem loaded = dilute_system(field);
    const System& system = loaded.system;
    ASSERT_FALSE(system.dynamics.forces->everywhere());
    const double r = system.dynamics.forces->supports().front().radius;
    EXPECT_NEAR(3.14159 * r * r, 0.01, 0.001);
    for (int trajectory = 0; trajectory < 3; ++trajectory) {
      World free(*system.table, system.dynamics);
      World integrated(*system.table, steps(system, 0.001));
      const State start = Sampler(system).draw(free, static_cast<std::uint64_t>(trajectory), 0);
      Recorder a, b;
      std::uint64_t events[2];
      int k = 0;
      for (auto& [world, recorder] : {std::pair<World*, Recorder*>{&free, &a}, {&integrated, &b}}) {
        world->add(system.particles[0], start);
        world->sample_every(0.5);
        events[k++] = world->run_until(100.0, *recorder);
        // A Larmor circle between the bumps is known never to meet one.
        EXPECT_TRUE(world->fate(0) == Fate::survived || world->fate(0) == Fate::pinned)
            << world->report(0);
        EXPECT_NEAR(energy(system, world->state(0)), energy(system, start), 1e-9);
      }
      EXPECT_LT(20 * events[0], events[1]);
      ASSERT_EQ(a.samples.size(), b.samples.size());
      for (std::size_t i = 0; i < 3; ++i) {
        const Vector d = unwrapped(system, a.samples[i]) - unwrapped(system, b.samples[i]);
        EXPECT_LT(std::sqrt(dot(d, d)), 1e-10) << field << " " << trajectory << " sample " << i;
      }
    }
  }
}

TEST(HandOver, SamplesChangeNothing) {
  const LoadedSystem loaded = dilute_system("0.5");
  const System& system = loaded.system;
  State end[2];
  for (int sampled = 0; sampled < 2; ++sampled) {
    World world(*system.table, system.dynamics);
    world.add(system.particles[0], Sampler(system).draw(world, 5, 0));
    if (sampled) world.sample_every(0.03125);
    Recorder recorder;
    world.run_until(50.0, recorder);
    end[sampled] = world.state_at(0, 50.0);
  }
  EXPECT_EQ(end[0].position, end[1].position);
  EXPECT_EQ(end[0].velocity, end[1].velocity);
}

// A bump that reaches over a wall, a hole behind it, and a stretch of free flight: the energy is
// the same at the end, nothing is lost, and reversed the particle comes back.
TEST(HandOver, BumpsMayReachOverWalls) {
  const char* const text = R"(
[table]
shape = "rectangle"
width = 1
height = 1
[[potential]]
kind = "gaussian"
height = 0.4
width = 0.03
centers = [[0.0, 0.4], [0.5, 0.5], [0.9, 0.95]]
[particles]
energy = 0.5
[integrator]
step = 0.002
[run]
t_max = 30
)";
  const LoadedSystem loaded = read_system(text, "bumps");
  const System& system = loaded.system;
  for (std::uint64_t trajectory = 0; trajectory < 20; ++trajectory) {
    World world(*system.table, system.dynamics);
    const State start = Sampler(system).draw(world, trajectory, 0);
    world.add(system.particles[0], start);
    Recorder recorder;
    world.run_until(200.0, recorder);
    EXPECT_EQ(world.fate(0), Fate::survived) << world.report(0);
    EXPECT_GT(recorder.hits.size(), 50u);
    EXPECT_NEAR(energy(system, world.state(0)), 0.5, 1e-10);
  }
  World there(*system.table, system.dynamics);
  const State start = Sampler(system).draw(there, 2, 0);
  there.add(system.particles[0], start);
  Observer silent;
  there.run_until(4.0, silent);
  State turned = there.state_at(0, 4.0);
  turned.velocity = -turned.velocity;
  turned.time = Time();
  World back(*system.table, system.dynamics);
  back.add(system.particles[0], turned);
  back.run_until(4.0, silent);
  const Vector d = back.state_at(0, 4.0).position - start.position;
  EXPECT_LT(std::sqrt(dot(d, d)), 1e-8);
}

// Walls with corners of every kind, small steps and large: no particle slips through.
TEST(HandOver, NoParticleIsLostAtJoints) {
  const char* const tables[] = {
      "shape = \"polygon\"\npoints = [[0, 0], [3, 0], [3, 1], [1, 1], [1, 2], [0, 2]]\n",
      ("shape = \"polygon\"\npoints = [[0, 0], [2, 0.25], [4, 0], [2.5, 1], [4, 3], [2, 1.5], "
       "[0, 3], [1, 1]]\n"),
      "shape = \"mushroom\"\ncap_radius = 1\nstem_width = 0.5\nstem_height = 1\n",
      "shape = \"lemon\"\nradius = 1\nseparation = 1\n",
      "shape = \"annulus\"\nouter = 1\ninner = 0.5\noffset = 0.25\n",
  };
  for (const char* table : tables) {
    for (const char* field : {"0", "0.7"}) {
      const std::string text =
          std::string("[table]\n") + table + "[field]\nB = " + field +
          "\n[[potential]]\nkind = \"linear\"\nforce = [0.1, -0.3]\n[particles]\nspeed = 1\n"
          "[integrator]\nstep = 0.2\n[run]\nt_max = 300\n";
      const LoadedSystem loaded = read_system(text, "joints");
      const System& system = loaded.system;
      for (std::uint64_t trajectory = 0; trajectory < 10; ++trajectory) {
        World world(*system.table, system.dynamics);
        world.add(system.particles[0], Sampler(system).draw(world, trajectory, 0));
        Recorder recorder;
        world.run_until(300.0, recorder);
        EXPECT_NE(world.fate(0), Fate::lost) << table << world.report(0);
        for (const HitEvent& hit : recorder.hits) {
          const double square = dot(hit.before, hit.before);
          EXPECT_NEAR(dot(hit.after, hit.after), square, 1e-14 * square);
        }
      }
    }
  }
}

}  // namespace
}  // namespace carom
