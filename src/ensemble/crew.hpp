// Several processes run one ensemble: rank 0 hands out blocks and adds up, and works itself. What an ensemble
// adds up travels as bytes, so that every kind of ensemble has the same crew.
//
// (1) Whatever fails, and wherever, every rank ends: with an exception, if it was not told that all is done.
// (2) Before there is a foreman, a Muster tells; where no message can be made any more, the process aborts,
// and MPI
//     ends the others.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "carom/ensemble/ranks.hpp"
#include "carom/ensemble/trajectory_ranges.hpp"
#include "ensemble/block_list.hpp"
#include "ensemble/bytes.hpp"

namespace carom {

/// The system that rank 0 has read, for the others.
struct CrewJob {
  std::string name, toml;
  bool everywhere = false;  ///< integrates everything
};
/// Rank 0 tells the others what to run; nothing: there is nothing to do.
void call_crew(Ranks&, const CrewJob*);
/// What it told this rank.
std::optional<CrewJob> called_by(Ranks&);

/// How the others are to work.
struct CrewPlan {
  bool records = false;
  double seconds = 10;             ///< between parts
  std::uint64_t trajectories = 0;  ///< if not 0: a part is told soon where it holds as many
};

/// Rank 0 before there is a foreman: if it goes no further, the others are told to go.
class Muster {
 public:
  explicit Muster(Ranks* ranks) : ranks_(ranks) {}
  Muster(const Muster&) = delete;
  ~Muster();
  void over() { ranks_ = nullptr; }

 private:
  Ranks* ranks_;
};

/// Rank 0, in a thread of its own.
class Foreman {
 public:
  struct Calls {
    std::function<std::vector<TrajectoryRange>(std::uint64_t share)>
        blocks;                          ///< next ones for 1/share of the crew; empty: none
    std::uint64_t block = 1;             ///< their size
    std::function<void(BytesIn&)> take;  ///< what a rank has done since it last told
    std::function<bool()> stopped;
    std::function<bool()> failed;  ///< did this process stop because of an error?
  };
  Foreman(Ranks&, const CrewPlan&, Calls);
  Foreman(const Foreman&) = delete;
  ~Foreman();
  /// Until all others have ended. Throws the first error of one of them.
  void wait();
  /// Did one of them fail, or was it interrupted?
  bool ended() const { return ended_.load(std::memory_order_relaxed); }

 private:
  void serve();
  void answer(const Ranks::Message&);
  void stop(int rank);
  void fail(const std::string& error);

  Ranks& ranks_;
  CrewPlan plan_;
  Calls calls_;
  int left_;
  std::vector<char> told_;  // to stop
  std::string error_;
  std::atomic<bool> ended_{false}, failed_{false};
  std::thread thread_;
};

/// Any other rank: gets blocks before they are needed, and tells now and then what was done.
class Hand {
 public:
  /// `take` writes what was done since the last call; `heavy` says whether that should be told soon.
  struct Calls {
    std::function<void(BytesOut&)> take;
    std::function<bool()> heavy;
  };
  /// Waits for the plan. Throws InputError where there is none, because rank 0 has failed.
  explicit Hand(Ranks&);
  Hand(const Hand&) = delete;
  ~Hand();
  const CrewPlan& plan() const { return plan_; }
  void start(Calls, const std::atomic<bool>* interrupted);
  /// The next block; false: there is none. From any thread.
  bool next(TrajectoryRange&);
  /// Is everybody to stop?
  bool stopped() const { return stopped_.load(std::memory_order_relaxed); }
  /// Tells what is left to tell, and the error if there is one. Throws InputError where another rank has
  /// failed.
  void end(const std::string& error);

 private:
  void serve();
  void read(const Ranks::Message&);
  void tell(bool last, const std::string& error);
  void take_leave(const std::string& error);

  Ranks& ranks_;
  CrewPlan plan_;
  Calls calls_;
  const std::atomic<bool>* interrupted_ = nullptr;
  std::atomic<bool> stopped_{false}, failed_{false};
  std::mutex mutex_;
  std::condition_variable more_;
  std::optional<BlockList> stock_;
  std::uint64_t used_ = 0;
  bool asked_ = false, exhausted_ = false, ended_ = false;
  std::string error_;
  std::thread thread_;
};

/// What went wrong, in the words of the program.
std::string text_of(const std::exception&);

}  // namespace carom
