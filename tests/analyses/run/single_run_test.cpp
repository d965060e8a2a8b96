#include "carom/analyses/run.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "analyses/systems.hpp"
#include "carom/files/system_file.hpp"

namespace carom {
namespace {

struct Trace : Observer {
  void hit(const HitEvent& event) override { hits.push_back(event); }
  void sample(int, Time time, const State&) override { samples.push_back(time.value()); }
  std::vector<HitEvent> hits;
  std::vector<double> samples;
};

const char* tables[] = {
    magnetic_square,
    "[table]\nshape = \"lorentz\"\nlattice = \"triangular\"\nspacing = 2.2\nradius = 1\n",
    "[table]\nshape = \"mushroom\"\ncap_radius = 1\nstem_width = 1\nstem_height = 1\n[field]\nB = "
    "0.3\n",
    "[table]\nshape = \"ellipse\"\na = 2\nb = 1\n[field]\nB = -0.2\n",
};

void expect_same_hits(const std::vector<HitEvent>& a, const std::vector<HitEvent>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].wall, b[i].wall);
    EXPECT_EQ(a[i].u, b[i].u);
    EXPECT_EQ(a[i].time, b[i].time);
    EXPECT_EQ(a[i].after, b[i].after);
    EXPECT_EQ(a[i].cell, b[i].cell);
  }
}

class SingleRun : public testing::TestWithParam<const char*> {};

TEST_P(SingleRun, GoesOnBitForBit) {
  System system = make_system(GetParam());
  system.run.t_max = 60.0;
  Trace whole, parts;
  SingleRunOptions options;
  options.trajectory = 3;
  const SingleRunResult at_once = run_single(system, whole, options);
  ASSERT_GT(whole.hits.size(), 3u);
  for (const double stop : {0.01, 7.0, 23.5, 59.0, 60.0}) {
    system.run.t_max = stop;
    const SingleRunResult part = run_single(system, parts, options);
    options.resume.clear();
    for (const RunEnd& p : part.particles) options.resume.push_back(p.progress);
    if (stop < 60.0) continue;
    EXPECT_EQ(part.particles[0].x, at_once.particles[0].x);
    EXPECT_EQ(part.particles[0].vy, at_once.particles[0].vy);
    EXPECT_EQ(part.particles[0].progress.hits, at_once.particles[0].progress.hits);
    EXPECT_EQ(part.particles[0].progress.fate, at_once.particles[0].progress.fate);
  }
  expect_same_hits(whole.hits, parts.hits);
}

TEST_P(SingleRun, SamplesChangeNothing) {
  System system = make_system(GetParam());
  system.run.t_max = 40.0;
  Trace without, with;
  run_single(system, without);
  system.run.sample = 0.11;
  run_single(system, with);
  EXPECT_TRUE(without.samples.empty());
  EXPECT_FALSE(with.samples.empty());
  expect_same_hits(without.hits, with.hits);
}

INSTANTIATE_TEST_SUITE_P(Tables, SingleRun, testing::ValuesIn(tables));

// Several hits a step: the stored state may be that after a hit within one.
TEST(SingleRunEnd, ChargesGoOnBitForBit) {
  SystemOverrides set;
  set.set = {{"particles.count", "6"},
             {"integrator.step", "0.008"},
             {"integrator.unresolved", "\"count\""},
             {"run.t_max", "1.5"}};
  System system = load_system("coulomb-circle", set).system;
  Trace whole, parts;
  run_single(system, whole, {});
  ASSERT_GT(whole.hits.size(), 15u);
  SingleRunOptions options;
  for (const double stop : {0.01, 0.3333, 0.4, 0.77, 1.2222, 1.5}) {
    system.run.t_max = stop;
    const SingleRunResult part = run_single(system, parts, options);
    options.resume.clear();
    for (const RunEnd& p : part.particles) options.resume.push_back(p.progress);
  }
  expect_same_hits(whole.hits, parts.hits);
}

TEST(SingleRunEnd, EndsAfterSoManyHitsAndGoesOn) {
  System system = make_system(tables[2]);
  system.run.t_max = no_last_time;
  system.run.collisions = 300;
  Trace whole, parts;
  run_single(system, whole);
  EXPECT_EQ(whole.hits.size(), 300u);
  SingleRunOptions options;
  for (const std::uint64_t cap : {1u, 120u, 300u}) {
    system.run.collisions = cap;
    const SingleRunResult part = run_single(system, parts, options);
    EXPECT_EQ(part.particles[0].progress.hits, cap);
    options.resume = {part.particles[0].progress};
  }
  expect_same_hits(whole.hits, parts.hits);
}

