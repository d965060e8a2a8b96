// Groups of charges among hard walls: what a hit costs, that it is the scheme's own step to it,
// that it can be undone, and that what is remembered of earlier steps changes no bit.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "carom/events/world.hpp"
#include "carom/files/system_file.hpp"
#include "carom/integrators/scheme.hpp"
#include "carom/starts/sampler.hpp"
#include "events/step/step_path.hpp"
#include "integrators/splitting.hpp"

namespace carom {
namespace {

using geometry::Vector;

System charges(int count, const std::string& step) {
  SystemOverrides set;
  set.set = {{"particles.count", std::to_string(count)},
             {"particles.energy", std::to_string(0.8 * count)},
             {"integrator.step", step},
             {"integrator.unresolved", "\"count\""}};
  return load_system("coulomb-circle", set).system;
}

struct Hits final : Observer {
  std::vector<HitEvent> all;
  void hit(const HitEvent& event) override { all.push_back(event); }
};

TEST(GroupsAtWalls, AreTakenToAHitOnce) {
  const System system = charges(20, "0.001");
  World world(*system.table, system.dynamics);
  add_starts(world, Sampler(system), 0);
  Hits hits;
  world.run_until(0.3, hits);
  ASSERT_GT(hits.all.size(), 20u);
  for (std::size_t i = 1; i < hits.all.size(); ++i)
    EXPECT_FALSE(hits.all[i].time < hits.all[i - 1].time);
  constexpr double steps = 300, stages = 11, first = 1;
  const double more =
      static_cast<double>(world.step_counts().force_evaluations) - (steps * stages + first);
  EXPECT_LT(more / static_cast<double>(hits.all.size()), stages + 4.0);
}

/// Three charges that repel each other, in a magnetic field.
struct Charges final : ForceLaw<double> {
  mutable int evaluations = 0;
  void accelerations(std::span<const Vector> x, std::span<Vector> a) const override {
    ++evaluations;
    for (std::size_t i = 0; i < x.size(); ++i) {
      a[i] = {};
      for (std::size_t j = 0; j < x.size(); ++j) {
        const Vector d = x[i] - x[j];
        const double square = dot(d, d);
        if (i != j) a[i] = a[i] + (1.0 / (square * std::sqrt(square))) * d;
      }
    }
  }
};

TEST(GroupsAtWalls, AKnotNearAnotherIsTheSchemesOwn) {
  const Charges law;
  const std::vector<double> omega = {0.5, -0.25, 0.0};
  integrators::SplittingStepper<double> stepper(find_scheme("blanes-moan-srkn11b"), law, omega);
  events::StepPath<double> path(stepper, law, omega);
  const Phase<double> from{{{0.3, 0.1}, {-0.2, 0.4}, {0.1, -0.5}},
                           {{1.5, 0.5}, {0.25, -2.0}, {-1.0, 0.75}}};
  constexpr double step = 0.01, eps = 0x1p-52;
  for (const double part : {0x1p-40, 0x1p-30, 0x1p-20, 0x1p-17, 0x1p-12, 0x1p-3}) {
    path.forget();
    path.begin(from, step);
    const double time = step * (1.0 - part);
    law.evaluations = 0;
    const Phase<double> found = path.at(time).phase;
    if (part < 0x1p-16) {
      EXPECT_LE(law.evaluations, 1) << part;
    } else {
      EXPECT_GE(law.evaluations, 10) << part;
    }
    Phase<double> own;
    stepper.step(from, time, own);
    for (std::size_t i = 0; i < 3; ++i) {
      // A dozen roundings of each are in the scheme's own.
      EXPECT_LT(length(found.position[i] - own.position[i]), 12 * eps) << part;
      EXPECT_LT(length(found.velocity[i] - own.velocity[i]), 12 * 2.0 * eps) << part;
    }
  }
}

TEST(GroupsAtWalls, FlyBackTheWayTheyCame) {
  const System system = charges(4, "0.002");
  World world(*system.table, system.dynamics);
  const std::vector<State> starts = Sampler(system).draw_all(world, 3);
  const auto fly = [&](std::vector<State> from) {
    Hits hits;
    world.clear();
    for (std::size_t i = 0; i < from.size(); ++i) world.add(system.particles[i], from[i]);
    world.run_until(1.0, hits);
    EXPECT_GT(hits.all.size(), 6u);
    for (std::size_t i = 0; i < from.size(); ++i) {
      from[i] = world.state_at(static_cast<int>(i), Time(1.0));
      from[i].time = Time(0.0);
      from[i].velocity = -1.0 * from[i].velocity;
    }
    return from;
  };
  const std::vector<State> back = fly(fly(starts));
  for (std::size_t i = 0; i < starts.size(); ++i) {
    EXPECT_LT(length(back[i].position - starts[i].position), 1e-13);
    EXPECT_LT(length(back[i].velocity + (-1.0) * starts[i].velocity), 1e-12);
  }
}

// A group that begins anew at each end of a step knows nothing of earlier ones: neither which pairs
// are far from each other, nor forces.
TEST(GroupsAtWalls, WhatTheyRememberChangesNothing) {
  const System system = charges(30, "0.006");
  World whole(*system.table, system.dynamics), part(*system.table, system.dynamics);
  add_starts(whole, Sampler(system), 1);
  std::uint64_t unresolved = 0, hits = 0;
  Observer silent;
  for (int k = 1; k <= 60; ++k) {
    part.clear();
    for (int i = 0; i < whole.size(); ++i) part.add(whole.particle(i), whole.state(i));
    const double end = 0.006 * k;
    const std::uint64_t before = whole.step_counts().unresolved;
    whole.run_until(end, silent);
    part.run_until(end, silent);
    unresolved += part.step_counts().unresolved;
    EXPECT_EQ(whole.step_counts().unresolved - before, part.step_counts().unresolved) << k;
    for (int i = 0; i < whole.size(); ++i) {
      EXPECT_EQ(whole.state(i).position, part.state(i).position) << k;
      EXPECT_EQ(whole.state(i).velocity, part.state(i).velocity) << k;
      hits += part.hits(i);
    }
  }
  EXPECT_GT(hits, 20u);
  EXPECT_GT(unresolved, 2u);
  EXPECT_LT(unresolved, 100u);
}

}  // namespace
}  // namespace carom
