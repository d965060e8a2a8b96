// Escape statistics of an ensemble of independent trajectories.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "carom/analysis/survival.hpp"
#include "carom/ensemble/ranks.hpp"
#include "carom/ensemble/system.hpp"
#include "carom/ensemble/trajectory_ranges.hpp"
#include "carom/events/decisions.hpp"
#include "carom/lanes/instruction_set.hpp"
#include "carom/lanes/lane_effort.hpp"

namespace carom {

/// One particle of one trajectory, for archives and exit basins. `index` is
/// trajectory * (number of particles) + particle; with injections see particle_index().
struct TrajectoryRecord {
  std::uint64_t index = 0;
  double x = 0, y = 0, vx = 0, vy = 0;  ///< start, unwrapped
  Fate fate = Fate::survived;
  std::int32_t hole = -1;
  double time = 0;  ///< end: escape, last hit of an unbounded one, else t_max
  std::uint64_t hits = 0;
};

/// What an escape run adds up.
struct EscapeResult {
  SurvivalCounts counts;
  std::uint64_t digest = 0;
  TrajectoryRanges done;    ///< trajectories that are counted
  DecisionCounts decisions;
  LaneEffort effort;        ///< of lanes, if any flew
  bool complete = true;     ///< false when interrupted: whole blocks only
  double seconds = 0, cpu_seconds = 0;
  int threads = 1;          ///< of each process
  int ranks = 1;            ///< processes
  std::optional<InstructionSet> lanes;  ///< that flew it; empty: the scalar engine did
  std::vector<std::pair<std::uint64_t, std::string>> reports;  ///< first few lost ones: index and state

  /// Adds another part of the same ensemble: counts, digest, decisions, times, reports. In any order the
  /// sum is the same. False, and no change, where a trajectory is in both.
  bool add(const EscapeResult& other);
};

/// Keeps what an ensemble has done, so that it can go on after its process was killed.
class EscapeJournal {
 public:
  virtual ~EscapeJournal() = default;
  /// Is block() to be given the records of each trajectory?
  virtual bool wants_records() const { return false; }
  /// A block that is done, in any order; one call at a time.
  virtual void block(TrajectoryRange, std::vector<TrajectoryRecord>&&) {}
  /// What came until now belongs to the next save(). Never during block().
  virtual void mark() {}
  /// Keeps `so_far`: all blocks up to the last mark(), and what was there before. From a thread of its own,
  /// while blocks come in. May throw: then the run ends with that error.
  virtual void save(const EscapeResult& so_far) = 0;
};

/// How to run, without influence on the result.
struct EscapeOptions {
  int threads = 0;             ///< 0: as many as OpenMP gives
  std::uint64_t block = 1024;  ///< trajectories a block; the result does not depend on it
  DecisionOptions decisions;
  /// Instruction set of the lanes that fly systems of independent free particles; empty: one by one.
  std::optional<InstructionSet> lanes = widest_instruction_set();
  /// The part of the trajectories 0 … System::run.trajectories - 1 that is asked for.
  TrajectoryRange part{0, std::numeric_limits<std::uint64_t>::max()};
  /// What was done before, and is not done again: the result holds it too.
  const EscapeResult* before = nullptr;
  EscapeJournal* journal = nullptr;  ///< is asked to save first of all, and then every so many seconds
  double save_every = 10;
  /// Processes that share the ensemble: each calls run_escape. Rank 0 has the result; part, before, journal and
  /// progress are its own. The others need the system, and their result is empty. Not with `records`.
  Ranks* ranks = nullptr;
  const std::atomic<bool>* interrupted = nullptr;  ///< asked between blocks and during long ones
  /// Called now and then from one thread at a time with the trajectories done so far.
  std::function<void(std::uint64_t done, std::uint64_t hits)> progress;
  /// If set, receives each block's records in increasing order of index (one thread at a time).
  std::function<void(const std::vector<TrajectoryRecord>&)> records;
};

/// Runs the ensemble, or the part that is asked for. Where a trajectory has several
/// particles, each of them is an entry of its own in every count; one
/// that is injected counts from the time 0 on as one that is not gone. Throws InputError where the initial
/// condition is impossible, and whatever `records` and the journal throw.
EscapeResult run_escape(const System&, const EscapeOptions& = {});

}  // namespace carom
