// One population of a splitting run.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "carom/ensemble/sampler.hpp"
#include "carom/ensemble/splitting.hpp"
#include "carom/events/world.hpp"
#include "kick.hpp"

namespace carom {

/// Runs populations in one thread. A population is a function of (seed, repetition, number of the
/// kick) alone.
class Population {
 public:
  Population(const System&, const Sampler&, const Kick&, const SplittingPlan&,
             const std::vector<double>& reports, DecisionOptions);

  /// `kick_number` 0, 1, 2: delta, delta / 2, delta / 4. Not `done` if it was stopped on the way.
  PopulationRun run(std::uint64_t repetition, std::size_t kick_number,
                    const std::function<bool()>& stopped, std::vector<std::string>& reports);
  const DecisionCounts& decisions() const { return world_.decisions(); }
  /// Memory of a trajectory, with those of the stage before.
  static std::size_t bytes_a_walker() { return 2 * sizeof(Walker); }

 private:
  struct Moment {
    State state;
    std::uint64_t hits = 0;
  };
  /// The last hits of a trajectory.
  struct Memory {
    std::array<Moment, SplittingPlan::most_lookback + 1> ring;
    std::size_t size = 0, next = 0;
    std::uint64_t since_start = 0;  ///< moments of the whole way, forgotten ones too
    void keep(const State&, std::uint64_t hits);
    void forget(std::size_t newest);
    /// The moment `back` hits ago (0: the last one), or the oldest there is. Not of an empty
    /// memory.
    const Moment& ago(std::size_t back) const;
  };
  /// A trajectory that is followed; all of a population have the same share of the whole.
  struct Walker {
    State state;
    std::uint64_t hits = 0;
    Memory memory;
    bool kicked = false;  ///< no first copy
  };
  class Recorder;
  /// Where a stage of a population ends.
  struct Stage {
    double level = 0.0;
    bool last = false;  ///< ends at the last report time, wherever the walker is
  };
  enum class Way { reached, gone, for_ever, ended };

  void start(std::uint64_t repetition);
  Way fly(Walker&, const Stage&, const std::function<bool()>& stopped);
  void copy_survivors(const Stage&, std::uint64_t stream, double shrink,
                      const std::function<bool()>& stopped, PopulationRun&,
                      std::vector<std::string>& reports);
  void part(Walker&, const Stage&, double shrink, RandomStream&,
            const std::function<bool()>& stopped, PopulationRun&,
            std::vector<std::string>& reports);
  void count_if_lost(PopulationRun&, std::vector<std::string>& reports) const;
  /// The share of so many of this stage's trajectories: whole numbers, so that all are the whole
  /// stage exactly.
  double share(std::uint64_t number) const {
    return share_of_stage_ * (static_cast<double>(number) / static_cast<double>(plan_.population));
  }
  void finish(std::size_t first_loss, PopulationRun&) const;
  void report_times(double from, double to, std::uint64_t still_there, double for_ever,
                    PopulationRun&);

  const System& system_;
  const Sampler& sampler_;
  const Kick& kick_;
  const SplittingPlan& plan_;
  const std::vector<double>& reports_;
  World world_;
  std::vector<double> kicks_;  // the largest delta, by the hits that a copy goes back
  std::vector<Walker> walkers_, survivors_;
  double share_of_stage_ = 1.0;  // that all trajectories of the stage stand for
  std::vector<double>
      gone_by_;  // share gone between reports in the stages before; the last entry after all
  std::vector<std::uint64_t> going_;  // number gone in this stage, likewise
};

}  // namespace carom
