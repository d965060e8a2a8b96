// Escape statistics of an ensemble of independent trajectories.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "carom/analysis/survival.hpp"
#include "carom/ensemble/system.hpp"
#include "carom/events/decisions.hpp"
#include "carom/lanes/instruction_set.hpp"

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

/// How to run, without influence on the result.
struct EscapeOptions {
  int threads = 0;             ///< 0: as many as OpenMP gives
  std::uint64_t block = 1024;  ///< trajectories a block; the result does not depend on it
  DecisionOptions decisions;
  /// Instruction set of the lanes that fly systems of independent free particles; empty: one by one.
  std::optional<InstructionSet> lanes = widest_instruction_set();
  const std::atomic<bool>* interrupted = nullptr;  ///< asked between blocks and during long ones
  /// Called now and then from one thread at a time with the trajectories done so far.
  std::function<void(std::uint64_t done, std::uint64_t hits)> progress;
  /// If set, receives each block's records in increasing order of index (one thread at a time).
  std::function<void(const std::vector<TrajectoryRecord>&)> records;
};

/// What an escape run adds up.
struct EscapeResult {
  SurvivalCounts counts;
  std::uint64_t digest = 0;
  DecisionCounts decisions;
  bool complete = true;  ///< false when interrupted: whole blocks only
  double seconds = 0, cpu_seconds = 0;
  int threads = 1;
  std::optional<InstructionSet> lanes;  ///< that flew it; empty: the scalar engine did
  std::vector<std::string> reports;  ///< first few states that were lost
};

/// Runs the ensemble: trajectories 0 … System::run.trajectories - 1. Where a trajectory has several
/// particles, each of them is an entry of its own in every count; one
/// that is injected counts from the time 0 on as one that is not gone. Throws InputError where the initial
/// condition is impossible, and whatever `records` throws.
EscapeResult run_escape(const System&, const EscapeOptions& = {});

}  // namespace carom
