// Diffusion ensembles in parts: interrupted and continued, in shards. The sum is the whole, bit for
// bit, although it is one of doubles.
#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <stdexcept>
#include <string>
#include <vector>

#include "analyses/systems.hpp"
#include "carom/analyses/diffusion.hpp"
#include "carom/base/error.hpp"
#include "carom/files/system_file.hpp"

namespace carom {
namespace {

System lorentz() {
  return make_system(R"(
[table]
shape = "lorentz"
lattice = "triangular"
spacing = 2.2
radius = 1
[run]
t_max = 30
trajectories = 600
)");
}

// Forces everywhere: these go in lanes.
System soft() {
  for (const BuiltinSystem& b : builtin_systems()) {
    if (b.name != "soft-lorentz") continue;
    System system = read_system(b.toml, "soft-lorentz").system;
    system.run.trajectories = 300;
    system.run.times = {1, 2, 5};
    return system;
  }
  throw std::runtime_error("no such system");
}

void expect_equal(const DiffusionResult& a, const DiffusionResult& b) {
  EXPECT_EQ(a.digest, b.digest);
  EXPECT_EQ(a.done, b.done);
  EXPECT_EQ(a.trajectories, b.trajectories);
  EXPECT_EQ(a.survived, b.survived);
  EXPECT_EQ(a.collisions, b.collisions);
  EXPECT_EQ(a.energy_change, b.energy_change);
  ASSERT_EQ(a.sums.times(), b.sums.times());
  for (std::size_t group = 0; group < DisplacementSums::groups; ++group)
    for (std::size_t k = 0; k < a.sums.times().size(); ++k) {
      const auto &x = a.sums.of(group, k), &y = b.sums.of(group, k);
      ASSERT_EQ(x.count, y.count);
      ASSERT_EQ(x.square.state(), y.square.state());
      ASSERT_EQ(x.fourth.state(), y.fourth.state());
    }
}

class Memory : public DiffusionJournal {
 public:
  void save(const DiffusionResult& so_far) override { states.push_back(so_far); }
  std::vector<DiffusionResult> states;
};

TEST(DiffusionInParts, GoesOnFromEverySavedState) {
  for (const System& system : {lorentz(), soft()}) {
    const DiffusionResult whole = run_diffusion(system);
    EXPECT_EQ(whole.done.ranges(), (std::vector<TrajectoryRange>{{0, system.run.trajectories}}));
    Memory memory;
    DiffusionOptions options;
    options.threads = 3;
    options.block = 7;
    options.journal = &memory;
    options.save_every_blocks = 3;
    expect_equal(run_diffusion(system, options), whole);
    ASSERT_GT(memory.states.size(), 1u);
    EXPECT_EQ(memory.states.front().done.size(), 0u);
    const std::size_t step = 1 + memory.states.size() / 4;
    for (std::size_t i = 0; i < memory.states.size(); i += step) {
      const DiffusionResult& state = memory.states[i];
      EXPECT_EQ(state.done.size(), state.trajectories) << "what is counted is what is done";
      DiffusionOptions rest;
      rest.threads = 2;
      rest.before = &state;
      expect_equal(run_diffusion(system, rest), whole);
    }
  }
}

TEST(DiffusionInParts, ShardsMakeTheWholeInAnyOrder) {
  const System system = lorentz();
  const DiffusionResult whole = run_diffusion(system);
  std::vector<DiffusionResult> shards;
  for (std::uint64_t k = 1; k <= 3; ++k) {
    DiffusionOptions options;
    options.part = shard(k, 3, system.run.trajectories);
    shards.push_back(run_diffusion(system, options));
  }
  for (const auto& order : {std::vector<std::size_t>{0, 1, 2}, {2, 1, 0}, {1, 0, 2}}) {
    DiffusionResult sum = shards[order[0]];
    ASSERT_TRUE(sum.add(shards[order[1]]));
    ASSERT_TRUE(sum.add(shards[order[2]]));
    expect_equal(sum, whole);
    EXPECT_FALSE(sum.add(shards[1])) << "twice the same shard";
    expect_equal(sum, whole);
  }
}

// As several processes do that go on with what is there: each flies a share of what is missing, and
// counts that alone.
TEST(DiffusionInParts, SharesOfWhatIsMissingMakeTheWhole) {
  const System system = lorentz();
  const DiffusionResult whole = run_diffusion(system);
  DiffusionResult sum;
  sum.sums = DisplacementSums(system.run.times);
  for (const TrajectoryRange part : {TrajectoryRange{20, 130}, TrajectoryRange{300, 301}}) {
    DiffusionOptions options;
    options.part = part;
    ASSERT_TRUE(sum.add(run_diffusion(system, options)));
  }
  const TrajectoryRanges there = sum.done;
  for (const std::uint64_t k : {3u, 1u, 4u, 2u}) {
    DiffusionOptions options;
    options.elsewhere = there;
    options.part = shard(k, 4, there.missing_from({0, system.run.trajectories}));
    const DiffusionResult share = run_diffusion(system, options);
    EXPECT_TRUE(share.complete);
    EXPECT_LE(share.done.size(), (system.run.trajectories - there.size()) / 4 + 1);
    ASSERT_TRUE(sum.add(share));
  }
  expect_equal(sum, whole);
}

}  // namespace
}  // namespace carom