TEST(SingleRunEnd, PinnedOrbitsEndARunWithoutLastTime) {
  System system = make_system(
      "[table]\nshape = \"rectangle\"\nwidth = 1\nheight = 1\n[field]\nlarmor_radius = "
      "0.1\n[initial]\nkind "
      "= "
      "\"point\"\nposition = [0.5, 0.5]\nvelocity = [1, 0]\n[run]\nsample = 1\ncollisions = "
      "5\nt_max = "
      "1e300\n");
  Trace trace;
  const SingleRunResult result = run_single(system, trace);
  EXPECT_EQ(result.particles[0].progress.fate, Fate::pinned);
}

TEST(SingleRunEnd, InterruptedStateIsExact) {
  System system = make_system(tables[1]);
  system.run.t_max = 3000.0;
  Trace whole, parts;
  run_single(system, whole);
  SingleRunOptions options;
  int asked = 0;
  options.interrupted = [&] { return ++asked > 3; };
  const SingleRunResult first = run_single(system, parts, options);
  EXPECT_TRUE(first.interrupted);
  EXPECT_LT(parts.hits.size(), whole.hits.size());
  options.interrupted = nullptr;
  options.resume = {first.particles[0].progress};
  run_single(system, parts, options);
  expect_same_hits(whole.hits, parts.hits);
}

TEST(SingleRunEnd, FollowsSeveralParticles) {
  System system = make_system(tables[0]);
  system.particles.push_back(system.particles.front());
  system.run.t_max = 300.0;
  Trace whole, parts;
  const SingleRunResult at_once = run_single(system, whole);
  ASSERT_EQ(at_once.particles.size(), 2u);
  EXPECT_EQ(at_once.collisions,
            at_once.particles[0].progress.hits + at_once.particles[1].progress.hits);
  SingleRunOptions options;
  for (const double stop : {2.0, 9.0, 300.0}) {
    system.run.t_max = stop;
    const SingleRunResult part = run_single(system, parts, options);
    options.resume = {part.particles[0].progress, part.particles[1].progress};
  }
  expect_same_hits(whole.hits, parts.hits);
}

// One of two that repel each other leaves: what is left of their common energy is not said.
TEST(SingleRun, HasNoEnergyErrorOnceAnInteractingParticleIsGone) {
  const std::string pair = R"(
[table]
shape = "rectangle"
width = 2
height = 1
[[table.hole]]
wall = "right"
center = 0.5
width = 0.5
[particles]
count = 2
speed = 1
[interaction]
kind = "coulomb"
strength = 0.01
[integrator]
step = 0.001
[initial]
kind = "list"
starts = [[0.5, 0.5, -1, 0], [1.5, 0.5, 1, 0]]
[run]
t_max = )";
  Trace trace;
  const SingleRunResult early = run_single(make_system(pair + "0.25"), trace);
  EXPECT_LT(early.particles[0].energy_error.largest, 1e-9);
  const SingleRunResult late = run_single(make_system(pair + "2"), trace);
  ASSERT_EQ(late.particles[1].progress.fate, Fate::escaped);
  // What one has taken along is no error of the other.
  EXPECT_LT(late.particles[0].energy_error.largest, 1e-9);
  EXPECT_EQ(late.particles[0].energy_error.largest, late.particles[1].energy_error.largest);
}

// The built-in step is the one that docs/physics/integrators.md advises, a quarter of softness over
// speed: an orbit is what it is with half the step. Four times as long it is off by up to 0.05.
TEST(BuiltInSystems, TheSoftLorentzGasIsResolved) {
  for (const char* seed : {"1", "2", "3", "4"}) {
    SystemOverrides usual, half;
    usual.set = {{"run.seed", seed}, {"run.t_max", "20"}};
    half.set = usual.set;
    half.set.emplace_back("integrator.step", "0.0125");
    Observer nothing;
    const RunEnd a =
        run_single(load_system("soft-lorentz", usual).system, nothing).particles.front();
    const RunEnd b =
        run_single(load_system("soft-lorentz", half).system, nothing).particles.front();
    EXPECT_NEAR(a.x, b.x, 1e-4) << "seed " << seed;
    EXPECT_NEAR(a.y, b.y, 1e-4) << "seed " << seed;
  }
}

}  // namespace
}  // namespace carom
