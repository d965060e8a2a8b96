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
  SoftWalker(const System& system, const Sampler& sampler, InstructionSet set, DecisionOptions decisions,
             DiffusionTally tally)
      : system_(system),
        sampler_(sampler),
        world_(*system.table, decisions),
        lanes_(*system.table, system.dynamics, set, decisions),
        tally_(tally) {
    if (system.run.collisions > 0) lanes_.limit_hits(system.run.collisions);
  }

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
    for (std::size_t k = 0; k < count; ++k) starts_[k] = sampler_.draw_all(world_, first + k);
    squares_.assign(count * particles, {});
    ends_.assign(count, {});
    energies_.clear();
    for (std::size_t k = 0; k < count; ++k) energies_.emplace_back(system_).begin(starts_[k]);
    for (std::size_t p = 0; p < particles; ++p) {
      walks_.clear();
      for (std::size_t k = 0; k < count; ++k) walks_.push_back({starts_[k][p]});
      const auto sample = [&](std::size_t k, std::size_t, const State& state) {
        squares_[k * particles + p].push_back(square_of_displacement(system_, starts_[k][p], state));
        energies_[k].sample(p, state);
      };
      if (!lanes_.run(system_.particles[p], walks_, t_end, system_.run.times, sample, stopped)) return false;
      for (std::size_t k = 0; k < count; ++k) ends_[k].push_back(std::move(walks_[k]));
    }
    for (std::size_t k = 0; k < count; ++k) {
      std::vector<DiffusingParticle> all;
      std::vector<SampledEnergies::End> energies;
      StepCounts steps;
      for (std::size_t p = 0; p < particles; ++p) {
        SoftLanes::Walk& walk = ends_[k][p];
        const double time = walk.fate == Fate::survived ? t_end : walk.ended.value();
        all.push_back({(first + k) * particles + p, walk.fate, time, walk.hits, walk.last_wall, walk.state,
                       &squares_[k * particles + p], {}});
        energies.push_back({walk.state, walk.fate, walk.kinetic});
        steps += walk.steps;
        if (is_failure(walk.fate)) all.back().report = std::move(walk.report);
      }
      const DecisionCounts now = lanes_.decisions();
      tally_.add(first + k, all, energies_[k].end(energies), steps, now - std::exchange(decisions_, now));
    }
    return true;
  }

  const System& system_;
  const Sampler& sampler_;
  World world_;  ///< answers the sampler
  SoftLanes lanes_;
  DiffusionTally tally_;
  DecisionCounts decisions_;  ///< that were told
  std::vector<std::vector<State>> starts_;
  std::vector<SampledEnergies> energies_;
  std::vector<std::vector<SoftLanes::Walk>> ends_;
  std::vector<std::vector<double>> squares_;
  std::vector<SoftLanes::Walk> walks_;
};

}  // namespace carom
