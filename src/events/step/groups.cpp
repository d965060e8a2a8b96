#include "events/step/groups.hpp"

#include <algorithm>
#include <cmath>

#include "events/step/group_hit.hpp"
#include "events/step/surroundings.hpp"
#include "motion/free_motion.hpp"

namespace carom::events {

using geometry::Vector;

Groups::Groups(const Table& table, const Dynamics& dynamics, const ForceRegions& regions,
               FreeFlights& flights, Bodies& bodies, base::Interrupt& interrupt)
    : regions_(regions),
      bodies_(bodies),
      interrupt_(interrupt),
      energies_(bodies, regions.interact()) {
  if (!regions.any()) return;
  surroundings_.interrupt = &interrupt;
  surroundings_.forces =
      dynamics.forces && !dynamics.forces->empty() ? dynamics.forces.get() : nullptr;
  surroundings_.plan = dynamics.integrator;
  if (surroundings_.forces)
    surroundings_.maps = std::make_shared<forces::ForceMaps>(*surroundings_.forces);
  surroundings_.counts = &steps_;
  if (table.lattice) {
    surroundings_.lattice = &*table.lattice;
    surroundings_.centre = centre_of_cell(*table.lattice);
  }
  if (!flights.pieces().table.walls.empty()) surroundings_.longest_way = longest_way(table);
  surroundings_.barriers = barriers_of(table);
  surroundings_.supports = regions.edges();
  surroundings_.barriers.insert(surroundings_.barriers.end(), regions.edges().begin(),
                                regions.edges().end());
  if (table.extent == Extent::bounded)
    surroundings_.inside = [this, &flights](Vector x) {
      return on_some_wall(surroundings_.barriers, regions_.wall_count(), x) || flights.contains(x);
    };
}

void Groups::clear() {
  steps_ = {};
  energies_.clear();
  idle_.clear();
  for (const auto& group : groups_) idle_.push_back(group.get());
}

void Groups::form(const std::vector<int>& members) {
  std::vector<Particle> particles;
  for (const int i : members) particles.push_back(bodies_[i].particle);
  if (idle_.empty()) {
    groups_.push_back(std::make_unique<Group>(surroundings_));
    idle_.push_back(groups_.back().get());
  }
  Group& group = *idle_.back();
  idle_.pop_back();
  group.assign(members, std::move(particles));
  for (std::size_t k = 0; k < members.size(); ++k) {
    Body& b = bodies_[members[k]];
    group.set_state(k, b.state);
    b.group = &group;
    b.member = k;
    // At a hit a particle stays where the wall is until its step ends.
    if (b.state.wall < 0) group.fold(k);
    // One entry a group: its first member's.
    bodies_.schedule(members[k], never, EventKind::group);
  }
  group.set_time(bodies_[members.front()].state.time);
  // Of a run that goes on. Groups within a range may not be the ones that they were.
  const double last = energies_.balance(members.front()).last;
  if (!regions_.by_range() && !std::isnan(last)) group.set_last_energy(last);
  predict(group);
}

void Groups::take_out(int body) {
  Body& b = bodies_[body];
  Group& group = *b.group;
  b.state = group.state(b.member);
  b.group = nullptr;
  group.remove(b.member);
  energies_.forget_last(body);
  for (std::size_t k = b.member; k < group.bodies().size(); ++k)
    bodies_[group.bodies()[k]].member = k;
  if (group.bodies().empty()) idle_.push_back(&group);
}

void Groups::predict(Group& group) {
  Time until = never;
  // A particle that is still to come may be near.
  if (regions_.interact())
    for (int i = 0; i < bodies_.size(); ++i) {
      const Body& b = bodies_[i];
      if (!b.finished && b.group == nullptr && b.state.time > group.time())
        until = std::min(until, b.state.time);
    }
  energies_.before_step(group);
  if (surroundings_.remember_energy && !group.has_energy()) group.change_of_energy();
  group.predict(until);
  // What was computed before an interrupt came is worth nothing.
  if (interrupt_.stopped()) {
    unpredicted_ = true;
    group.drop_prediction();
  }
  bodies_.schedule(group.bodies().front(), group.next_time(), EventKind::group);
}

void Groups::predict_again() {
  if (!unpredicted_) return;
  unpredicted_ = false;
  for (int i = 0; i < bodies_.size() && !interrupt_.stopped(); ++i)
    if (Group* group = bodies_[i].group; group != nullptr && group->bodies().front() == i)
      predict(*group);
  unpredicted_ = interrupt_.stopped();
}

void Groups::advance(Group& group) {
  group.advance();
  if (surroundings_.remember_energy) energies_.after_step(group);
  if (group.next().member < 0 && !group.next().in_parts)
    for (std::size_t k = 0; k < group.bodies().size(); ++k) group.fold(k);
}

Group* Groups::ending_at(const Time& now) const {
  for (int i = 0; i < bodies_.size(); ++i) {
    Group* group = bodies_[i].group;
    if (group != nullptr && group->time() < now && group->next_time() == now) return group;
  }
  return nullptr;
}

StepsUnderWay Groups::under_way() const {
  StepsUnderWay steps{0, !unpredicted_};
  for (const auto& group : groups_)
    if (!group->bodies().empty()) steps.evaluations += group->evaluations_under_way();
  return steps;
}

State Groups::state_at(int body, const Time& t) const {
  const Body& b = bodies_[body];
  return b.group ? b.group->state_at(b.member, t) : motion::flown(b.state, b.particle.omega, t);
}

bool Groups::fails_before(int body, const Time& t) const {
  const Group* group = bodies_[body].group;
  return group != nullptr && !group->next().fault.empty() && group->time() < t;
}

}  // namespace carom::events
