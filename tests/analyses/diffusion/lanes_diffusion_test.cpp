// Diffusion ensembles in lanes: the sums and the digest of the scalar engine.
#include <gtest/gtest.h>

#include <atomic>
#include <optional>
#include <string>

#include "carom/analyses/diffusion.hpp"
#include "carom/files/system_file.hpp"

namespace carom {
namespace {

DiffusionResult run(const System& system, std::optional<InstructionSet> lanes, int threads,
                    std::uint64_t block) {
  DiffusionOptions how;
  how.lanes = lanes;
  how.threads = threads;
  how.block = block;
  return run_diffusion(system, how);
}

void expect_same(const DiffusionResult& a, const DiffusionResult& b) {
  EXPECT_TRUE(a.complete && b.complete);
  EXPECT_EQ(a.digest, b.digest);
  EXPECT_EQ(a.done, b.done);
  EXPECT_EQ(a.trajectories, b.trajectories);
  EXPECT_EQ(a.survived, b.survived);
  EXPECT_EQ(a.pinned, b.pinned);
  EXPECT_EQ(a.escaped, b.escaped);
  EXPECT_EQ(a.unbounded, b.unbounded);
  EXPECT_EQ(a.capped, b.capped);
  EXPECT_EQ(a.collisions, b.collisions);
  EXPECT_EQ(a.lost + b.lost, 0u);
  for (std::size_t group = 0; group < DisplacementSums::groups; ++group)
    for (std::size_t k = 0; k < a.sums.times().size(); ++k) {
      const auto &one = a.sums.of(group, k), &other = b.sums.of(group, k);
      ASSERT_EQ(one.count, other.count) << group << " " << k;
      ASSERT_EQ(one.square.value(), other.square.value()) << group << " " << k;
      ASSERT_EQ(one.fourth.value(), other.fourth.value()) << group << " " << k;
    }
}

/// On each instruction set, one and several threads.
void expect_same_in_lanes(const System& system) {
  const DiffusionResult scalar = run(system, std::nullopt, 1, 512);
  EXPECT_FALSE(scalar.lanes);
  EXPECT_GT(scalar.collisions, 0u);
  for (const InstructionSet set : available_instruction_sets())
    for (const int threads : {1, 3}) {
      const DiffusionResult lanes = run(system, set, threads, threads == 1 ? 7 : 300);
      ASSERT_EQ(lanes.lanes, set);
      expect_same(lanes, scalar);
    }
}

class DiffusionInLanes : public testing::TestWithParam<const char*> {};

TEST_P(DiffusionInLanes, HasTheSumsOfTheScalarEngine) {
  System system = load_system(GetParam()).system;
  system.run.trajectories = 500;
  system.run.t_max = 60.0;
  system.run.times = {0.0, 0.25, 1.0, 2.5, 7.0, 20.0, 20.5, 21.0, 60.0};
  expect_same_in_lanes(system);
  system.run.collisions = 12;
  expect_same_in_lanes(system);
}

INSTANTIATE_TEST_SUITE_P(BuiltIn, DiffusionInLanes,
                         testing::Values("lorentz-triangular", "lorentz-square", "sinai", "stadium",
                                         "mushroom", "circle", "three-disc", "magnetic-square",
                                         "ellipse-magnetic"));

// Of particles that meet no wall, and of several in each trajectory, some of them born on walls.
TEST(LaneDiffusion, SeveralParticlesAndPinnedOnesAgreeWithTheWorld) {
  const System several = read_system(R"(
[table]
shape = "rectangle"
width = 2
height = 1
[field]
larmor_radius = 0.3
[particles]
count = 3
[initial]
kind = "boundary"
[run]
t_max = 30
trajectories = 300
times = [0, 1, 2.5, 17, 30]
)",
                                     "several")
                             .system;
  ASSERT_EQ(several.particles.size(), 3u);
  expect_same_in_lanes(several);
  System pinned = load_system("magnetic-square").system;
  for (Particle& p : pinned.particles) p.omega *= 20.0;
  pinned.run.trajectories = 500;
  pinned.run.times = {0.0, 3.0, 40.0};
  EXPECT_GT(run(pinned, std::nullopt, 1, 100).pinned, 50u);
  expect_same_in_lanes(pinned);
}

// What is stopped holds whole trajectories, and goes on to the same sums.
TEST(LaneDiffusion, GoesOnWhereItWasStopped) {
  System system = load_system("lorentz-triangular").system;
  system.run.trajectories = 3000;
  const DiffusionResult whole = run(system, std::nullopt, 1, 512);
  std::atomic<bool> stop{false};
  DiffusionOptions how;
  how.lanes = widest_instruction_set();
  how.threads = 1;
  how.interrupted = &stop;
  how.progress = [&](std::uint64_t trajectories, std::uint64_t) { stop = trajectories > 700; };
  const DiffusionResult part = run_diffusion(system, how);
  EXPECT_FALSE(part.complete);
  EXPECT_GT(part.trajectories, 0u);
  EXPECT_LT(part.trajectories, 3000u);
  EXPECT_EQ(part.trajectories, part.done.size());
  stop = false;
  how.progress = {};
  how.before = &part;
  expect_same(run_diffusion(system, how), whole);
}

}  // namespace
}  // namespace carom
