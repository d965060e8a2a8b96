// Rare events by population splitting: survival far beyond what independent trajectories reach.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "carom/events/decisions.hpp"
#include "carom/lanes/instruction_set.hpp"
#include "carom/system/system.hpp"

namespace carom {

/// A population flies from level to level. At each level those that are left are copied until the
/// population is as large as before, and share its weight. The first copy of a survivor goes on as
/// it is. Every other one goes back by a few hits, is kicked there (its v_parallel / v by up to
/// delta), and takes its new way if that reaches the level after as many hits, too
/// (docs/physics/rare-events.md). Free particles only.
struct SplittingPlan {
  enum class Level {
    time,  ///< the first hit after the time
    hits   ///< hit n + 1: what reaches it was not gone within n hits
  } by = Level::time;
  std::vector<double> levels;        ///< increasing; whole numbers for hits
  std::uint64_t population = 20000;  ///< trajectories of each population
  std::uint64_t repetitions =
      16;  ///< independent populations for each size of the kick; at least 2
  /// The largest delta; half and a quarter of it are taken, too. 0: the largest power of 1/2 up to
  /// largest_choice at which at most most_kept of the kicked copies of a small population keep
  /// their way; a quarter of it, and so on, until kicked copies stay as long as others
  /// (cost_of_kicks), as far as small populations tell.
  double kick = 0.0;
  static constexpr double largest_choice = 0x1p-9, most_kept = 0.3;
  /// Hits by which a copy goes back; at most most_lookback. Where the start is fewer hits away it
  /// goes there, and the kick is larger.
  std::uint64_t lookback = 6;
  static constexpr std::uint64_t most_lookback = 8;
  /// Deviations go along, and are copied with their trajectories; by hits only. At each level their
  /// growth is averaged with the weights e^(tilt t) of trajectories that come there at t.
  struct Deviations {
    double unit_length = 1.0;  ///< as in EngineOptions
    double tilt = 0.0;
  };
  std::optional<Deviations> deviations = {};
};

/// How to run, without influence on the result.
struct SplittingOptions {
  int threads = 0;  ///< 0: as many as OpenMP gives
  DecisionOptions decisions;
  std::optional<InstructionSet> lanes = widest_instruction_set();  ///< empty: one after the other
  const std::atomic<bool>* interrupted = nullptr;
  /// Called after each population from one thread at a time.
  std::function<void(std::uint64_t done, std::uint64_t all, std::uint64_t hits)> progress;
};

inline constexpr std::size_t kick_sizes = 3;  ///< delta, delta / 2, delta / 4

/// Trajectories that were followed through a stage, and those of them that stayed to its end.
struct Staying {
  std::uint64_t followed = 0, stayed = 0;
};
/// The first copies of survivors, which go on as they are, and the others.
struct CopiesOfStage {
  Staying first, kicked;
};

/// Trajectories at a level, by SplittingPlan::deviations.
struct GrowthAtLevel {
  std::uint64_t number = 0;
  double log_share = 0.0;           ///< ln of the share of all starts that they represent
  double log_weight = 0.0;          ///< ln of their mean weight
  double time = 0.0, growth = 0.0;  ///< means of the time and of ln|deviation|
  double time_variance = 0.0, covariance = 0.0;
};

/// What one population gives, at each reported time or number of hits.
struct PopulationRun {
  bool done = false;
  std::vector<double> survival;        ///< share not gone by then
  std::vector<double> gone;            ///< share gone since the report before; by time only
  std::vector<std::uint64_t> reached;  ///< trajectories that reached each level
  std::vector<CopiesOfStage> copies;   ///< of each stage; none are kicked before the first
  std::vector<GrowthAtLevel> growth;   ///< at each level, if deviations go along
  double trapped = 0.0;                ///< share that can never go
  double singular = 0.0;  ///< share that ended without a continuation; taken out of the others
  std::uint64_t collisions = 0, unresolved = 0, lost = 0, digest = 0;
  std::uint64_t tried = 0,
                accepted = 0;  ///< copies that were kicked, and those whose new way was taken
};

/// What all populations give; of an interrupted run, whole repetitions.
struct SplittingResult {
  SplittingPlan plan;
  std::vector<double> at;  ///< report times, or the levels in hits
  std::array<std::vector<PopulationRun>, kick_sizes>
      runs;  ///< those that were finished, by repetition
  DecisionCounts decisions;
  bool complete = true;  ///< false when interrupted: whole populations only
  double seconds = 0, cpu_seconds = 0;
  int threads = 1;
  std::uint64_t collisions = 0, unresolved = 0, lost = 0;
  std::uint64_t digest = 0;
  std::vector<std::string> reports;  ///< of the first few that failed
};

/// Throws InputError where the plan or the system does not allow it.
SplittingResult run_splitting(const System&, const SplittingPlan&, const SplittingOptions& = {});

/// A mean over repetitions with its standard error.
struct Mean {
  double value = 0.0, error = 0.0;
};
/// A quantity at each kick and its limit for vanishing kicks: the least-squares line in delta^2.
struct Extrapolated {
  std::array<Mean, kick_sizes> at_kick;
  Mean limit;                ///< error: statistical, from the repetitions
  double extrapolation = 0;  ///< |limit - value at the smallest kick|: what the limit rests on
  double kick_error =
      0;  ///< where kicked copies certainly go sooner or later than others: twice what that makes
  double unseen = 0;  ///< where no trajectory has gone in any population: upper limit (Wilson)
  std::size_t repetitions = 0;  ///< that the limit is a mean of
  /// Populations of fewer trajectories give intervals that hold the value too seldom.
  static constexpr std::uint64_t least_population = 100;
  double least = -std::numeric_limits<double>::infinity(), most = -least;  ///< what is possible
  /// Half the width of the 95 % band: statistics (Student's t of as many repetitions),
  /// extrapolation, the kicks' error and what is unseen.
  double band() const;
  /// Ends of the 95 % interval, as far as that is possible: the band about the value, or, of what
  /// cannot be negative, about its logarithm. Small populations mostly give too little and seldom
  /// far too much.
  double low() const;
  double high() const;
};
/// Share still there at a report time, or after a number of hits.
struct SplitPoint {
  double at = 0.0;
  Extrapolated p;
  /// Independent trajectories that would give the same statistical error.
  double equivalent = 0.0;
};
/// Escapes per unit time between two report times; t is their middle (geometric where from > 0).
struct SplitRate {
  double t = 0.0, from = 0.0, to = 0.0;
  Extrapolated value;
};
/// Kicked copies should stay as long as the first ones, which go on as they are. As they do not,
/// survival at a report is wrong by this share of it at the smallest kick, as far as the stage
/// after each kick tells; the error is that of the mean over repetitions.
Mean cost_of_kicks(const SplittingResult&, std::size_t report);
/// The same of populations at any one kick, through this many stages.
Mean cost_of_kicks(const std::vector<PopulationRun>&, std::size_t stages);
/// Is that more than chance? Chance alone is likely with 5 % and certain with 0.2 %.
bool is_likely(const Mean& cost, std::size_t repetitions);
bool is_certain(const Mean& cost, std::size_t repetitions);

/// Survival at each report.
std::vector<SplitPoint> survival(const SplittingResult&);
/// Escapes per unit time between report times; none by hits.
std::vector<SplitRate> escape_rate(const SplittingResult&);

}  // namespace carom
