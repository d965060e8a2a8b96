// The processes that mpirun or srun started together.
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <thread>

namespace carom::cli {

/// Processes that share a run, numbered from 0. Each of them makes every call, in the same order. A
/// call waits, asleep, until all have made it; where one of them dies, mpirun ends the others.
class Ranks {
 public:
  /// The state of one process, or of all together.
  struct Vote {
    bool done = false;  ///< all are done
    bool stop = false;  ///< one of them wants all to stop
  };

  virtual ~Ranks() = default;
  virtual int rank() const = 0;
  virtual int size() const = 0;
  virtual Vote vote(Vote mine) = 0;
  /// The text that rank 0 gives.
  virtual std::string tell(const std::string& text) = 0;
  /// Rank 0 takes the texts of all ranks, in order, its own too.
  virtual void gather(const std::string& text,
                      const std::function<void(int rank, const std::string& text)>& take) = 0;
};

/// Number of this process among those started together; 0 where it was started alone. MPI is not
/// started.
int rank_by_environment();
/// Starts MPI; null where this process was started alone, or built without MPI. MPI ends with the
/// process, after its last word: mpirun ends all processes as soon as one of them has ended with an
/// error.
Ranks* start_ranks();

/// While the ranks compute: where one of them fails or is interrupted, all of them stop.
class Meeting {
 public:
  Meeting(Ranks& ranks, const std::atomic<bool>& interrupted)
      : ranks_(ranks), interrupted_(interrupted) {}
  Meeting(const Meeting&) = delete;
  ~Meeting() { end(true); }
  /// Listens to the others from now on, in a thread of its own.
  void begin() {
    thread_ = std::thread([this] { vote_until_all_are_done(); });
  }
  /// Is this process to stop?
  const std::atomic<bool>& stopped() const { return stopped_; }
  /// This process is done. Waits until all are.
  void end(bool failed);

 private:
  void vote_until_all_are_done();

  Ranks& ranks_;
  const std::atomic<bool>& interrupted_;
  std::atomic<bool> stopped_{false}, done_{false};
  bool over_ = false;
  std::thread thread_;  // last: it uses the others
};

}  // namespace carom::cli
