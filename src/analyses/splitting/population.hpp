// One population of a splitting run.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "analyses/splitting/kick.hpp"
#include "carom/analyses/splitting.hpp"
#include "carom/engines/engine.hpp"
#include "carom/starts/sampler.hpp"
#include "motion/free_tangent.hpp"

namespace carom::analyses {

/// Runs populations in one thread, each stage of one by an engine. A population is a function of
/// (seed, repetition, number of the kick) alone.
class Population {
 public:
  /// `world`: one for the system, which shares what it prepared of the table.
  Population(const System&, const Sampler&, const World& world, const Kick&, const SplittingPlan&,
             const std::vector<double>& reports, const SplittingOptions&);

  /// `kick_number` 0, 1, 2: delta, delta / 2, delta / 4. Not `done` if it was stopped on the way.
  PopulationRun run(std::uint64_t repetition, std::size_t kick_number,
                    const std::function<bool()>& stopped);
  /// Of the first few trajectories that failed.
  const std::vector<std::string>& failures() const { return failures_; }
  DecisionCounts decisions() const;
  /// Memory of a trajectory, and of its copy for the next stage.
  static std::size_t bytes_each() { return 2 * sizeof(Member) + sizeof(std::size_t); }

 private:
  /// A deviation across the orbit, as motion::FreeTangent has it.
  struct Stretch {
    Transverse deviation;
    double shrunk = 0.0;
  };
  struct Moment {
    State state;
    std::uint64_t hits = 0;
    Stretch stretch;
  };
  /// The last hits of a trajectory.
  struct Memory {
    std::array<Moment, SplittingPlan::most_lookback + 1> ring;
    std::size_t size = 0, next = 0;
    std::uint64_t since_start = 0;  ///< moments of the whole orbit, forgotten ones too
    void keep(const State&, std::uint64_t hits, const Stretch&);
    void forget(std::size_t newest);
    /// The moment `back` hits ago (0: the last one), or the oldest there is. Not of an empty
    /// memory.
    const Moment& ago(std::size_t back) const;
  };
  enum class Way { reached, gone, trapped, ended };
  /// A trajectory; all of a population have the same share of the whole.
  struct Member {
    State state;
    std::uint64_t hits = 0;
    Memory memory;
    bool kicked = false;     ///< no first copy
    Way way = Way::reached;  ///< of the latest stage
  };
  struct Stage {
    double level = 0.0;
    bool last = false;         ///< ends at the last report time, wherever the member is
    std::uint64_t stream = 0;  ///< of random numbers
  };
  /// Starts and listener: members on their way through a stage.
  class Flights;
  /// Gives the next member and its index; null: there is none. The member may be made in `copy`,
  /// which is its own until its flight has ended.
  using Next = std::function<Member*(std::size_t& index, Member& copy, const World&)>;
  /// The stage of that member has ended.
  using Done = std::function<void(std::size_t, const Member&)>;

  bool fly(const Stage&, const Next&, const Done&);
  void note(const ParticleEnd&);
  bool fly_members(const Stage&, bool first, std::uint64_t repetition);
  void count(const Stage&, std::size_t number);
  void begin_deviation(motion::FreeTangent&, const Member&) const;
  GrowthAtLevel growth_of_survivors() const;
  void report_times(double to);
  void copy_survivors(const Stage&);
  bool separate_copies(const Stage&, double shrink);
  void finish();
  std::size_t report_of(std::size_t stage, const Member&) const;
  bool by_time() const { return plan_.by == SplittingPlan::Level::time; }
  /// The share of so many of this stage's trajectories: whole numbers, so that all are the whole
  /// stage exactly.
  double share(std::uint64_t number) const {
    return share_of_stage_ * (static_cast<double>(number) / static_cast<double>(plan_.population));
  }

  const System& system_;
  const Sampler& sampler_;
  const Kick& kick_;
  const SplittingPlan& plan_;
  const std::vector<double>& reports_;
  motion::TangentWalls walls_;                      // if deviations go along
  std::unique_ptr<Engine> to_levels_, to_the_end_;  // the latter by time only
  std::function<bool()> stopped_;
  PopulationRun result_;
  std::vector<std::string> failures_;
  std::vector<double> kicks_;  // the largest delta, by the hits that a copy goes back
  std::vector<Member> members_, copies_;
  std::vector<std::size_t> survivors_;  // of a stage, among its members
  double share_of_stage_ = 1.0;         // that all trajectories of the stage stand for
  double log_share_ = 0.0;              // its logarithm, which does not underflow
  double trapped_ = 0.0;                // share that cannot go any more
  double before_ = -1.0;                // the level where the stage began
  std::size_t first_loss_ = 0;          // the first report by which a trajectory has gone
  std::vector<double>
      gone_by_;  // share gone between reports in the stages before; the last entry after all
  std::vector<std::uint64_t> going_;  // number gone in this stage, too
};

}  // namespace carom::analyses
