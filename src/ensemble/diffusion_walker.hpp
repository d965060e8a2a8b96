// Trajectories of a diffusion run, one after the other.
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "carom/ensemble/sampler.hpp"
#include "carom/events/world.hpp"
#include "ensemble/diffusion_tally.hpp"

namespace carom {

inline double square_of_displacement(const System& system, const State& start, const State& now) {
  geometry::Vector displacement = now.position - start.position;
  if (system.table->lattice)
    displacement = displacement + system.table->lattice->translation({now.cell.first - start.cell.first,
                                                                      now.cell.second - start.cell.second});
  return dot(displacement, displacement);
}

/// Runs trajectories one by one in one thread and listens to their samples.
class DiffusionWalker : public Observer {
 public:
  DiffusionWalker(const System& system, const Sampler& sampler, DecisionOptions decisions, DiffusionTally tally)
      : tally_(tally),
        system_(system),
        sampler_(sampler),
        world_(*system.table, system.dynamics, decisions),
        energies_(system),
        starts_(system.particles.size()),
        squares_(system.particles.size()),
        ends_(system.particles.size()) {
    if (system.run.collisions > 0) world_.limit_hits(system.run.collisions);
    world_.sample_at(system.run.times);
  }

  /// False when stopped on the way.
  bool run(TrajectoryRange range) {
    const std::function<bool()> stopped = [this] { return tally_.stopped(); };
    for (std::uint64_t trajectory = range.first; trajectory < range.last; ++trajectory) {
      if (stopped()) return false;
      const int particles = static_cast<int>(system_.particles.size());
      world_.clear();
      add_starts(world_, sampler_, trajectory);
      for (int p = 0; p < particles; ++p) {
        starts_[index(p)] = world_.state(p);
        squares_[index(p)].clear();
        ends_[index(p)] = {Fate::survived, system_.run.times.back()};
      }
      energies_.begin(starts_);
      sampled_.clear();
      world_.run_until(system_.run.times.back(), *this, stopped);
      if (stopped()) return false;
      std::vector<SampledEnergies::End> ends;
      for (int p = 0; p < particles; ++p) ends.push_back({world_.state(p), ends_[index(p)].fate, world_.energy_balance(p).kinetic});
      const DecisionCounts now = world_.decisions();
      tally_.add(trajectory, all_of(trajectory), energies_.end(ends), world_.step_counts(), now - std::exchange(decisions_, now));
    }
    return true;
  }

  void sample(int particle, Time, const State& state) override {
    squares_[index(particle)].push_back(square_of_displacement(system_, starts_[index(particle)], state));
    energies_.sample(index(particle), state);
    sampled_.push_back(state);
  }
  void sampled(Time) override {
    energies_.sample(sampled_);
    sampled_.clear();
  }

  void end(const EndEvent& event) override {
    if (event.fate == Fate::survived || event.fate == Fate::pinned)
      ends_[index(event.particle)].fate = event.fate;
    else
      ends_[index(event.particle)] = {event.fate, event.time.value()};
  }

  const World& world() const { return world_; }

 private:
  struct End {
    Fate fate = Fate::survived;
    double time = 0.0;
  };
  static std::size_t index(int particle) { return static_cast<std::size_t>(particle); }

  std::vector<DiffusingParticle> all_of(std::uint64_t trajectory) const {
    std::vector<DiffusingParticle> all;
    for (int p = 0; p < world_.size(); ++p) {
      const End& end = ends_[index(p)];
      const std::uint64_t number = trajectory * system_.particles.size() + static_cast<std::uint64_t>(p);
      all.push_back({number, end.fate, end.time, world_.hits(p), world_.last_wall(p), world_.state(p), &squares_[index(p)],
                     is_failure(end.fate) ? world_.report(p) : std::string()});
    }
    return all;
  }

  DiffusionTally tally_;
  const System& system_;
  const Sampler& sampler_;
  World world_;
  SampledEnergies energies_;
  std::vector<State> starts_;
  std::vector<State> sampled_;  // at the time of the sample under way
  std::vector<std::vector<double>> squares_;  // of the trajectory under way
  std::vector<End> ends_;
  DecisionCounts decisions_;  // that were told
};

}  // namespace carom
