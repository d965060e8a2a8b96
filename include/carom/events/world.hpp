// The event loop: particles on a table from now until then.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "carom/events/decisions.hpp"
#include "carom/events/dynamics.hpp"
#include "carom/events/energy.hpp"
#include "carom/events/event.hpp"
#include "carom/events/observer.hpp"
#include "carom/events/step_counts.hpp"
#include "carom/events/surface.hpp"
#include "carom/motion/state.hpp"
#include "carom/table/table.hpp"

namespace carom::events {
struct PieceTable;
}  // namespace carom::events

namespace carom {

/// Particles on one table. Where nothing acts they fly exactly (straight or Larmor flights). Where
/// a force acts they are integrated, from the edge of its support on and back
/// (docs/physics/walls-in-steps.md).
class World {
 public:
  /// For free particles: no forces act. make_world(system) (engines/trajectories.hpp) makes the
  /// world of a System with its forces. Keeps a reference to the table, which must live as long.
  /// InputError: an arc is too flat.
  explicit World(const Table& table, DecisionOptions options = {});
  World(const Table& table, const Dynamics& dynamics, DecisionOptions options = {});
  explicit World(Table&&, DecisionOptions = {}) = delete;
  ~World();
  World(World&&) noexcept;
  /// A world of the same table, forces and decisions, without particles and with nothing set. It
  /// shares what was prepared of the table, so it is cheap; it may belong to another thread.
  World empty_copy() const;

  /// Adds a particle; returns its index. A state off the walls must lie in the domain, else
  /// std::invalid_argument. Its velocity is kept as it is. Without forces its length must be
  /// Particle::speed within 32 roundings (64u of its square), and that within the table's
  /// DecisionRange, else std::invalid_argument. `hits`: how many it has made before, when a stored
  /// trajectory goes on. A state of a later time than that of the loop is injected then. Hard discs
  /// (Particle::radius > 0): no disc may overlap another, else std::invalid_argument; the velocity
  /// may be of any length, and their positions and those of their hits are those of their centres.
  /// `speed`: what reflections keep of one that goes on (World::particle), whose velocity may
  /// differ from it by rounding; 0: under forces and of discs the length of the velocity.
  int add(const Particle& particle, const State& state, std::uint64_t hits = 0, double speed = 0.0);
  /// Removes all particles and sets the clock to 0; keeps the prepared table.
  void clear();

  /// Which random numbers walls that scatter draw: a hit of a particle is a function of the seed,
  /// the trajectory, the particle's number (`numbers`; else its index) and how many hits it has
  /// made. Until then those of trajectory 0 and seed 0.
  void scatter_by(std::uint64_t seed, std::uint64_t trajectory, std::vector<int> numbers = {});

  /// Most hits a particle may make (default: no limit).
  void limit_hits(std::uint64_t hits);
  /// Samples at the given increasing times (from the next run_until on).
  void sample_at(std::vector<double> times);
  /// Samples at k * interval, k = 0, 1, 2, …
  void sample_every(double interval);

  /// Reports every crossing of the surface from the next run_until on; it must live as long (null:
  /// none). `most`: of one flight; a pinned orbit would go on for ever.
  void watch(const Surface* surface, std::size_t most = SIZE_MAX);

  /// Asked before each event and after the last, in later runs too: true ends the run there. Cheap,
  /// or it costs more than the events; an interrupt belongs into run_until.
  void stop_when(std::function<bool()> enough);

  /// Runs until `t_end` or until no particle moves any more. `interrupted`, if set, is asked
  /// now and then between events; true returns early. Returns the number of events applied.
  std::uint64_t run_until(double t_end, Observer& observer,
                          const std::function<bool()>& interrupted = {});
  /// The same without an observer.
  std::uint64_t run_until(double t_end) {
    Observer none;
    return run_until(t_end, none);
  }

  int size() const;
  bool finished(int particle) const;             ///< has ended
  Fate fate(int particle) const;                 ///< survived while it has not ended
  State state(int particle) const;               ///< after its last event
  State state_at(int particle, Time t) const;    ///< from its last event on; after its end: there
  const Particle& particle(int particle) const;  ///< as it flies now, in its region
  std::uint64_t hits(int particle) const;
  int last_wall(int particle) const;  ///< -1 before the first hit
  int hole(int particle) const;       ///< -1 unless escaped
  const DecisionCounts& decisions() const;
  /// What integration has cost since the last clear().
  const StepCounts& step_counts() const;
  StepsUnderWay steps_under_way() const;

  /// From the next step on, energies are looked at after each one and at each hit. Else
  /// energy_balance knows nothing but kinetic ones.
  void watch_energy();
  /// The balance of a particle under forces; particles that interact have one together.
  const EnergyBalance& energy_balance(int particle) const;
  /// What was seen before, when a stored trajectory goes on.
  void set_energy_balance(int particle, const EnergyBalance& before);
  /// For `lost`, `unresolved` and `singular`: why, and the state that caused it
  /// (events/report.hpp).
  const std::string& report(int particle) const;

  /// Is the point strictly inside the domain (exact)? For lattices: in the free part of its cell.
  bool contains(geometry::Vector point) const;

  /// For engines: the walls as flights see them.
  const events::PieceTable& pieces() const;

 private:
  class Implementation;
  explicit World(std::unique_ptr<Implementation>);
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace carom
