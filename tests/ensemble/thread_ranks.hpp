// Processes as threads.
#pragma once

#include <atomic>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "carom/ensemble/ranks.hpp"

namespace carom {

struct Office {
  explicit Office(int size) : boxes(static_cast<std::size_t>(size)) {}
  std::mutex mutex;
  std::vector<std::deque<Ranks::Message>> boxes;
};

class ThreadRanks : public Ranks {
 public:
  ThreadRanks(Office& office, int rank) : office_(office), rank_(rank) {}
  int rank() const override { return rank_; }
  int size() const override { return static_cast<int>(office_.boxes.size()); }
  void send(int to, const std::vector<std::byte>& bytes) override {
    const std::lock_guard lock(office_.mutex);
    office_.boxes[static_cast<std::size_t>(to)].push_back({rank_, bytes});
  }
  std::optional<Message> receive() override {
    const std::lock_guard lock(office_.mutex);
    auto& box = office_.boxes[static_cast<std::size_t>(rank_)];
    if (box.empty()) return {};
    Message first = std::move(box.front());
    box.pop_front();
    return first;
  }

 private:
  Office& office_;
  int rank_;
};

/// A crew whose first rank is the test itself.
class ThreadCrew {
 public:
  explicit ThreadCrew(int size) : office_(size), first_(office_, 0) {}
  Ranks& first() { return first_; }
  /// Every other rank does `work` in a thread of its own.
  void start_hands(const std::function<void(Ranks&)>& work) {
    for (int rank = 1; rank < first_.size(); ++rank)
      hands_.emplace_back([this, rank, work] {
        ThreadRanks ranks(office_, rank);
        try {
          work(ranks);
        } catch (const std::exception&) {
          ++failed_;
        }
      });
  }
  void join() {
    for (std::thread& hand : hands_) hand.join();
    hands_.clear();
  }
  /// Once all have ended: those that ended by an exception; messages that nobody has received.
  int failed() const { return failed_; }
  std::size_t messages_left() const {
    std::size_t sum = 0;
    for (const auto& box : office_.boxes) sum += box.size();
    return sum;
  }

 private:
  Office office_;
  ThreadRanks first_;
  std::vector<std::thread> hands_;
  std::atomic<int> failed_{0};
};

}  // namespace carom
