// Several processes, here threads, share an ensemble: the result of one.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <exception>
#include <functional>
#include <map>
#include <thread>
#include <vector>

#include "carom/base/error.hpp"
#include "carom/ensemble/escape.hpp"
#include "carom/ensemble/ranks.hpp"
#include "ensemble/bytes.hpp"
#include "systems.hpp"
#include "thread_ranks.hpp"

namespace carom {
namespace {

class Records : public EscapeJournal {
 public:
  bool wants_records() const override { return true; }
  void block(TrajectoryRange, std::vector<TrajectoryRecord>&& records) override {
    for (const TrajectoryRecord& r : records) EXPECT_TRUE(all.emplace(r.index, r).second);
  }
  void save(const EscapeResult&) override { ++saves; }
  std::map<std::uint64_t, TrajectoryRecord> all;
  int saves = 0;
};

/// What the ranks but the first do before they begin.
using Before = std::function<void(int rank)>;
Before late(int slow) {
  return [slow](int rank) {
    if (rank == slow) std::this_thread::sleep_for(std::chrono::milliseconds(300));
  };
}

/// Each rank has a system of its own, as processes have. Where one fails, none of the others ends as if nothing had
/// happened.
EscapeResult run_crew(const std::vector<System>& systems, EscapeOptions options, const Before& before = late(-1)) {
  const int size = static_cast<int>(systems.size());
  ThreadCrew crew(size);
  crew.start_hands([&systems, &before, threads = options.threads](Ranks& ranks) {
    before(ranks.rank());
    EscapeOptions mine;
    mine.threads = threads;
    mine.ranks = &ranks;
    const System system = systems[static_cast<std::size_t>(ranks.rank())];
    EXPECT_EQ(run_escape(system, mine).counts.trajectories, 0u);
  });
  options.ranks = &crew.first();
  EscapeResult result;
  std::exception_ptr error;
  try {
    result = run_escape(systems[0], options);
  } catch (...) {
    error = std::current_exception();
  }
  crew.join();
  EXPECT_EQ(crew.messages_left(), 0u);
  EXPECT_EQ(crew.failed(), error ? size - 1 : 0);
  if (error) std::rethrow_exception(error);
  return result;
}
EscapeResult run_crew(int size, const EscapeOptions& options, const Before& before = late(-1), const System& system = make_system(magnetic_square)) {
  return run_crew(std::vector<System>(static_cast<std::size_t>(size), system), options, before);
}

void expect_equal(const EscapeResult& a, const EscapeResult& b) {
  EXPECT_TRUE(a.complete);
  EXPECT_EQ(a.digest, b.digest);
  EXPECT_EQ(a.done, b.done);
  EXPECT_EQ(a.counts.gone_in, b.counts.gone_in);
  EXPECT_EQ(a.counts.gone_in_hits, b.counts.gone_in_hits);
  EXPECT_EQ(a.counts.collisions, b.counts.collisions);
  EXPECT_EQ(a.counts.most_hits, b.counts.most_hits);
  EXPECT_EQ(a.counts.energy_change, b.counts.energy_change);
}

TEST(Crew, OfAnySizeHasTheSameResult) {
  const EscapeResult alone = run_escape(make_system(magnetic_square));
  for (const int size : {1, 2, 4})
    for (const int threads : {1, 2})
      for (const std::uint64_t block : {3u, 64u}) {
        EscapeOptions options;
        options.threads = threads;
        options.block = block;
        const EscapeResult result = run_crew(size, options);
        expect_equal(result, alone);
        EXPECT_EQ(result.ranks, size);
      }
}

TEST(Crew, DoesNotWaitForASlowRank) {
  EscapeOptions options;
  options.threads = 1;
  expect_equal(run_crew(3, options, late(2)), run_escape(make_system(magnetic_square)));
}

TEST(Crew, HandsOverEveryRecordAndSavesOnTheWay) {
  Records alone, shared;
  EscapeOptions options;
  options.journal = &alone;
  run_escape(make_system(magnetic_square), options);
  options.journal = &shared;
  options.save_every_blocks = 20;
  options.threads = 1;
  options.block = 5;
  run_crew(3, options, late(2));
  ASSERT_EQ(shared.all.size(), alone.all.size());
  for (const auto& [index, r] : alone.all) {
    const TrajectoryRecord& s = shared.all.at(index);
    EXPECT_TRUE(s.x == r.x && s.vy == r.vy && s.time == r.time && s.hits == r.hits && s.fate == r.fate);
  }
  EXPECT_GT(shared.saves, 1);
}

TEST(Crew, GoesOnAfterAnInterruption) {
  const EscapeResult alone = run_escape(make_system(magnetic_square));
  std::atomic<bool> stop{false};
  EscapeOptions options;
  options.block = 2;
  options.threads = 1;
  options.interrupted = &stop;
  options.progress = [&](std::uint64_t done, std::uint64_t) { stop = stop || done > 100; };
  // Two that are fast might do all of it while the first begins.
  const EscapeResult part = run_crew(3, options, [&](int) {
    while (!stop) std::this_thread::yield();
  });
  EXPECT_FALSE(part.complete);
  EscapeOptions rest;
  rest.before = &part;
  rest.threads = 1;
  expect_equal(run_crew(2, rest), alone);
}

TEST(Crew, EndsWhenTheFirstRankFails) {
  struct Full : EscapeJournal {
    explicit Full(int good) : left(good) {}
    void save(const EscapeResult&) override {
      if (left-- == 0) throw InputError("the disk is full");
    }
    int left;
  };
  System system = make_system(magnetic_square);
  system.run.trajectories = 1'000'000'000;
  for (const int good : {0, 3}) {
    Full full(good);
    EscapeOptions options;
    options.threads = 1;
    options.journal = &full;
    options.save_every = 0.01;
    EXPECT_THROW(run_crew(3, options, late(-1), system), InputError);
  }
}

// What is impossible in one process alone stands for a memory that is full there: at once, or at the first start.
TEST(Crew, EndsWhenOneRankCannotBegin) {
  EscapeOptions options;
  options.threads = 1;
  System good = make_system(magnetic_square);
  good.run.trajectories = 1'000'000'000;
  for (const auto kind : {InitialCondition::Kind::birkhoff, InitialCondition::Kind::point})
    for (const int broken : {0, 1, 2})
      for (const bool with_journal : {false, true}) {
        Records records;
        options.journal = with_journal ? &records : nullptr;
        std::vector<System> systems(3, good);
        systems[static_cast<std::size_t>(broken)].initial.kind = kind;
        systems[static_cast<std::size_t>(broken)].initial.position = {7, 7};
        EXPECT_THROW(run_crew(systems, options), InputError) << broken;
      }
}

TEST(Bytes, ComeBackAsTheyWere) {
  BytesOut out;
  const std::vector<std::uint64_t> numbers{1, 2, 3};
  out << 1.5 << std::string("words") << numbers << std::string();
  BytesIn in(out.bytes);
  double x = 0;
  std::string text, none = "x";
  std::vector<std::uint64_t> back;
  in >> x >> text >> back >> none;
  EXPECT_EQ(x, 1.5);
  EXPECT_EQ(text, "words");
  EXPECT_EQ(back, numbers);
  EXPECT_EQ(none, "");
  EXPECT_THROW(in >> x, InternalError);
}

}  // namespace
}  // namespace carom
