#include "engines/ordered_output.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>

#include "engines/parallel_blocks.hpp"

namespace carom {

using namespace engines;

namespace {

using Numbers = std::vector<std::uint64_t>;
using Output = OrderedOutput<std::uint64_t>;

TEST(OrderedOutput, PutsBlocksInOrder) {
  Numbers seen;
  const Output::Sink sink = [&](const Numbers& block) { seen.push_back(block.front()); };
  Output output(sink, 8);
  Output::Writer writer(output);
  writer.deliver(2, {2});
  writer.deliver(1, {1});
  EXPECT_TRUE(seen.empty());
  writer.deliver(0, {0});
  EXPECT_EQ(seen, (Numbers{0, 1, 2}));
  writer.deliver(3, {3});
  EXPECT_EQ(seen.size(), 4u);
  // Block 4 never comes.
  writer.deliver(6, {6});
  writer.deliver(5, {5});
  EXPECT_EQ(seen.size(), 4u);
  output.finish();
  EXPECT_EQ(seen, (Numbers{0, 1, 2, 3, 5, 6}));
}

TEST(OrderedOutput, HoldsBackBlocksThatAreTooFarAhead) {
  const Output::Sink sink = [](const Numbers&) {};
  Output output(sink, 2);
  std::optional<Output::Writer> writer(std::in_place, output);
  std::atomic<bool> passed{false};
  std::thread ahead([&] {
    writer->await_turn(2);
    passed = true;
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_FALSE(passed);
  writer->deliver(0, {0});
  ahead.join();
  EXPECT_TRUE(passed);
  Output::Writer other(output);
  std::thread far_ahead([&] { other.await_turn(100); });
  writer.reset();  // blocks that it has begun will not come
  far_ahead.join();
}

// The thread that waits would wait for ever: the block that it waits for was lost with the error.
TEST(OrderedOutput, AnErrorOfTheSinkEndsAllWaiting) {
  int calls = 0;
  const Output::Sink sink = [&](const Numbers&) {
    ++calls;
    throw std::runtime_error("full");
  };
  Output output(sink, 2);
  Output::Writer writer(output), other(output);
  std::thread ahead([&] { other.await_turn(100); });
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_THROW(writer.deliver(0, {0}), std::runtime_error);
  ahead.join();
  EXPECT_FALSE(other.deliver(0, {0}));
  EXPECT_FALSE(other.deliver(1, {1}));
  output.finish();
  EXPECT_EQ(calls, 1);
}

struct Worker {
  Output::Writer writer;
  std::uint64_t fails_at;

  bool run(std::uint64_t block, std::uint64_t, std::uint64_t, const std::function<bool()>&) {
    writer.await_turn(block);
    if (block == fails_at) throw std::logic_error("this block");
    for (std::uint64_t i = 0; i < block % 5; ++i) std::this_thread::yield();
    return writer.deliver(block, {block});
  }
};

constexpr std::uint64_t never = 1000, blocks = 24;

// What the sink got of `blocks` blocks, and the error's text, where the sink, a block or the
// making of a worker fails.
std::pair<Numbers, std::string> written(int threads, std::uint64_t window,
                                        std::uint64_t sink_fails_at, std::uint64_t block_fails,
                                        int worker_fails = never) {
  Numbers seen;
  std::string said;
  const Output::Sink sink = [&](const Numbers& block) {
    seen.push_back(block.front());
    if (block.front() == sink_fails_at) throw std::runtime_error("the disk is full");
  };
  BlockPlan plan(blocks, threads, 1);
  EXPECT_EQ(plan.blocks, blocks);
  Output output(sink, window);
  std::atomic<int> made{0};
  try {
    const bool complete = run_blocks(
        plan, nullptr,
        [&] {
          if (made.fetch_add(1) == worker_fails) throw std::logic_error("this worker");
          return Worker{Output::Writer(output), block_fails};
        },
        [](Worker&) {});
    output.finish();
    EXPECT_TRUE(complete);
  } catch (const std::exception& error) {
    said = error.what();
    output.finish();
  }
  return {seen, said};
}

Numbers first(std::uint64_t count) {
  Numbers numbers;
  for (std::uint64_t i = 0; i < count; ++i) numbers.push_back(i);
  return numbers;
}

TEST(OrderedOutput, EveryThreadLeavesWhicheverDeliveryFails) {
  for (const int threads : {1, 2, 3, 8})
    for (const std::uint64_t window : {1u, 3u, 50u}) {
      EXPECT_EQ(written(threads, window, never, never), std::pair(first(blocks), std::string()));
      for (std::uint64_t k = 0; k < blocks; ++k)
        EXPECT_EQ(written(threads, window, k, never),
                  std::pair(first(k + 1), std::string("the disk is full")));
    }
}

TEST(OrderedOutput, EveryThreadLeavesWhicheverBlockFails) {
  for (const int threads : {1, 2, 3, 8})
    for (const std::uint64_t window : {1u, 3u, 50u}) {
      for (std::uint64_t k = 0; k < blocks; ++k) {
        const auto [seen, said] = written(threads, window, never, k);
        EXPECT_EQ(said, "this block");
        for (std::size_t i = 1; i < seen.size(); ++i) EXPECT_LT(seen[i - 1], seen[i]);
        EXPECT_EQ(std::count(seen.begin(), seen.end(), k), 0);
      }
      for (int k = 0; k < threads; ++k)
        EXPECT_EQ(written(threads, window, never, never, k).second, "this worker");
    }
}

TEST(OrderedOutput, WithoutASinkNothingWaits) {
  const Output::Sink none;
  Output output(none, 1);
  Output::Writer writer(output);
  EXPECT_FALSE(writer.is_wanted());
  writer.await_turn(100);
  EXPECT_TRUE(writer.deliver(100, {1}));
  output.finish();
}

}  // namespace
}  // namespace carom
