// The groups of a world: bodies that are integrated together.
#pragma once

#include <memory>
#include <vector>

#include "base/interrupt.hpp"
#include "carom/events/dynamics.hpp"
#include "carom/events/step_counts.hpp"
#include "events/bodies.hpp"
#include "events/flight/free_flights.hpp"
#include "events/step/energy_watch.hpp"
#include "events/step/force_regions.hpp"
#include "events/step/group.hpp"

namespace carom::events {

/// Forms groups, takes bodies out of them, and predicts and takes their steps. A group has one
/// entry in the queue, that of its first member. While a body is in a group, the group alone holds
/// its state.
class Groups {
 public:
  Groups(const Table& table, const Dynamics& dynamics, const ForceRegions& regions,
         FreeFlights& flights, Bodies& bodies, base::Interrupt& interrupt);
  Groups(const Groups&) = delete;
  Groups& operator=(const Groups&) = delete;
  void clear();

  /// Makes free bodies, which have the same time, a group, and predicts its first step.
  void form(const std::vector<int>& members);
  /// Takes a body out of its group, with its state; the group needs a prediction then.
  void take_out(int body);
  /// Predicts and schedules what comes first for the group.
  void predict(Group& group);
  /// Predicts what an interrupt has left unpredicted.
  void predict_again();
  /// Goes to what was predicted.
  void advance(Group& group);

  /// Groups that have members or have had some.
  const std::vector<std::unique_ptr<Group>>& all() const { return groups_; }
  /// A group whose step under way ends at that time, or null.
  Group* ending_at(const Time& now) const;
  /// A body's state between its last event and the next.
  State state_at(int body, const Time& t) const;
  /// Has the body's group failed to make a step that begins before that time? There are no states
  /// within it.
  bool fails_before(int body, const Time& t) const;

  /// Walls and edges of supports.
  const std::vector<Barrier<double>>& barriers() const { return surroundings_.barriers; }
  const StepCounts& steps() const { return steps_; }
  StepsUnderWay under_way() const;
  void watch_energy() { surroundings_.remember_energy = true; }
  EnergyWatch& energies() { return energies_; }
  const EnergyWatch& energies() const { return energies_; }

 private:
  const ForceRegions& regions_;
  Bodies& bodies_;
  base::Interrupt& interrupt_;
  StepCounts steps_;
  Group::Surroundings surroundings_;
  EnergyWatch energies_;
  std::vector<std::unique_ptr<Group>> groups_;
  std::vector<Group*> idle_;  ///< kept for the next body that comes under a force
  bool unpredicted_ = false;  ///< the last run was interrupted within a prediction
};

}  // namespace carom::events
