// Several processes run one escape ensemble: rank 0 hands out blocks and adds up, and works itself.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "carom/ensemble/escape.hpp"
#include "carom/ensemble/ranks.hpp"
#include "ensemble/block_list.hpp"

namespace carom {

/// What a rank has done since it last told.
struct EscapePart {
  struct Block {
    TrajectoryRange range;
    std::vector<TrajectoryRecord> records;
  };
  EscapeResult sum;
  std::vector<Block> blocks;  ///< if records are wanted
};

/// How the others are to work.
struct CrewPlan {
  bool records = false;
  double seconds = 10;  ///< between parts
};

/// Rank 0, in a thread of its own.
class Foreman {
 public:
  struct Calls {
    std::function<std::vector<TrajectoryRange>(std::uint64_t share)> blocks;  ///< next ones for 1/share of the crew; empty: none
    std::uint64_t block = 1;                                                  ///< their size
    std::function<void(EscapePart&&)> take;
    std::function<bool()> stopped;
  };
  Foreman(Ranks&, const CrewPlan&, Calls);
  Foreman(const Foreman&) = delete;
  ~Foreman();
  /// Instead of a foreman where there is no work.
  static void dismiss(Ranks&);
  /// Until all others have ended. Throws the first error of one of them.
  void wait();
  /// Did one of them fail, or was it interrupted?
  bool failed() const { return failed_.load(std::memory_order_relaxed); }

 private:
  void serve();
  void answer(const Ranks::Message&);
  void stop(int rank);

  Ranks& ranks_;
  CrewPlan plan_;
  Calls calls_;
  int left_;
  std::vector<char> told_;  // to stop
  std::string error_;
  std::atomic<bool> failed_{false};
  std::thread thread_;
};

/// Any other rank: gets blocks before they are needed, and tells now and then what was done.
class Hand {
 public:
  /// `take` gives what was done since the last call; `heavy` says whether that should be told soon.
  struct Calls {
    std::function<EscapePart()> take;
    std::function<bool()> heavy;
  };
  /// Waits for the plan, or is stopped at once: then there is nothing to start.
  explicit Hand(Ranks&);
  Hand(const Hand&) = delete;
  ~Hand();
  const CrewPlan& plan() const { return plan_; }
  void start(Calls, const std::atomic<bool>* interrupted);
  /// The next block; false: there is none. From any thread.
  bool next(TrajectoryRange&);
  /// Is everybody to stop?
  bool stopped() const { return stopped_.load(std::memory_order_relaxed); }
  /// Tells what is left to tell, and the error if there is one.
  void end(const std::string& error);

 private:
  void serve();
  void read(const Ranks::Message&);
  void tell(bool last, const std::string& error);

  Ranks& ranks_;
  CrewPlan plan_;
  Calls calls_;
  const std::atomic<bool>* interrupted_ = nullptr;
  std::atomic<bool> stopped_{false};
  std::mutex mutex_;
  std::condition_variable more_;
  std::optional<BlockList> stock_;
  std::uint64_t used_ = 0;
  bool asked_ = false, exhausted_ = false, ended_ = false;
  std::string error_;
  std::thread thread_;
};

}  // namespace carom
