// Trajectories of a diffusion run, one after the other.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "carom/ensemble/sampler.hpp"
#include "carom/events/energy.hpp"
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
      const bool forces = system_.dynamics.forces && !system_.dynamics.forces->empty();
      const double energy = forces ? energy_now() : 0.0;
      world_.run_until(system_.run.times.back(), *this, stopped);
      if (stopped()) return false;
      const double change = forces && everybody_is_left() ? std::fabs(energy_now() - energy) : 0.0;
      const DecisionCounts now = world_.decisions();
      tally_.add(trajectory, all_of(trajectory), change, now - std::exchange(decisions_, now));
    }
    return true;
  }

  void sample(int particle, Time, const State& state) override {
    squares_[index(particle)].push_back(square_of_displacement(system_, starts_[index(particle)], state));
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

  double energy_now() const {
    std::vector<State> states;
    for (int p = 0; p < world_.size(); ++p) states.push_back(world_.state(p));
    return energy_of(system_.particles, states, system_.dynamics, *system_.table).total();
  }
  bool everybody_is_left() const {
    return std::all_of(ends_.begin(), ends_.end(), [](const End& e) { return e.fate == Fate::survived; });
  }

  std::vector<DiffusingParticle> all_of(std::uint64_t trajectory) const {
    std::vector<DiffusingParticle> all;
    for (int p = 0; p < world_.size(); ++p) {
      const End& end = ends_[index(p)];
      const std::uint64_t number = trajectory * system_.particles.size() + static_cast<std::uint64_t>(p);
      all.push_back({number, end.fate, end.time, world_.hits(p), world_.last_wall(p), world_.state(p), &squares_[index(p)],
                     end.fate == Fate::lost ? world_.report(p) : std::string()});
    }
    return all;
  }

  DiffusionTally tally_;
  const System& system_;
  const Sampler& sampler_;
  World world_;
  std::vector<State> starts_;
  std::vector<std::vector<double>> squares_;  // of the trajectory under way
  std::vector<End> ends_;
  DecisionCounts decisions_;  // that were told
};

}  // namespace carom
