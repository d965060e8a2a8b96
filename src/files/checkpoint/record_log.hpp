// The records of trajectories beside a checkpoint: a file that only grows.
#pragma once

#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "carom/results/ensemble_result.hpp"
#include "carom/results/trajectory_ranges.hpp"

namespace carom::files {

/// Records as they lie in memory, in the order in which blocks came in. What a checkpoint names
/// stays where it is; what was written after it is written again by the run that goes on.
class RecordLog {
 public:
  /// Trajectories first … last - 1 are the records row … row + rows - 1. `sum` is a hash of their
  /// bytes.
  struct Piece {
    std::uint64_t first = 0, last = 0, row = 0, rows = 0, sum = 0;
  };

  /// `name` is that of the archive, for messages. An existing file is emptied, or opened and cut to
  /// the records that `pieces` hold; InputError where these were changed. It is removed in the end
  /// unless kept.
  RecordLog(const std::string& path, const std::string& name);
  RecordLog(const std::string& path, const std::string& name, std::vector<Piece> pieces);
  RecordLog(const RecordLog&) = delete;
  ~RecordLog();

  /// Any thread may call it. While the disk is full, up to 256 MB wait in memory; then it throws.
  void add(TrajectoryRange, std::vector<TrajectoryRecord>&&);
  /// Remembers what has come until now. Throws InputError, and remembers nothing, where it cannot
  /// be written; it may be asked again.
  void mark();
  /// Sees to it that what was marked is on the disk. add() may go on.
  std::vector<Piece> sync();
  /// All that was marked, in order of index, in batches: each with the piece that it is of. Throws
  /// InputError behind the last batch of a piece whose bytes are others than were written.
  void read(
      const std::function<void(const Piece&, const std::vector<TrajectoryRecord>&)>& batch) const;

  void keep(bool wanted) { kept_ = wanted; }

 private:
  struct Block {
    TrajectoryRange range;
    std::vector<TrajectoryRecord> records;
  };
  void write_out();  // with the mutex held
  [[noreturn]] void fail(const char* what) const;

  std::string path_, name_;
  int descriptor_ = -1;
  bool kept_ = false;
  int broken_ = 0;  ///< the error of a sync that failed
  mutable std::mutex mutex_;
  std::vector<Block> waiting_;
  std::size_t waiting_records_ = 0, next_write_;
  std::vector<Piece> pieces_, marked_;
  std::uint64_t rows_ = 0;
};

}  // namespace carom::files
