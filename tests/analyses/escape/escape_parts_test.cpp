// Ensembles in parts: interrupted and continued, in shards, saved while they run. The sum is the
// whole.
#include <gtest/gtest.h>

#include <map>
#include <mutex>
#include <vector>

#include "analyses/systems.hpp"
#include "carom/analyses/escape.hpp"
#include "carom/base/error.hpp"
#include "engines/ensemble_run.hpp"

namespace carom {

using namespace engines;

namespace {

System stadium() {
  return make_system(R"(
[table]
shape = "stadium"
half_length = 1
radius = 1
[[table.hole]]
wall = "bottom"
center = 1
width = 0.2
[initial]
kind = "uniform"
[run]
t_max = 100
trajectories = 3000
)");
}

void expect_equal(const EscapeResult& a, const EscapeResult& b) {
  EXPECT_EQ(a.digest, b.digest);
  EXPECT_EQ(a.done, b.done);
  EXPECT_EQ(a.counts.trajectories, b.counts.trajectories);
  EXPECT_EQ(a.counts.gone_in, b.counts.gone_in);
  EXPECT_EQ(a.counts.gone_in_hits, b.counts.gone_in_hits);
  EXPECT_EQ(a.counts.most_hits, b.counts.most_hits);
  EXPECT_EQ(a.counts.energy_change, b.counts.energy_change);
  EXPECT_EQ(a.counts.collisions, b.counts.collisions);
  EXPECT_EQ(a.counts.hole_escapes, b.counts.hole_escapes);
  ASSERT_EQ(a.counts.parts.size(), b.counts.parts.size());
  if (a.counts.parts.empty()) return;
  Replicate all = a.counts.parts.front();
  for (std::size_t r = 0; r < a.counts.parts.size(); ++r) {
    if (r > 0) {
      all.merge(a.counts.parts[r]);
      all.followed += a.counts.parts[r].followed;
    }
    EXPECT_EQ(a.counts.parts[r].followed, b.counts.parts[r].followed);
    EXPECT_EQ(a.counts.parts[r].gone_in, b.counts.parts[r].gone_in);
    EXPECT_EQ(a.counts.parts[r].gone_in_hits, b.counts.parts[r].gone_in_hits);
    EXPECT_EQ(a.counts.parts[r].hole_escapes, b.counts.parts[r].hole_escapes);
  }
  EXPECT_EQ(all.followed, a.counts.followed());
  EXPECT_EQ(all.gone_in, a.counts.gone_in);
  EXPECT_EQ(all.hole_escapes, a.counts.hole_escapes);
}

System quasi_random_stadium() {
  System system = stadium();
  system.initial.kind = InitialCondition::Kind::sobol;
  return system;
}

/// Remembers every state that it was asked to keep, and the records that belong to it.
class Memory : public EscapeJournal {
 public:
  bool wants_records() const override { return true; }
  void block(TrajectoryRange block, std::vector<TrajectoryRecord>&& records) override {
    EXPECT_EQ(records.size(), block.last - block.first);
    for (const TrajectoryRecord& r : records) EXPECT_TRUE(coming_.emplace(r.index, r.hits).second);
  }
  void mark() override {
    const std::lock_guard lock(mutex_);
    marked_ = coming_;
  }
  void save(const EscapeResult& so_far) override {
    const std::lock_guard lock(mutex_);
    states.push_back(so_far);
    std::uint64_t hits = 0;
    for (const auto& [index, n] : marked_) hits += n;
    EXPECT_EQ(marked_.size(), so_far.done.size());
    EXPECT_EQ(hits, so_far.counts.collisions);
    for (const TrajectoryRange& range : so_far.done.ranges())
      for (std::uint64_t i = range.first; i < range.last; ++i) EXPECT_TRUE(marked_.count(i));
  }
  std::vector<EscapeResult> states;

