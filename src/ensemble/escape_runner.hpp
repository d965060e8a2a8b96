// Trajectories of an escape ensemble one by one, by the scalar engine.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "carom/ensemble/injection.hpp"
#include "carom/ensemble/sampler.hpp"
#include "carom/events/world.hpp"
#include "ensemble/energy_watch.hpp"
#include "ensemble/escape_tally.hpp"

namespace carom {

/// The ends of one trajectory's particles, and how often they touched.
class EscapeEnds : public Observer {
 public:
  void clear(int particles) {
    ends_.assign(static_cast<std::size_t>(particles), std::nullopt);
    contacts = 0;
  }
  void contact(const ContactEvent&) override { ++contacts; }
  void end(const EndEvent& event) override { ends_[static_cast<std::size_t>(event.particle)] = event; }
  const std::optional<EndEvent>& of(int particle) const { return ends_[static_cast<std::size_t>(particle)]; }
  std::uint64_t contacts = 0;

 private:
  std::vector<std::optional<EndEvent>> ends_;
};

/// Runs trajectories in one thread; the prepared table is kept from one to the next.
class EscapeRunner {
 public:
  EscapeRunner(const System& system, const Sampler& sampler, const Injector& injector, DecisionOptions decisions)
      : system_(system),
        sampler_(sampler),
        injector_(injector),
        holes_(hole_numbers(*system.table)),
        world_(*system.table, system.dynamics, decisions),
        energies_(system) {
    if (system.run.collisions > 0) world_.limit_hits(system.run.collisions);
  }

  /// Adds the trajectory to the tally; false when interrupted in the middle of it.
  bool run(std::uint64_t trajectory, EscapeTally& tally, std::vector<TrajectoryRecord>* records,
           const std::function<bool()>& interrupted) {
    world_.clear();
    add_starts(world_, sampler_, trajectory);
    if (!system_.injections.empty()) injector_.add(world_, trajectory);
    const int count = world_.size();
    ends_.clear(count);
    const std::size_t first_record = records ? records->size() : 0;
    for (int particle = 0; records && particle < count; ++particle)
      records->push_back(start_of(*system_.table, world_.state(particle)));
    const std::vector<Energy> before = energies();
    world_.run_until(system_.run.t_max, ends_, interrupted);
    if (interrupted && interrupted()) return false;
    note_energies(before, energies(), tally);
    tally.counts.contacts += ends_.contacts;
    tally.steps += world_.step_counts();
    for (int particle = 0; particle < count; ++particle) {
      const std::uint64_t index = particle_index(system_, trajectory, static_cast<std::uint64_t>(particle));
      TrajectoryRecord end = end_of(particle);
      end.index = index;
      tally.add(end, world_.last_wall(particle), world_.state(particle), world_.report(particle));
      if (!records) continue;
      TrajectoryRecord& record = (*records)[first_record + static_cast<std::size_t>(particle)];
      record.index = index;
      record.fate = end.fate;
      record.hole = end.hole;
      record.time = end.time;
      record.hits = end.hits;
    }
    return true;
  }

  const DecisionCounts& decisions() const { return world_.decisions(); }

 private:
  std::vector<Energy> energies() const {
    std::vector<Energy> all;
    for (int p = 0; energies_.of_each() && p < world_.size(); ++p)
      all.push_back(energies_.energy(world_.particle(p), world_.state(p)));
    if (!energies_.of_all()) return all;
    std::vector<State> states;
    for (int p = 0; p < world_.size(); ++p) states.push_back(world_.state(p));
    all.push_back(energies_.energy(states));
    return all;
  }
  // Of a particle that failed nothing is known; of particles that share their energy, all must be left.
  void note_energies(const std::vector<Energy>& before, const std::vector<Energy>& after, EscapeTally& tally) const {
    bool all = true;
    for (int p = 0; p < world_.size(); ++p) all = all && (!ends_.of(p) || ends_.of(p)->fate == Fate::survived);
    for (std::size_t k = 0; k < before.size(); ++k) {
      const int p = static_cast<int>(k);
      if (energies_.of_all() ? all : !failed(p))
        tally.energies.add(before[k].total(), after[k], 0.0, world_.energy_balance(p).kinetic);
    }
  }
  bool failed(int particle) const { return ends_.of(particle) && is_failure(ends_.of(particle)->fate); }

  // A particle that has not ended, or never can, survives until t_max.
  TrajectoryRecord end_of(int particle) const {
    TrajectoryRecord record;
    record.hits = world_.hits(particle);
    record.time = system_.run.t_max;
    const std::optional<EndEvent>& end = ends_.of(particle);
    if (!end) return record;
    record.fate = end->fate;
    if (end->hole >= 0) record.hole = holes_[static_cast<std::size_t>(end->hole)];
    if (end->fate != Fate::survived && end->fate != Fate::pinned) record.time = end->time.value();
    return record;
  }

  const System& system_;
  const Sampler& sampler_;
  const Injector& injector_;
  const std::vector<int> holes_;
  World world_;
  EnergyWatch energies_;
  EscapeEnds ends_;
};

}  // namespace carom
