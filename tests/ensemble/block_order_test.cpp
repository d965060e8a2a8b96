#include "ensemble/block_order.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace carom {

using namespace ensemble;

namespace {

std::vector<TrajectoryRecord> block_of(std::uint64_t index) {
  TrajectoryRecord record;
  record.index = index;
  return {record};
}

TEST(BlockOrder, PutsBlocksInOrder) {
  std::vector<std::uint64_t> seen;
  const BlockOrder::Sink sink = [&](const auto& records) { seen.push_back(records.front().index); };
  BlockOrder order(sink, 8);
  order.deliver(2, block_of(2));
  order.deliver(1, block_of(1));
  EXPECT_TRUE(seen.empty());
  order.deliver(0, block_of(0));
  EXPECT_EQ(seen, (std::vector<std::uint64_t>{0, 1, 2}));
  order.deliver(3, block_of(3));
  EXPECT_EQ(seen.size(), 4u);
  // Block 4 never comes.
  order.deliver(6, block_of(6));
  order.deliver(5, block_of(5));
  EXPECT_EQ(seen.size(), 4u);
  order.flush();
  EXPECT_EQ(seen, (std::vector<std::uint64_t>{0, 1, 2, 3, 5, 6}));
}

TEST(BlockOrder, HoldsBackBlocksThatAreTooFarAhead) {
  const BlockOrder::Sink sink = [](const auto&) {};
  BlockOrder order(sink, 2);
  std::atomic<bool> passed{false};
  std::thread ahead([&] {
    order.await_turn(2);
    passed = true;
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_FALSE(passed);
  order.deliver(0, block_of(0));
  ahead.join();
  EXPECT_TRUE(passed);
  std::thread stopped([&] { order.await_turn(100); });
  order.close();
  stopped.join();
}

}  // namespace
}  // namespace carom
