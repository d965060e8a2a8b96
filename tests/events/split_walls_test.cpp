// walls = "split": kicks, and between them drifts that see the walls and nothing else.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "carom/events/energy.hpp"
#include "recorder.hpp"

namespace carom::tests {
namespace {

/// An anisotropic well off the centre of a hard circle.
Dynamics well(double step, bool split, const std::string& scheme = "velocity-verlet") {
  ForceSpec spec;
  PotentialSpec v;
  v.kind = PotentialSpec::Kind::harmonic;
  v.omega_x = 1.14;
  v.omega_y = 0.8366;
  v.centers = {{0.21, -0.13}};
  spec.potentials = {v};
  Dynamics d;
  d.forces = ForceField::build(spec, {particle()}, std::nullopt);
  d.integrator = {scheme, step, 0.0, split};
  return d;
}

struct Orbit {
  State end;
  std::vector<HitEvent> hits;
  double energy_change = 0.0;
  Fate fate = Fate::survived;
};

Orbit follow(const Table& table, const Dynamics& d, double omega, const State& from, double t_end) {
  World world(table, d);
  const Particle p = particle(omega, std::sqrt(dot(from.velocity, from.velocity)));
  world.add(p, from);
  Recorder recorder;
  world.run_until(t_end, recorder);
  const State end = world.state_at(0, Time(t_end));
  const auto energy = [&](const State& s) { return energy_of({&p, 1}, {&s, 1}, d, table).total(); };
  return {end, recorder.hits, energy(end) - energy(from), world.fate(0)};
}

State circle_start() { return start({0.125, 0.0625}, {0.75, 0.5}); }

double distance(const State& a, const State& b) {
  const Vector x = a.position - b.position, v = a.velocity - b.velocity;
  return std::sqrt(dot(x, x) + dot(v, v));
}

/// Mean over some lengths of steps: the change at a hit depends on where within a step it falls.
double mean_error(const Table& table, double omega, bool split, int steps, const State& exact, double t_end) {
  double sum = 0.0;
  constexpr int lengths = 16;
  for (int k = 0; k < lengths; ++k) {
    const double step = t_end / (steps + steps * k / 37);
    sum += distance(follow(table, well(step, split), omega, circle_start(), t_end).end, exact);
  }
  return sum / lengths;
}

// Before the first hit it is the scheme itself, but for the rounding of the times of drifts.
TEST(SplitWalls, TheSchemeItselfFarFromWalls) {
  const Table table = disc(5.0);
  for (const char* scheme : {"velocity-verlet", "mclachlan-2", "mclachlan-atela-2"}) {
    const Orbit split = follow(table, well(0.125, true, scheme), 0.5, circle_start(), 10.0);
    const Orbit plain = follow(table, well(0.125, false, scheme), 0.5, circle_start(), 10.0);
    EXPECT_LT(distance(split.end, plain.end), 1e-13) << scheme;
    EXPECT_TRUE(split.hits.empty());
  }
}

// Order 2 before the first hit; 1 from then on, as a hit changes the energy by what the kicks leave out.
TEST(SplitWalls, OrderThroughHits) {
  const Table table = disc(0.5);
  for (const double omega : {0.0, 1.0}) {
    const double t_end = 6.0;
    const Orbit exact = follow(table, well(0.002, false, "blanes-moan-srkn11b"), omega, circle_start(), t_end);
    EXPECT_GE(exact.hits.size(), 4u);
    const double coarse = mean_error(table, omega, true, 600, exact.end, t_end);
    const double fine = mean_error(table, omega, true, 4800, exact.end, t_end);
    const double order = std::log2(coarse / fine) / 3.0;
    EXPECT_NEAR(order, 1.0, 0.25) << omega << " " << coarse << " " << fine;
    const double reflected = mean_error(table, omega, false, 4800, exact.end, t_end);
    EXPECT_LT(10.0 * reflected, fine) << omega;
    const Orbit split = follow(table, well(0.00125, true), omega, circle_start(), t_end);
    ASSERT_EQ(split.hits.size(), exact.hits.size());
    for (std::size_t i = 0; i < exact.hits.size(); ++i)
      EXPECT_NEAR(split.hits[i].time.value(), exact.hits[i].time.value(), 0.01);
  }
}

// Without a force the drift is all there is: the orbit is the exact one.
TEST(SplitWalls, NoForceIsExact) {
  const Table table = disc(0.5);
  for (const double omega : {0.0, 1.0}) {
    Dynamics d;
    d.everywhere = true;
    d.integrator = {"velocity-verlet", 0.125, 0.0, true};
    const Orbit split = follow(table, d, omega, circle_start(), 20.0);
    const Orbit exact = follow(table, {}, omega, circle_start(), 20.0);
    EXPECT_EQ(split.hits.size(), exact.hits.size());
    EXPECT_LT(distance(split.end, exact.end), 1e-12);
    EXPECT_NEAR(split.energy_change, 0.0, 1e-14);
  }
}

// A state that is read within a step is that of its time but for the square of the step.
TEST(SplitWalls, StatesWithinSteps) {
  const Table table = disc(0.5);
  for (const char* scheme : {"velocity-verlet", "mclachlan-2"})
    for (const double t_end : {0.05, 0.1, 0.15, 0.2, 0.25, 0.3}) {
      const Orbit fine = follow(table, well(0.002, false, "blanes-moan-srkn11b"), 1.0, circle_start(), t_end);
      const Orbit split = follow(table, well(0.0078125, true, scheme), 1.0, circle_start(), t_end);
      EXPECT_TRUE(fine.hits.empty());
      EXPECT_LT(distance(split.end, fine.end), 1e-4) << scheme << " " << t_end;
    }
}

// Each hit changes the energy by some force times velocity times step, of either sign: it spreads without
// bound, far more than where steps are cut.
TEST(SplitWalls, EnergySpreads) {
  const Table table = disc(0.5);
  const auto spread = [&](double step, bool split, double t_end) {
    double squares = 0.0;
    constexpr int orbits = 16;
    for (int k = 0; k < orbits; ++k) {
      const State from = start({0.125 - k / 64.0, 0.0625}, {0.75, 0.5});
      const Orbit o = follow(table, well(step, split), 0.0, from, t_end);
      EXPECT_EQ(o.fate, Fate::survived);
      squares += o.energy_change * o.energy_change;
    }
    return std::sqrt(squares / orbits);
  };
  const double a = spread(0.0625, true, 64.0), b = spread(0.0625, true, 1024.0);
  EXPECT_GT(b, 2.0 * a) << a << " " << b;
  EXPECT_LT(b, 32.0 * a) << a << " " << b;
  EXPECT_GT(a, 10.0 * spread(0.0625, false, 64.0));
  const double finer = spread(0.015625, true, 64.0);
  EXPECT_NEAR(std::log2(a / finer) / 2.0, 1.0, 0.5) << a << " " << finer;
}

}  // namespace
}  // namespace carom::tests