 private:
  std::mutex mutex_;
  std::map<std::uint64_t, std::uint64_t> coming_, marked_;
};

TEST(EscapeInParts, GoesOnFromEverySavedState) {
  for (System system : {make_system(magnetic_square), stadium(), quasi_random_stadium()}) {
    const EscapeResult whole = run_escape(system);
    ASSERT_EQ(whole.done.ranges(), (std::vector<TrajectoryRange>{{0, system.run.trajectories}}));
    Memory memory;
    EscapeOptions options;
    options.threads = 3;
    options.block = 7;
    options.journal = &memory;
    options.save_every_blocks = 20;
    expect_equal(run_escape(system, options), whole);
    ASSERT_FALSE(memory.states.empty());
    EXPECT_EQ(memory.states.front().done.size(), 0u)
        << "the first state is kept before the first block";
    const std::size_t step = 1 + memory.states.size() / 4;
    for (std::size_t i = 0; i < memory.states.size(); i += step) {
      EscapeOptions rest;
      rest.threads = 2;
      rest.block = 11;
      rest.before = &memory.states[i];
      const EscapeResult both = run_escape(system, rest);
      EXPECT_TRUE(both.complete);
      expect_equal(both, whole);
    }
  }
}

TEST(EscapeInParts, SavesAfterSoManyBlocks) {
  const System system = stadium();
  for (const int threads : {1, 3}) {
    Memory memory;
    EscapeOptions options;
    options.threads = threads;
    options.block = 10;
    options.journal = &memory;
    options.save_every = 1e-6;  // does not count
    options.save_every_blocks = 50;
    const EscapeResult result = run_escape(system, options);
    ASSERT_GE(memory.states.size(), 2u);
    for (std::size_t i = 0; i < memory.states.size(); ++i) {
      const std::uint64_t done = memory.states[i].done.size();
      EXPECT_GE(done, 500 * i);
      EXPECT_TRUE(threads > 1 || done == 500 * i) << done;
    }
    EXPECT_EQ(result.done.size(), 3000u);
    EXPECT_TRUE(threads > 1 || memory.states.size() == 7) << memory.states.size();
  }
}

// For rates: the hits of earlier parts took no time of this one.
TEST(EscapeInParts, TellsItsOwnHits) {
  const System system = stadium();
  EscapeOptions half;
  half.part = shard(1, 2, system.run.trajectories);
  const EscapeResult before = run_escape(system, half);
  std::uint64_t done = 0, hits = 0;
  EscapeOptions rest;
  rest.threads = 1;
  rest.before = &before;
  rest.progress = [&](std::uint64_t trajectories, std::uint64_t so_far) {
    done = trajectories, hits = so_far;
  };
  const EscapeResult whole = run_escape(system, rest);
  EXPECT_EQ(done, system.run.trajectories);
  EXPECT_EQ(hits, whole.counts.collisions - before.counts.collisions);
}

TEST(EscapeInParts, ShardsMakeTheWhole) {
  for (const System& system : {stadium(), quasi_random_stadium()}) {
    const EscapeResult whole = run_escape(system);
    std::vector<EscapeResult> shards;
    for (std::uint64_t k = 1; k <= 3; ++k) {
      EscapeOptions options;
      options.part = shard(k, 3, system.run.trajectories);
      shards.push_back(run_escape(system, options));
      EXPECT_TRUE(shards.back().complete);
      EXPECT_EQ(shards.back().done.size(), 1000u);
    }
    for (const auto& order : {std::vector{0, 1, 2}, {2, 1, 0}, {1, 0, 2}}) {
      EscapeResult sum = shards[static_cast<std::size_t>(order[0])];
      ASSERT_TRUE(sum.add(shards[static_cast<std::size_t>(order[1])]));
      ASSERT_TRUE(sum.add(shards[static_cast<std::size_t>(order[2])]));
      expect_equal(sum, whole);
      EXPECT_FALSE(sum.add(shards[1])) << "twice the same shard";
      expect_equal(sum, whole);
    }
  }
}

TEST(EscapeInParts, AnErrorOfTheJournalEndsTheRun) {
  struct Full : EscapeJournal {
    explicit Full(int good) : left(good) {}
    void save(const EscapeResult&) override {
      if (left-- == 0) throw InputError("the disk is full");
    }
    int left;
  };
  System system = stadium();
  system.run.trajectories = 1'000'000'000;
  for (const int good : {0, 3}) {
    Full full(good);
    EscapeOptions options;
    options.journal = &full;
    options.save_every = 0.01;
    EXPECT_THROW(run_escape(system, options), InputError);
  }
}

TEST(BlockList, CoversItsRangesInOrder) {
  const BlockList blocks({{3, 10}, {12, 13}, {20, 26}}, 3);
  const std::vector<TrajectoryRange> expected{{3, 6},   {6, 9},   {9, 10},
                                              {12, 13}, {20, 23}, {23, 26}};
  ASSERT_EQ(blocks.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(blocks[i], expected[i]) << i;
  EXPECT_EQ(BlockList({}, 3).size(), 0u);
}

}  // namespace
}  // namespace carom
