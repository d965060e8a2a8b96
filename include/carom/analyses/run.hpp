// One trajectory followed closely: `carom run`.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "carom/analyses/run/state_error.hpp"
#include "carom/events/decisions.hpp"
#include "carom/events/energy.hpp"
#include "carom/events/observer.hpp"
#include "carom/events/step_counts.hpp"
#include "carom/system/system.hpp"
#include "carom/trust/trust.hpp"

namespace carom {

class World;

/// Everything that a particle's future depends on. A run continued from it repeats the
/// uninterrupted one bit for bit.
struct ParticleProgress {
  State state;         ///< after its last event: exact
  double speed = 0.0;  ///< what its reflections keep; the velocity may differ from it by rounding
  std::uint64_t hits = 0;
  std::uint64_t contacts = 0;  ///< with other hard discs
  std::int32_t last_wall = -1;
  std::int32_t hole = -1;
  Fate fate = Fate::survived;
  Time end;  ///< the clock: t_max, or when the trajectory ended
  Trust trust;
  /// Of the particle; of all together where they interact, by forces or by contacts.
  EnergyBalance energy;
};

/// What a run goes on from.
template <>
struct Fields<ParticleProgress> {
  using P = ParticleProgress;
  using Whole = std::int64_t;
  static constexpr std::tuple list{
      field_as<Whole>(
          "wall", "1", "Wall of the last event, -1: off the walls",
          [](auto& p) -> auto& { return p.state.wall; }),
      field_as<double>(
          "u", "1", "Exact parameter on that wall", [](auto& p) -> auto& { return p.state.u; }),
      field_as<double>(
          "x", "length", "Position in the cell",
          [](auto& p) -> auto& { return p.state.position.x; }),
      field_as<double>(
          "y", "length", "Position in the cell",
          [](auto& p) -> auto& { return p.state.position.y; }),
      field_as<double>(
          "vx", "length/time", "Velocity", [](auto& p) -> auto& { return p.state.velocity.x; }),
      field_as<double>(
          "vy", "length/time", "Velocity", [](auto& p) -> auto& { return p.state.velocity.y; }),
      field("speed", "length/time",
            "Speed that reflections conserve; the length of the velocity may differ by rounding",
            &P::speed),
      field_as<Whole>(
          "cell_first", "1", "Cell of the lattice",
          [](auto& p) -> auto& { return p.state.cell.first; }),
      field_as<Whole>(
          "cell_second", "1", "Cell of the lattice",
          [](auto& p) -> auto& { return p.state.cell.second; }),
      field_as<double>(
          "t_high", "time", "Time of the last event, leading double",
          [](auto& p) -> auto& { return p.state.time.high; }),
      field_as<double>(
          "t_low", "time", "Time of the last event, trailing double",
          [](auto& p) -> auto& { return p.state.time.low; }),
      field_as<double>(
          "end_high", "time", "Time of the end, leading double",
          [](auto& p) -> auto& { return p.end.high; }),
      field_as<double>(
          "end_low", "time", "Time of the end, trailing double",
          [](auto& p) -> auto& { return p.end.low; }),
      field_as<Whole>("hits", "1", "Reflections so far", &P::hits),
      field_as<Whole>("contacts", "1", "Contacts with other hard discs so far", &P::contacts),
      field_as<Whole>("last_wall", "1", "Wall of the last reflection, -1: none", &P::last_wall),
      field_as<Whole>("hole", "1", "Hole it escaped through, -1: none", &P::hole),
      field_as<double>(
          "energy_change", "energy", "Change of the energy since the start",
          [](auto& p) -> auto& { return p.energy.change; }),
      field_as<double>(
          "energy_largest", "energy", "Largest change seen",
          [](auto& p) -> auto& { return p.energy.largest; }),
      field_as<double>(
          "energy_kinetic", "energy", "Largest kinetic energy seen",
          [](auto& p) -> auto& { return p.energy.kinetic; }),
      field_as<double>(
          "energy_change_low", "energy", "Trailing double of energy_change",
          [](auto& p) -> auto& { return p.energy.change_low; }),
      field_as<double>(
          "energy_last", "energy", "Energy of its group after the latest step; NaN: not known",
          [](auto& p) -> auto& { return p.energy.last; }),
      field_as<Whole>("fate", "1", "Index into the attribute `names`", &P::fate)};
};

/// A particle at the end of a run, as people want to see it.
struct RunEnd {
  ParticleProgress progress;
  Trust trust;                                 ///< at the end: up to which collision and time
  double t = 0, x = 0, y = 0, vx = 0, vy = 0;  ///< unwrapped
  geometry::Cell cell;
  /// Relative to the largest kinetic energy seen, at every step and hit: of the particle, or of all
  /// that interact. Of these `end` is that of the last step if some are gone.
  EnergyError energy_error;
  std::string report;  ///< of lost, unresolved and singular ones (events/report.hpp)
};

/// Evaluations of the forces, from which a run that goes on counts.
struct Evaluations {
  std::uint64_t count = 0;
  bool predicted = false;  ///< those of the steps under way are among them
};

template <>
struct Fields<Evaluations> {
  static constexpr std::tuple list{
      field("evaluations_going_on", "1",
            "Evaluations from which a continued run counts, without those for states within "
            "unfinished steps",
            &Evaluations::count),
      field_as<std::uint64_t>(
          "predicted", "1",
          "1: those of the steps under way are among them; 0: an interrupt dropped them",
          &Evaluations::predicted)};
};

/// How to run one trajectory, and from where to go on.
struct SingleRunOptions {
  DecisionOptions decisions;
  std::vector<ParticleProgress> resume;  ///< empty: start afresh
  StepCounts steps;                      ///< of the part that is resumed
  Evaluations evaluations;               ///< of the part that is resumed
  double seconds = 0, cpu_seconds = 0;   ///< of that part
  std::function<bool()>
      interrupted;  ///< asked between events, and while starts are drawn: SamplingStopped
  std::function<void(const World&)> started;  ///< called once, when all starts are in the world
  /// Index: which start is drawn, also of the run that is resumed. None: it is not known any more.
  std::uint64_t trajectory = 0;
  /// Under forces: costs up to three times the run from its start (run/state_error.hpp).
  bool estimate_state_error = false;
  /// What the system's doubles were rounded from; null: they are what is meant.
  std::shared_ptr<const trust::WrittenSystem> written;
};

/// How one trajectory ended.
struct SingleRunResult {
  std::vector<RunEnd> particles;
  bool interrupted = false;
  std::uint64_t collisions = 0;
  std::uint64_t contacts = 0;             ///< of hard discs, each pair once
  StepCounts steps;                       ///< under forces
  Evaluations evaluations;                ///< under forces
  std::optional<StateError> state_error;  ///< under forces, where it is asked for
  std::string no_state_error;  ///< why it was asked for under forces and there is none; else ""
  DecisionCounts decisions;
  double seconds = 0, cpu_seconds = 0;  ///< of all parts
};

/// Of all its particles.
EnergyError energy_error_of(const SingleRunResult&);

/// Are rounding errors estimated (trust/trust.hpp)? Where motion is integrated or discs meet
/// they are not.
bool estimates_trust(const System&);

/// Follows the particles until t_max or their cap on hits. Samples every System::run.sample.
SingleRunResult run_single(const System&, Observer&, const SingleRunOptions& = {});

}  // namespace carom
