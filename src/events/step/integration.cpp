#include "events/step/integration.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "events/step/group_hit.hpp"

namespace carom::events {

using geometry::Cell;
using geometry::Vector;

Integration::Integration(const Table& table, const Dynamics& dynamics, const ForceRegions& regions,
                         Bodies& bodies, FreeFlights& flights, Groups& groups, SectionWatch& watch)
    : table_(table),
      regions_(regions),
      bodies_(bodies),
      flights_(flights),
      groups_(groups),
      watch_(watch),
      neighbours_(table, dynamics, bodies, groups) {}

void Integration::add(int index) {
  waiting_.push_back(index);
  bodies_.schedule(index, bodies_[index].state.time, EventKind::group);
}

void Integration::clear() {
  waiting_.clear();
  looking_.clear();
}

void Integration::apply(int index, Time now, Observer& observer) {
  if (Group* group = bodies_[index].group) {
    step(*group, observer);
  } else if (regions_.one_group()) {
    start(index, observer);
  } else {
    const bool waits = std::find(waiting_.begin(), waiting_.end(), index) != waiting_.end();
    looking_.push_back({nullptr, index, now, waits || bodies_.what(index) != EventKind::group});
  }
  settle(observer);
}

/// All particles are one group: one comes, with all others that wait for this time.
void Integration::start(int index, Observer& observer) {
  const Time now = bodies_[index].state.time;
  std::vector<int> members;
  int first = 0;
  while (first < bodies_.size() && bodies_[first].group == nullptr) ++first;
  if (first < bodies_.size()) {
    Group& group = *bodies_[first].group;
    // The step under way was cut to end now; without those that left the table in it, it is another
    // one.
    while (!group.bodies().empty() && group.time() < now) {
      step(group, observer);
      settle(observer);
    }
    members = group.bodies();
    while (!group.bodies().empty()) groups_.take_out(group.bodies().back());
  }
  for (const int i : waiting_)
    if (bodies_[i].state.time == now) members.push_back(i);
  std::sort(members.begin(), members.end());
  form(members);
}

void Integration::form(const std::vector<int>& members) {
  groups_.form(members);
  std::erase_if(waiting_, [&](int i) { return bodies_[i].group != nullptr; });
}

/// One group of all of these, which are at `now`.
void Integration::join(std::vector<int> members, const Time& now, Observer& observer) {
  std::sort(members.begin(), members.end());
  for (const int i : members) {
    if (bodies_[i].group != nullptr) {
      groups_.take_out(i);
      continue;
    }
    bodies_[i].state = groups_.state_at(i, now);
    if (watch_.active()) watch_.after_event(i, now, observer);  // its flight ends here
  }
  form(members);
}

/// Lets those look that look for neighbours. Where particles meet within a range, all groups end
/// the steps that end now first, for a group is not seen within its step. These groups look before
/// those that were to look, and may take them in.
void Integration::settle(Observer& observer) {
  while (!looking_.empty()) {
    const Looking looking = looking_.back();
    const bool taken_in =
        looking.group ? looking.group->bodies().empty() : bodies_[looking.body].group != nullptr;
    Group* ending = regions_.by_range() && !taken_in ? groups_.ending_at(looking.now) : nullptr;
    if (ending) {
      step(*ending, observer);
      continue;
    }
    looking_.pop_back();
    if (taken_in) continue;
    if (looking.group)
      end_step(*looking.group, observer);
    else
      look_around(looking, observer);
  }
}

/// A free body forms a group with those that are near, or knows when to look again.
void Integration::look_around(const Looking& looking, Observer& observer) {
  if (!regions_.by_range()) return join({looking.body}, looking.now, observer);
  Neighbours::Found near = neighbours_.around({looking.body}, looking.now);
  if (looking.integrated || near.members.size() > 1)
    return join(std::move(near.members), looking.now, observer);
  bodies_[looking.body].check = looking.now + near.free_for;
  flights_.schedule(looking.body);
}

/// A group at the end of a step goes on, if not in others or freely.
void Integration::end_step(Group& group, Observer& observer) {
  if (regions_.by_range() && regroup(group, observer)) return;
  if (leave_between_supports(group, observer)) return;
  groups_.predict(group);
}

/// Takes in what is near, or falls apart. True if the group has changed.
bool Integration::regroup(const Group& group, Observer& observer) {
  const std::size_t before = group.bodies().size();
  const Time now = group.time();
  Neighbours::Found near = neighbours_.around(group.bodies(), now);
  if (near.members.size() == before) return before > 1 && split(group, observer);
  join(std::move(near.members), now, observer);
  return true;
}

/// Parts of a group that are far from each other go their own ways.
bool Integration::split(const Group& group, Observer& observer) {
  const std::vector<int> members = group.bodies();
  const std::vector<std::vector<int>> parts = neighbours_.parts(members);
  if (parts.size() == 1) return false;
  const Time now = group.time();
  for (const int i : members) groups_.take_out(i);
  std::vector<Looking> freed;
  for (const std::vector<int>& part : parts) {
    const State& first = bodies_[part.front()].state;
    // One that rests does not fly. On a wall to rounding a flight would not know its side: then the
    // step after the next one asks again.
    if (part.size() > 1 || first.velocity == Vector{} || regions_.hold(first.position) ||
        !flights_.contains(first.position)) {
      form(part);
      continue;
    }
    set_free(part.front(), observer);
    freed.push_back({nullptr, part.front(), now, false});
  }
  looking_.insert(looking_.end(), freed.rbegin(), freed.rend());
  return true;
}

/// A lone particle that ends a step outside of all supports has crossed an edge where it could not
/// leave: along it to rounding, or where it meets another edge or a wall. True if it flies freely
/// from here on.
bool Integration::leave_between_supports(const Group& group, Observer& observer) {
  if (group.bodies().size() > 1 || regions_.edges().empty()) return false;
  const int index = group.bodies().front();
  const State s = bodies_.state(index);
  if (s.velocity == Vector{} || regions_.hold(s.position) || !flights_.contains(s.position))
    return false;
  groups_.take_out(index);
  set_free(index, observer);
  if (regions_.by_range()) looking_.push_back({nullptr, index, s.time, false});
  return true;
}

/// From its state on, which is inside the table and under no force.
void Integration::set_free(int index, Observer& observer) {
  Body& b = bodies_[index];
  b.particle.speed = std::sqrt(dot(b.state.velocity, b.state.velocity));
  flights_.begin(b);
  flights_.predict(index);
  if (watch_.active()) watch_.after_event(index, b.state.time, observer);  // its flight begins here
}

/// Applies what comes first for a group.
void Integration::step(Group& group, Observer& observer) {
  if (!group.next().fault.empty()) return give_up(group, observer);
  if (watch_.active()) watch_.watch_step(group, group.next_time(), observer);
  groups_.advance(group);
  const int member = group.next().member;
  if (member < 0) {
    const bool part = group.next().in_parts;
    observer.stepped(group.bodies().front(), group.time(), part);
    // Others are met at the ends of whole steps, which groups have in common.
    if (part) return groups_.predict(group);
    return looking_.push_back({&group, -1, group.time(), true});
  }
  const Barrier<double>& barrier = *group.next().barrier;
  if (!regions_.is_edge(barrier.wall)) {
    hit(group, static_cast<std::size_t>(member), barrier, observer);
    if (group.bodies().empty()) return;
  } else {
    if (leave_support(group, barrier, observer)) return;
    group.pass(barrier);
  }
  groups_.predict(group);
}

/// The step under way could not be made: its particles are lost where it begins, or the one that
/// has left the table is.
void Integration::give_up(Group& group, Observer& observer) {
  const Group::Next next = group.next();
  if (next.outside >= 0) {
    end(group.bodies()[static_cast<std::size_t>(next.outside)], Fate::unresolved, group, observer,
        next.fault);
    if (!group.bodies().empty()) groups_.predict(group);
    return;
  }
  while (!group.bodies().empty())
    end(group.bodies().front(), Fate::unresolved, group, observer, next.fault);
}

void Integration::end(int index, Fate fate, const Group& group, Observer& observer,
                      std::string_view why) {
  groups_.take_out(index);
  bodies_.end(index, fate, group.time(), observer, why);
}

/// A particle of a group is at a wall: it leaves through a hole or is reflected.
void Integration::hit(Group& group, std::size_t member, const Barrier<double>& barrier,
                      Observer& observer) {
  const int index = group.bodies()[member];
  Body& b = bodies_[index];
  const GroupHit hit = hit_of(flights_.pieces(), table_, group, member, barrier, flights_.counts());
  group.set_state(member, hit.state);
  if (hit.hole >= 0) {
    b.last_wall = barrier.wall;
    b.hole = hit.hole;
    return end(index, Fate::escaped, group, observer);
  }
  const HitEvent& event =
      bodies_.count_hit(index, b, hit.state, hit.before, group.time() - b.last_event, 1);
  b.last_event = group.time();
  if (!hit.inward) return end(index, Fate::singular, group, observer);
  observer.hit(event);
  if (bodies_.reaches_limit(b)) end(index, Fate::capped, group, observer);
}

/// A particle comes to the edge of a support from inside. True if it flies freely from here on.
bool Integration::leave_support(Group& group, const Barrier<double>& barrier, Observer& observer) {
  const int index = group.bodies().front();
  const State last = group.state(0);
  const Vector x = last.position, velocity = last.velocity;
  const geometry::PreparedCurve& curve = flights_.pieces().curve(barrier.wall);
  Cell cell = last.cell;
  cell.first += barrier.cell.first;
  cell.second += barrier.cell.second;
  const Vector own = table_.lattice ? x - table_.lattice->translation(barrier.cell) : x;
  const geometry::PreparedCurve::Frame frame = curve.settle(own);
  const Vector settled =
      table_.lattice ? frame.point + table_.lattice->translation(barrier.cell) : frame.point;
  // A wall that meets the edge comes first there: beyond it, or on it, there is no flight.
  if (group.supported(settled, &barrier) ||
      meets_some_wall(groups_.barriers(), regions_.wall_count(), x, settled))
    return false;
  const double u = curve.parameter(frame.point);
  if (flights_.pieces().inward(barrier.wall, u, velocity, frame.normal, flights_.counts()) !=
      Sign::positive)
    return false;
  groups_.take_out(index);
  Body& b = bodies_[index];
  b.state = {-1, 0.0, frame.point, velocity, cell, group.time()};
  flights_.begin_on_wall(b, barrier.wall, u);
  flights_.predict(index);
  if (watch_.active()) watch_.after_event(index, b.state.time, observer);
  if (regions_.by_range()) looking_.push_back({nullptr, index, b.state.time, false});
  return true;
}

bool Integration::end_failed_steps(Time t_end, Observer& observer) {
  bool others = false;
  for (int i = 0; i < bodies_.size(); ++i) {
    if (bodies_[i].finished || !groups_.fails_before(i, t_end)) continue;
    Group& group = *bodies_[i].group;
    give_up(group, observer);
    others = others || !group.bodies().empty();
  }
  return others;
}

void Integration::watch_steps(Time until, Observer& observer) {
  for (const auto& group : groups_.all())
    if (!group->bodies().empty() && group->time() < until)
      watch_.watch_step(*group, until, observer);
}

}  // namespace carom::events
