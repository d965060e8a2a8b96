// Trajectories of a diffusion run under forces, many at once in lanes.
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "carom/lanes/soft_lanes.hpp"
#include "ensemble/diffusion_walker.hpp"

namespace carom {

class SoftWalker {
 public:
  static bool suits(const System& system) { return SoftLanes::suits(*system.table, system.dynamics); }

  SoftWalker(const System& system, const Sampler& sampler, InstructionSet set, DecisionOptions decisions,
             DiffusionTally tally)
      : system_(system),
        sampler_(sampler),
        lanes_(*system.table, system.dynamics, set),
        tally_(tally),
        one_by_one_(system, sampler, decisions, tally) {}

  /// False when stopped on the way.
  bool run(TrajectoryRange range) {
    for (; range.first < range.last; range.first += together)
      if (tally_.stopped() || !run_together(range.first, std::min(range.last, range.first + together))) return false;
    return true;
  }

 private:
  static constexpr std::uint64_t together = 64;

  bool run_together(std::uint64_t first, std::uint64_t end) {
    const std::function<bool()> stopped = [this] { return tally_.stopped(); };
    const std::size_t count = end - first, particles = system_.particles.size();
    const double t_end = system_.run.times.back();
    starts_.resize(count);
    for (std::size_t k = 0; k < count; ++k) starts_[k] = sampler_.draw_all(one_by_one_.world(), first + k);
    squares_.assign(count * particles, {});
    ends_.assign(count, std::vector<State>(particles));
    lost_.assign(count, false);
    for (std::size_t p = 0; p < particles; ++p) {
      walks_.clear();
      for (std::size_t k = 0; k < count; ++k) walks_.push_back({starts_[k][p]});
      const auto sample = [&](std::size_t k, std::size_t, const State& state) {
        squares_[k * particles + p].push_back(square_of_displacement(system_, starts_[k][p], state));
      };
      if (!lanes_.run(system_.particles[p], walks_, t_end, system_.run.times, sample, stopped)) return false;
      for (std::size_t k = 0; k < count; ++k) {
        ends_[k][p] = walks_[k].state;
        if (walks_[k].lost) lost_[k] = true;
      }
    }
    for (std::size_t k = 0; k < count; ++k) {
      const std::uint64_t trajectory = first + k;
      if (lost_[k]) {
        if (!one_by_one_.run({trajectory, trajectory + 1})) return false;
        continue;
      }
      std::vector<DiffusingParticle> all;
      for (std::size_t p = 0; p < particles; ++p)
        all.push_back({trajectory * particles + p, Fate::survived, t_end, 0, -1, &squares_[k * particles + p], {}});
      tally_.add(trajectory, all, std::fabs(energy_of(ends_[k]) - energy_of(starts_[k])), {});
    }
    return true;
  }

  double energy_of(const std::vector<State>& states) const {
    return carom::energy_of(system_.particles, states, system_.dynamics, *system_.table).total();
  }

  const System& system_;
  const Sampler& sampler_;
  SoftLanes lanes_;
  DiffusionTally tally_;
  DiffusionWalker one_by_one_;  ///< for those who are lost
  std::vector<std::vector<State>> starts_, ends_;
  std::vector<std::vector<double>> squares_;
  std::vector<SoftLanes::Walk> walks_;
  std::vector<bool> lost_;
};

}  // namespace carom
