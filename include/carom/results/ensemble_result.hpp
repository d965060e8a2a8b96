// What all ensembles have in common that can be stopped, continued and cut into parts.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "carom/base/fields.hpp"
#include "carom/events/decisions.hpp"
#include "carom/events/energy.hpp"
#include "carom/events/event.hpp"
#include "carom/events/step_counts.hpp"
#include "carom/lanes/instruction_set.hpp"
#include "carom/results/trajectory_ranges.hpp"

namespace carom {

/// One particle of one trajectory, for archives, exit basins and maps of exponents. `index` is
/// trajectory * (number of particles) + particle; with injections see particle_index().
struct TrajectoryRecord {
  std::uint64_t index = 0;
  double x = 0, y = 0, vx = 0, vy = 0;  ///< start, unwrapped
  Fate fate = Fate::survived;
  /// Of exponents, as Regularity: 0 linear, 1 chaotic, 2 undecided.
  unsigned char regularity = 2;
  std::uint16_t unused = 0;  // no byte of a record is without a value
  std::int32_t hole = -1;    ///< index into hole_names()
  std::int32_t wall = -1;    ///< of the start; -1: it lies off the walls
  std::int32_t unused_too = 0;
  double time = 0;  ///< end: escape, last hit of an unbounded one, else t_max
  std::uint64_t hits = 0;
  /// Of a start on a wall; else NaN: arc length along it, component of the velocity along it.
  double s = std::numeric_limits<double>::quiet_NaN(),
         v_parallel = std::numeric_limits<double>::quiet_NaN();
  /// Of exponents, else NaN: that of the time of which it is known, and SALI at its end.
  double lambda = std::numeric_limits<double>::quiet_NaN(),
         sali = std::numeric_limits<double>::quiet_NaN();
};

template <>
struct Fields<TrajectoryRecord> {
  using R = TrajectoryRecord;
  static constexpr std::tuple list{
      field("index", "1",
            "trajectory * particles + particle; with injections trajectory * 2^20 + particle",
            &R::index),
      field("x", "length", "Start, unwrapped", &R::x),
      field("y", "length", "Start, unwrapped", &R::y),
      field("vx", "length/time", "Velocity at the start", &R::vx),
      field("vy", "length/time", "Velocity at the start", &R::vy),
      field("fate", "1", "Index into the attribute `names`", &R::fate),
      field("hole", "1", "Index into the attribute `names`, -1: did not escape", &R::hole),
      field("t", "time", "Time of the end: escape, last hit if unbounded, else the time reached",
            &R::time),
      field("hits", "1", "Reflections", &R::hits),
      field("wall", "1", "Wall of the start, -1: off the walls", &R::wall),
      field("s", "length", "Start: arc length along its wall, NaN: off walls", &R::s),
      field("v_parallel", "length/time", "Start: velocity along its wall, NaN: off walls",
            &R::v_parallel)};
};
/// Of exponents, too.
struct ExponentFields {
  using R = TrajectoryRecord;
  static constexpr auto list = std::tuple_cat(
      Fields<R>::list,
      std::tuple{
          later(field("lambda", "1/time", "Finite-time exponent, NaN: ended before it was measured",
                      &R::lambda)),
          later(field("sali", "1", "Angle between two deviations (SALI)", &R::sali)),
          later(field("regularity", "1", "Index into the attribute `names`", &R::regularity))});
};

/// Index and report of particles that were lost or unresolved.
using Reports = std::vector<std::pair<std::uint64_t, std::string>>;
/// So many of them are kept …
inline constexpr std::size_t most_reports = 5;
/// … those of the lowest indices, sorted. Their order of arrival does not matter.
void keep_first(Reports& reports, std::uint64_t index, const std::string& report);

/// Besides what a kind of ensemble adds up.
struct EnsembleResult {
  using RecordFields = Fields<TrajectoryRecord>;  ///< what its archive says of a trajectory

  std::uint64_t digest =
      0;  ///< sum modulo 2^64 of a hash of each particle's end; see docs/developer/ensembles.md
  TrajectoryRanges done;  ///< trajectories that are counted
  DecisionCounts decisions;
  StepCounts steps;          ///< under forces
  EnergyError energy_error;  ///< under forces: the largest of a trajectory
  bool complete = true;      ///< false when interrupted
  double seconds = 0, cpu_seconds = 0;
  int threads = 1;                      ///< of each process
  int ranks = 1;                        ///< processes that shared it
  std::optional<InstructionSet> lanes;  ///< that flew it; empty: the scalar engine did
  Reports reports;                      ///< of the first few that failed

 protected:
  /// False, and no change, where a trajectory is in both.
  bool add_common(const EnsembleResult& other);
};

/// Keeps what an ensemble has done, so that it can go on after its process was killed.
template <class Result>
class EnsembleJournal {
 public:
  virtual ~EnsembleJournal() = default;
  /// Is block() to be given the records of each trajectory?
  virtual bool wants_records() const { return false; }
  /// Trajectories that are done, in any order, if records are wanted; one call at a time.
  virtual void block(TrajectoryRange, std::vector<TrajectoryRecord>&&) {}
  /// All blocks so far belong to the next save(). Not called during block().
  virtual void mark() {}
  /// Keeps `so_far`: all up to the last mark(), and what was there before. From a thread of its
  /// own, or from one that brings blocks (save_every_blocks), while others come in; one call at a
  /// time. May throw: then the run ends with that error.
  virtual void save(const Result& so_far) = 0;
};

/// How to run, without influence on the result.
template <class Result>
struct EnsembleOptions {
  int threads = 0;             ///< 0: as many as OpenMP gives
  std::uint64_t block = 1024;  ///< trajectories a block; the result does not depend on it
  DecisionOptions decisions;
  /// Instruction set of the lanes that fly systems of independent particles; empty: one by one.
  std::optional<InstructionSet> lanes = widest_instruction_set();
  /// The part of the trajectories 0 … System::run.trajectories - 1 that is asked for.
  TrajectoryRange part{0, std::numeric_limits<std::uint64_t>::max()};
  /// A part that is done already: it is not done again, and is added to the result.
  const Result* before = nullptr;
  EnsembleJournal<Result>* journal =
      nullptr;             ///< is asked to save first of all, and then now and then
  double save_every = 10;  ///< seconds
  std::uint64_t save_every_blocks =
      0;  ///< if not 0: whenever that many have come in, whatever the time
  /// Trajectories that are not done here and not counted: another archive holds them.
  TrajectoryRanges elsewhere;
  const std::atomic<bool>* interrupted = nullptr;  ///< asked between blocks and during long ones
  /// Called now and then from one thread at a time with the trajectories done so far and the hits
  /// of this call alone.
  std::function<void(std::uint64_t done, std::uint64_t hits)> progress;
};

}  // namespace carom
