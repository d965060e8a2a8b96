// What a world sees of the energies of its particles, and what their integration costs.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "carom/events/energy.hpp"
#include "recorder.hpp"

namespace carom::tests {
namespace {

Dynamics dynamics(const char* scheme, double step, bool pairs) {
  ForceSpec spec;
  PotentialSpec v;
  v.kind = PotentialSpec::Kind::harmonic;
  v.omega_x = 1.25;
  v.omega_y = 0.75;
  v.centers = {{0.0, 0.0}};
  spec.potentials = {v};
  if (pairs) {
    InteractionSpec w;
    w.kind = InteractionSpec::Kind::coulomb;
    w.strength = 0.1;
    spec.interaction = w;
  }
  Dynamics d;
  d.forces = ForceField::build(spec, {particle(), particle()}, std::nullopt);
  d.integrator.scheme = scheme;
  d.integrator.step = step;
  return d;
}

/// Largest change of the energy at the samples, of each particle or of all.
class Samples : public Observer {
 public:
  Samples(const Dynamics& d, const Table& table, bool shared)
      : dynamics_(d), table_(table), shared_(shared) {}
  void sample(int, Time, const State& state) override { now_.push_back(state); }
  bool sampled(Time) override {
    for (std::size_t i = 0; i < (shared_ ? 1 : now_.size()); ++i) {
      const std::vector<State> states = shared_ ? now_ : std::vector<State>{now_[i]};
      const std::vector<Particle> particles(states.size(), particle());
      const Energy e = energy_of(particles, states, dynamics_, table_);
      if (first_.size() <= i)
        first_.push_back(e.total()), largest.push_back(0.0), kinetic.push_back(0.0);
      largest[i] = std::max(largest[i], std::fabs(e.total() - first_[i]));
      kinetic[i] = std::max(kinetic[i], e.kinetic);
    }
    now_.clear();
    return true;
  }
  std::vector<double> largest, kinetic;

 private:
  const Dynamics& dynamics_;
  const Table& table_;
  bool shared_;
  std::vector<State> now_;
  std::vector<double> first_;
};

TEST(EnergyBalance, IsThatOfEveryStep) {
  Table plane;
  plane.extent = Extent::open_plane;
  for (const bool pairs : {false, true})
    for (const char* scheme : {"velocity-verlet", "blanes-moan-srkn11b", "forest-ruth-4"}) {
      const double step = 0.03125;  // its multiples are exact
      const Dynamics d = dynamics(scheme, step, pairs);
      World world(plane, d), plain(plane, d);
      Samples samples(d, plane, pairs);
      for (World* w : {&world, &plain}) {
        w->add(particle(), start({0.5, 0.25}, {0.75, -0.5}));
        w->add(particle(), start({-0.5, 0.125}, {-0.25, 1.0}));
      }
      world.watch_energy();
      world.sample_every(step);
      Observer silent;
      world.run_until(20.0, samples);
      plain.run_until(20.0, silent);
      for (int i = 0; i < 2; ++i) {
        const EnergyBalance& seen = world.energy_balance(i);
        const auto k = static_cast<std::size_t>(pairs ? 0 : i);
        EXPECT_NEAR(seen.largest, samples.largest[k], 1e-14) << scheme;
        EXPECT_GT(seen.largest, 0.0) << scheme;
        EXPECT_EQ(plain.fate(i), Fate::survived) << plain.report(i);
        EXPECT_NEAR(seen.kinetic, samples.kinetic[k], 1e-14) << scheme;
        EXPECT_GE(seen.largest, std::fabs(seen.change));
        EXPECT_EQ(seen.kinetic, plain.energy_balance(i).kinetic);
        // Looking changes nothing, and costs no evaluation that is counted.
        EXPECT_EQ(world.state(i).position.x, plain.state(i).position.x);
        EXPECT_EQ(world.state(i).velocity.y, plain.state(i).velocity.y);
      }
      EXPECT_EQ(plain.step_counts().steps, pairs ? 640u : 1280u);
      EXPECT_EQ(world.step_counts().steps, plain.step_counts().steps);
      world.clear();
      EXPECT_EQ(world.step_counts().steps, 0u);
    }
}

// Velocity Verlet asks for one force a step: that at its end is the next one's first.
TEST(StepCounts, AreThoseOfTheScheme) {
  Table plane;
  plane.extent = Extent::open_plane;
  const Dynamics d = dynamics("velocity-verlet", 0.125, false);
  World world(plane, d);
  world.add(particle(), start({0.5, 0.25}, {0.75, -0.5}));
  Observer silent;
  world.run_until(10.0, silent);
  EXPECT_EQ(world.step_counts().steps, 80u);
  EXPECT_EQ(world.step_counts().force_evaluations, 82u)
      << "one at the start, and the step after the last one";
}

TEST(EnergyError, WhatIsNoNumberIsInfinite) {
  EnergyBalance balance;
  balance.kinetic = 2.0;
  const EnergyError good = balance.error_at_end(-0.5, 1.0);
  EXPECT_EQ(good.end, -0.25);
  EXPECT_EQ(good.largest, 0.25);
  EXPECT_TRUE(std::isinf(balance.error_at_end(std::nan(""), 1.0).largest));
  EnergyError sum;
  sum += good;
  EXPECT_EQ(sum.end, 0.25);
  sum += balance.error_at_end(std::nan(""), 1.0);
  EXPECT_TRUE(std::isinf(sum.largest));
  EXPECT_EQ(EnergyBalance().error_at_end(0.0, 0.0).largest, 0.0) << "at rest";
}

}  // namespace
}  // namespace carom::tests
