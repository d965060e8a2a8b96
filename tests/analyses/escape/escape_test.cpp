#include "carom/analyses/escape.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <set>
#include <vector>

#include "analyses/escape/records.hpp"
#include "analyses/systems.hpp"
#include "carom/base/error.hpp"

namespace carom {
namespace {

void expect_equal(const EscapeResult& a, const EscapeResult& b) {
  EXPECT_EQ(a.digest, b.digest);
  EXPECT_EQ(a.counts.gone_in, b.counts.gone_in);
  EXPECT_EQ(a.counts.gone_in_hits, b.counts.gone_in_hits);
  EXPECT_EQ(a.counts.collisions, b.counts.collisions);
  EXPECT_EQ(a.counts.hole_escapes, b.counts.hole_escapes);
}

TEST(Escape, DoesNotDependOnThreadsOrBlocks) {
  const System system = make_system(magnetic_square);
  EscapeOptions options;
  options.threads = 1;
  const EscapeResult one = run_escape(system, options);
  EXPECT_TRUE(one.complete);
  EXPECT_EQ(one.counts.trajectories, 500u);
  EXPECT_EQ(one.counts.lost, 0u);
  EXPECT_GT(one.counts.escaped, 400u);
  for (const int threads : {1, 2, 3, 8}) {
    for (const std::uint64_t block : {1u, 7u, 64u, 100000u}) {
      options.threads = threads;
      options.block = block;
      expect_equal(run_escape(system, options), one);
    }
  }
}

TEST(Escape, DoesNotDependOnTheFilter) {
  System system = make_system(magnetic_square);
  system.run.trajectories = 60;
  EscapeOptions options;
  const EscapeResult plain = run_escape(system, options);
  options.decisions.filter_inflation = 0x1p20;
  const EscapeResult inflated = run_escape(system, options);
  expect_equal(plain, inflated);
  EXPECT_GE(inflated.decisions.exact, plain.decisions.exact);
}

// Ten thousand trajectories of each kind of table, with field and without: larger bounds and the
// other number of threads change no bit, nor do lanes, which have margins of their own. At 2^20 few
// decisions of these leave the filter; at 2^36 some of every table do.
TEST(Escape, TenThousandTrajectoriesWithInflatedBounds) {
  for (const char* name : {"magnetic-square", "mushroom", "stadium", "sinai", "lorentz-triangular",
                           "circle", "three-disc", "ellipse-magnetic"}) {
    SystemOverrides changes;
    changes.trajectories = "1e4";
    changes.t_max = "6";
    changes.times = "6";
    const System system = load_system(name, changes).system;
    EscapeOptions options;
    options.threads = 1;
    const EscapeResult plain = run_escape(system, options);
    EXPECT_EQ(plain.counts.lost, 0u) << name;
    options.threads = 2;
    options.lanes.reset();
    options.decisions.filter_inflation = 0x1p20;
    expect_equal(plain, run_escape(system, options));
    options.decisions.filter_inflation = 0x1p36;
    const EscapeResult inflated = run_escape(system, options);
    expect_equal(plain, inflated);
    EXPECT_GT(inflated.decisions.exact, plain.decisions.exact) << name;
    std::printf(
        "%-20s %8llu hits, %llu decisions beyond the filter, %llu with bounds 2^36 times as "
        "large\n",
        name, static_cast<unsigned long long>(plain.counts.collisions),
        static_cast<unsigned long long>(plain.decisions.exact),
        static_cast<unsigned long long>(inflated.decisions.exact));
  }
}

TEST(Escape, DigestTellsTrajectoriesApart) {
  System system = make_system(magnetic_square);
  system.run.trajectories = 50;
  const std::uint64_t digest = run_escape(system).digest;
  system.run.seed = 2;
  EXPECT_NE(run_escape(system).digest, digest);
  system.run.seed = 1;
  system.run.trajectories = 51;
  EXPECT_NE(run_escape(system).digest, digest);
}

TEST(Escape, RecordsAddUp) {
  const System system = make_system(magnetic_square);
  EscapeOptions options;
  options.threads = 4;
  options.block = 3;
  SurvivalCounts counts(system.run.times, 1);
  std::set<std::uint64_t> seen;
  EscapeRecords journal([&](const std::vector<TrajectoryRecord>& records) {
    for (const TrajectoryRecord& r : records) {
      EXPECT_TRUE(seen.insert(r.index).second);
      EXPECT_LE(records.front().index, r.index) << "in order within a block";
      counts.add(r.fate, r.time, r.hits, r.hole);
      EXPECT_TRUE(0 < r.x && r.x < 1 && 0 < r.y && r.y < 1);
    }
  });
  options.journal = &journal;
  const EscapeResult result = run_escape(system, options);
  EXPECT_EQ(seen.size(), 500u);
  EXPECT_EQ(counts.gone_in, result.counts.gone_in);
  EXPECT_EQ(counts.collisions, result.counts.collisions);
}

TEST(Escape, InterruptedEndsWithWholeBlocks) {
  System system = make_system(magnetic_square);
  system.run.trajectories = 1'000'000'000;
  std::atomic<bool> stop{false};
  EscapeOptions options;
  options.threads = 2;
  options.block = 16;
  options.interrupted = &stop;
  std::uint64_t recorded = 0;
  // Each of 64 lanes of a thread may keep a block from being whole, of which the rest is reported.
  options.progress = [&](std::uint64_t done, std::uint64_t) { stop = stop || done > 5000; };
  EscapeRecords journal(
      [&](const std::vector<TrajectoryRecord>& records) { recorded += records.size(); });
  options.journal = &journal;
  const EscapeResult result = run_escape(system, options);
  EXPECT_FALSE(result.complete);
  EXPECT_GT(result.counts.trajectories, 2500u);
  EXPECT_EQ(result.counts.trajectories % 16, 0u);
  EXPECT_EQ(result.counts.trajectories, recorded);
}

TEST(Escape, OneLongTrajectoryCanBeInterrupted) {
  System system = make_system(magnetic_square);
  system.table = make_system("[table]\nshape = \"circle\"\nradius = 1\n").table;
  system.run.t_max = 1e15;
  system.run.trajectories = 1;
  std::atomic<bool> stop{true};
  EscapeOptions options;
  options.interrupted = &stop;
  EXPECT_FALSE(run_escape(system, options).complete);
}

TEST(Escape, ErrorsLeaveTheThreads) {
  System system = make_system(magnetic_square);
  system.run.trajectories = 200;
  EscapeOptions options;
  for (const int threads : {2, 8})
    for (int k = 0; k < 12; ++k) {
      int calls = 0;
      options.threads = threads;
      EscapeRecords journal([&](const std::vector<TrajectoryRecord>&) {
        if (++calls > k) throw InputError("the disk is full");
      });
      options.journal = &journal;
      EXPECT_THROW(run_escape(system, options), InputError);
      EXPECT_GT(calls, k);
      EXPECT_LE(calls, k + threads) << "each thread ends at the next block";
    }
  options.journal = nullptr;
  system.initial.kind = InitialCondition::Kind::point;
  system.initial.position = {2.0, 2.0};
  system.initial.velocity = {1.0, 0.0};
  EXPECT_THROW(run_escape(system, options), InputError);
}

TEST(Escape, ClosedTablesKeepEverything) {
  System system =
      make_system("[table]\nshape = \"stadium\"\nhalf_length = 1\nradius = 1\n[run]\nt_max = 50\n");
  system.run.trajectories = 100;
  const EscapeResult result = run_escape(system);
  EXPECT_EQ(result.counts.survived, 100u);
  EXPECT_EQ(survival(result.counts).back().p, 1.0);
  system.run.collisions = 10;
  const EscapeResult capped = run_escape(system);
  EXPECT_EQ(capped.counts.capped, 100u);
  EXPECT_EQ(capped.counts.collisions, 1000u);
}

TEST(Escape, PinnedOrbitsSurvive) {
  System system = make_system(
      "[table]\nshape = \"rectangle\"\nwidth = 1\nheight = 1\n[field]\nlarmor_radius = "
      "0.1\n[run]\nt_max = "
      "50\n");
  system.run.trajectories = 2000;
  const EscapeResult result = run_escape(system);
  // Pinned: the guiding centre lies in the inner square of side 1 - 2 rho. For each direction the
  // starts with such a centre are that square, shifted.
  EXPECT_NEAR(static_cast<double>(result.counts.pinned), 2000 * 0.64,
              4 * std::sqrt(2000 * 0.64 * 0.36));
  EXPECT_EQ(result.counts.survived, 2000u);
}

TEST(Escape, EveryParticleIsAnEntry) {
  System system = make_system(magnetic_square);
  system.run.trajectories = 40;
  system.particles.push_back(system.particles.front());
  system.particles.push_back(system.particles.front());
  EscapeOptions options;
  std::vector<TrajectoryRecord> records;
  const EscapeResult result = run_escape(system, options, records);
  ASSERT_EQ(records.size(), 120u);
  for (std::size_t i = 0; i < 120; ++i) EXPECT_EQ(records[i].index, i);
  EXPECT_EQ(result.counts.trajectories, 120u);
}

// Particles are numbered through: beyond 2^62 of them numbers would repeat.
TEST(Escape, RefusesMoreParticlesThanNumbers) {
  System system = make_system(magnetic_square);
  EscapeOptions options;
  options.part = {0, 3};
  system.run.trajectories = std::uint64_t{1} << 62;
  EXPECT_EQ(run_escape(system, options).counts.trajectories, 3u);
  system.particles.push_back(system.particles.front());
  EXPECT_THROW(run_escape(system, options), InputError);
}

}  // namespace
}  // namespace carom
