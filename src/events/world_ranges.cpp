// Interactions of finite range: particles near each other form a group, others fly.
//
// Two free particles a distance d apart cannot come within the range R before (d - R)/(v_1 + v_2), for
// nothing makes a free particle faster: each looks around again then. A group looks around at the end of
// each of its steps, which all groups take at the same times. Whoever could come within the range during
// the next step is taken into a group beforehand: to integrate a pair beyond its range is as right as to
// leave it alone, since either errs by less than the tail's bound. A group falls apart where its members
// have twice that distance from each other.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "events/world_implementation.hpp"
#include "forces/nearest_copy.hpp"

namespace carom {

using geometry::Vector;

namespace {

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

double speed_of(const State& s) { return std::sqrt(dot(s.velocity, s.velocity)); }

/// How many times its present speed a particle of a group may have within the next step.
constexpr double acceleration_factor = 2.0;

}  // namespace

/// By how much two particles are farther apart than the range.
double World::Implementation::gap_between(const Body&, Vector x, const Body&, Vector y) const {
  Vector d = x - y;
  if (table.lattice) d = nearest_copy(d, *table.lattice);
  return std::sqrt(dot(d, d)) - dynamics.forces->pair_range();
}

/// Adds to `members`, which are at `now`, whoever could come within the range of one of them during the next
/// step, and again whoever is near those. `free_for`: how long the first has no free particle within its
/// range, if nobody was added. False if a group had to end its step first: then all may be different.
bool World::Implementation::gather(std::vector<int>& members, const Time& now, double& free_for,
                                   Observer& observer) {
  const double step = dynamics.integrator.step;
  std::vector<char> taken(bodies.size(), 0);
  for (const int i : members) taken[at(i)] = 1;
  free_for = std::numeric_limits<double>::infinity();
  for (std::size_t m = 0; m < members.size(); ++m) {
    const Body& a = bodies[at(members[m])];
    const State here = state_at(a, now);
    const double speed = speed_of(here);
    for (int j = 0; j < static_cast<int>(bodies.size()); ++j) {
      const Body& other = bodies[at(j)];
      // A particle that is still to come looks around itself.
      if (taken[at(j)] || other.finished || other.state.time > now) continue;
      if (other.group >= 0) {
        Group& theirs = *groups[at(other.group)];
        if (theirs.time() < now) {
          // Within its step a group is left alone: it looked around when that began.
          if (!(theirs.next_time() == now)) continue;
          apply_group(theirs.bodies().front(), observer);
          return false;
        }
        if (!theirs.between_steps()) continue;
      }
      const State there = state_at(other, now);
      const double gap = gap_between(a, here.position, other, there.position);
      const double closing = speed + speed_of(there);
      if (!(gap < acceleration_factor * closing * step)) {
        if (other.group < 0) free_for = std::min(free_for, gap / closing);
        continue;
      }
      const auto take = [&](int i) {
        taken[at(i)] = 1;
        members.push_back(i);
      };
      if (other.group < 0) {
        take(j);
      } else {
        for (const int i : groups[at(other.group)]->bodies()) take(i);
      }
    }
  }
  return true;
}

/// One group of all of these, which are at `now`.
void World::Implementation::join(std::vector<int> members, const Time& now) {
  std::sort(members.begin(), members.end());
  for (const int i : members) {
    Body& b = bodies[at(i)];
    if (b.group >= 0)
      take_out_of_group(i);
    else
      b.state = state_at(b, now);
  }
  form_group(std::move(members));
}

/// Those that a particle without a group is integrated with from now on, itself among them; nobody if it has
/// come into a group while others ended their steps.
std::vector<int> World::Implementation::company(int index, const Time& now, double& free_for,
                                                Observer& observer) {
  while (bodies[at(index)].group < 0) {
    std::vector<int> members = {index};
    if (!by_range || gather(members, now, free_for, observer)) return members;
  }
  return {};
}

/// A free particle: forms a group with those that are near, and knows when to look again.
void World::Implementation::look_around(int index, const Time& now, Observer& observer) {
  double free_for = 0.0;
  const std::vector<int> near = company(index, now, free_for, observer);
  if (near.empty()) return;
  if (near.size() > 1) return join(near, now);
  bodies[at(index)].check = now + free_for;
  fly_on(index);
}

/// A group at the end of a step: takes in who is near, or falls apart. True if it has changed.
bool World::Implementation::regroup(Group& group, Observer& observer) {
  const Time now = group.time();
  std::vector<int> members = group.bodies();
  const std::size_t before = members.size();
  double free_for = 0.0;
  // The others may have taken this group in.
  if (!gather(members, now, free_for, observer)) return group.bodies().empty() || regroup(group, observer);
  if (members.size() == before) return members.size() > 1 && split(members, observer);
  join(std::move(members), now);
  return true;
}

/// Parts of a group that are far from each other go their own ways.
bool World::Implementation::split(const std::vector<int>& members, Observer& observer) {
  const double step = dynamics.integrator.step;
  std::vector<std::size_t> part(members.size());
  std::iota(part.begin(), part.end(), std::size_t{0});
  for (std::size_t i = 0; i < members.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const Body &a = bodies[at(members[i])], &b = bodies[at(members[j])];
      const double closing = speed_of(a.state) + speed_of(b.state);
      if (!(gap_between(a, a.state.position, b, b.state.position) <
            2.0 * acceleration_factor * closing * step))
        continue;
      const std::size_t from = part[i], to = part[j];
      for (std::size_t& p : part)
        if (p == from) p = to;
    }
  if (std::all_of(part.begin(), part.end(), [&](std::size_t p) { return p == part[0]; })) return false;
  const Time now = bodies[at(members.front())].state.time;
  for (const int i : members) take_out_of_group(i);
  std::vector<int> freed;
  for (std::size_t p = 0; p < members.size(); ++p) {
    std::vector<int> together;
    for (std::size_t i = 0; i < members.size(); ++i)
      if (part[i] == p) together.push_back(members[i]);
    if (together.empty()) continue;
    Body& b = bodies[at(together.front())];
    // One that rests does not fly. On a wall to rounding a flight would not know its side: then the step after the next one asks again.
    const bool rests = b.state.velocity == Vector{};
    if (together.size() > 1 || rests || integrated_at(b.state.position) || !contains(b.state.position)) {
      form_group(together);
      continue;
    }
    set_free(together.front());
    freed.push_back(together.front());
  }
  for (const int i : freed)
    if (bodies[at(i)].group < 0) look_around(i, now, observer);
  return true;
}

}  // namespace carom
