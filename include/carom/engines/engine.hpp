// Engines fly trajectories, listeners learn of them: an analysis is a listener, and is written
// once.
//
//   starts ---> engine ---> listener
//
// Every engine makes the same orbits, bit for bit.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "carom/events/decisions.hpp"
#include "carom/events/energy.hpp"
#include "carom/events/event.hpp"
#include "carom/events/step_counts.hpp"
#include "carom/events/surface.hpp"
#include "carom/lanes/instruction_set.hpp"
#include "carom/lanes/lane_effort.hpp"
#include "carom/results/trajectory_ranges.hpp"
#include "carom/starts/injection.hpp"
#include "carom/starts/sampler.hpp"
#include "carom/system/system.hpp"

namespace carom {

/// One that is flown.
struct Trajectory {
  std::uint64_t number = 0;  ///< its index in the ensemble
  /// A small number that no other trajectory has while this one is under way: a listener may keep
  /// what it knows of it there.
  std::size_t slot = 0;
  std::vector<Particle> particles;  ///< those of the start first, then those that enter later
  std::vector<State> starts;  ///< one a particle; at the time of entry of those that enter later
};

/// How a particle ended.
struct ParticleEnd {
  Fate fate = Fate::survived;
  double time = 0.0;  ///< the last time of the run where it survived or is pinned
  State state;        ///< after the last event (EngineOptions::states)
  int hole = -1;      ///< a hole of the table, for `escaped`
  std::uint64_t hits = 0;
  int last_wall = -1;  ///< as World::last_wall
  std::string report;  ///< as World::report, of one that failed
  EnergyBalance
      energy;  ///< as World::energy_balance; except for EngineOptions::energy, kinetic ones alone
};

struct TrajectoryEnd {
  std::vector<ParticleEnd> particles;
  StepCounts steps;            ///< under forces
  std::uint64_t contacts = 0;  ///< of hard discs
};

/// Calls that an analysis gets: for one trajectory in the order of events, for several in any
/// order. Trajectories that are under way when the engine is stopped have no end.
class Listener {
 public:
  virtual ~Listener() = default;
  virtual void begin(const Trajectory&) {}
  /// The state after a hit, and how many the particle has made by then (EngineOptions::hits). A
  /// corner may count several.
  virtual void hit(const Trajectory&, int /*particle*/, const State&, std::uint64_t /*hits*/) {}
  /// The state (not its wall) at the time of that number (EngineOptions::times).
  virtual void sample(const Trajectory&, int /*particle*/, std::size_t /*number*/, const State&) {}
  /// Logarithms of the lengths of deviations at the time of that number, two or a frame, and the
  /// hits by then (EngineOptions::deviations, frame). No call after the last
  /// hit of a particle that leaves.
  virtual void stretched(const Trajectory&, int /*particle*/, std::size_t /*number*/,
                         std::span<const double> /*logarithms*/, std::uint64_t /*hits*/) {}
  /// As Observer::crossing (EngineOptions::surface).
  virtual void crossing(const Trajectory&, int /*particle*/, const State&, int /*direction*/) {}
  /// A particle has ended; others may go on.
  virtual void particle_end(const Trajectory&, int /*particle*/, Fate) {}
  /// Is the rest of the trajectory of no interest? Asked after hits and crossings; it then ends
  /// there.
  virtual bool stop(const Trajectory&) { return false; }
  virtual void end(const Trajectory&, const TrajectoryEnd&) = 0;
};

/// Where trajectories come from.
class Starts {
 public:
  virtual ~Starts() = default;
  /// Fills in all but the slot; false: there are no more. `world` tells which points lie in the
  /// domain.
  virtual bool next(Trajectory&, const World& world) = 0;
};

/// The trajectories of an ensemble, drawn one after the other.
class DrawnStarts : public Starts {
 public:
  /// Gives the next range of trajectories; false: there is none.
  using Blocks = std::function<bool(TrajectoryRange&)>;
  /// Refers to the sampler and its system.
  DrawnStarts(const Sampler&, Blocks);
  /// The trajectories of one range.
  DrawnStarts(const Sampler&, TrajectoryRange);
  bool next(Trajectory&, const World&) override;

 private:
  const Sampler& sampler_;
  const Injector injector_;
  Blocks blocks_;
  TrajectoryRange block_;
  std::vector<State> ahead_;  ///< drawn for single particles
  std::size_t given_ = 0;     ///< of these
};

/// What a listener asks for.
struct EngineOptions {
  double t_end = 0.0;
  std::vector<double> times = {};  ///< of samples, increasing, up to t_end
  bool hits = false;               ///< does it want hits?
  /// Times, increasing, at which it gets the lengths of deviations, and the length in which they
  /// are measured beside velocities over the speed; none: no deviations are followed.
  std::vector<double> deviations = {};
  double unit_length = 1.0;
  /// As many deviations as phase space has dimensions, orthogonal to each other: of all particles
  /// together where they act on each other, else of each.
  bool frame = false;
  const Surface* surface = nullptr;       ///< it gets the crossings of this
  std::size_t most_crossings = SIZE_MAX;  ///< of one flight
  bool energy = false;                    ///< as World::watch_energy
  bool states = true;  ///< does it look at those of starts and ends? Else free lanes leave them out
  DecisionOptions decisions = {};
  std::optional<InstructionSet> lanes = widest_instruction_set();  ///< empty: one after the other
  /// A world of the system, which the engines of all threads share what is prepared with; null:
  /// the engine prepares the table itself. Only looked at while the engine is made.
  const World* like = nullptr;
};

class Engine {
 public:
  virtual ~Engine() = default;
  /// Flies all trajectories from their starts until `t_end` or their end. False: `stopped`, asked
  /// now and then, said so.
  virtual bool run(Starts&, Listener&, const std::function<bool()>& stopped = {}) = 0;
  virtual DecisionCounts decisions() const = 0;
  virtual LaneEffort effort() const { return {}; }
};

/// The engine for a system: lanes of free particles, lanes of particles under forces, or a World
/// for one trajectory after the other. Refers to the system.
std::unique_ptr<Engine> make_engine(const System&, const EngineOptions&);
/// Why trajectories fly one after the other, as a phrase; "" where they fly in lanes.
std::string why_one_by_one(const System&, const EngineOptions& = {});

}  // namespace carom
