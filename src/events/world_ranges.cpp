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

#include "forces/nearest_copy.hpp"
#include "events/world_implementation.hpp"

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

/// A free particle: forms a group with those free ones that are near, and knows when to look again.
void World::Implementation::look_around(int index, const Time& now) {
  Body& b = bodies[at(index)];
  const State here = state_at(b, now);
  const double speed = speed_of(here), step = dynamics.integrator.step;
  double free_for = std::numeric_limits<double>::infinity();
  std::vector<int> near = {index};
  for (int j = 0; j < static_cast<int>(bodies.size()); ++j) {
    const Body& other = bodies[at(j)];
    // Groups look around themselves, and so does a particle that is still to come.
    if (j == index || other.finished || other.group >= 0 || other.state.time > now) continue;
    if (std::find(waiting.begin(), waiting.end(), j) != waiting.end()) continue;
    const State there = state_at(other, now);
    const double gap = gap_between(b, here.position, other, there.position);
    const double closing = speed + speed_of(there);
    if (gap < acceleration_factor * closing * step)
      near.push_back(j);
    else
      free_for = std::min(free_for, gap / closing);
  }
  if (near.size() > 1) {
    std::sort(near.begin(), near.end());
    for (const int i : near) bodies[at(i)].state = state_at(bodies[at(i)], now);
    return form_group(near);
  }
  b.check = now + free_for;
  fly_on(index);
}

/// A group at the end of a step: takes in who is near, or falls apart. True if it has changed.
bool World::Implementation::regroup(Group& group, Observer& observer) {
  const Time now = group.time();
  const double step = dynamics.integrator.step;
  std::vector<int> members = group.bodies();
  bool grown = false;
  for (std::size_t m = 0; m < members.size(); ++m) {
    const Body& a = bodies[at(members[m])];
    for (int j = 0; j < static_cast<int>(bodies.size()); ++j) {
      const Body& other = bodies[at(j)];
      if (other.finished || other.state.time > now || std::find(members.begin(), members.end(), j) != members.end())
        continue;
      const State there = state_at(other, now);
      const double closing = speed_of(a.state) + speed_of(there);
      if (!(gap_between(a, a.state.position, other, there.position) < acceleration_factor * closing * step)) continue;
      if (other.group >= 0) {
        Group& theirs = *groups[at(other.group)];
        // Its step ends now, too.
        if (theirs.time() < now) {
          if (!(theirs.next_time() == now)) continue;
          apply_group(theirs.bodies().front(), observer);
          return group.bodies().empty() || regroup(group, observer);  // they may have taken us in
        }
        for (const int i : theirs.bodies()) members.push_back(i);
      } else {
        bodies[at(j)].state = there;
        members.push_back(j);
      }
      grown = true;
    }
  }
  if (!grown) return members.size() > 1 && split(members);
  std::sort(members.begin(), members.end());
  for (const int i : members)
    if (Body& b = bodies[at(i)]; b.group >= 0) take_out_of_group(i);
  form_group(members);
  return true;
}

/// Parts of a group that are far from each other go their own ways.
bool World::Implementation::split(const std::vector<int>& members) {
  const double step = dynamics.integrator.step;
  std::vector<std::size_t> part(members.size());
  std::iota(part.begin(), part.end(), std::size_t{0});
  for (std::size_t i = 0; i < members.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const Body &a = bodies[at(members[i])], &b = bodies[at(members[j])];
      const double closing = speed_of(a.state) + speed_of(b.state);
      if (!(gap_between(a, a.state.position, b, b.state.position) < 2.0 * acceleration_factor * closing * step)) continue;
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
    // On a wall to rounding a flight would not know its side: then the step after the next one asks again.
    if (together.size() > 1 || integrated_at(b.state.position) || !contains(b.state.position)) {
      form_group(together);
      continue;
    }
    b.particle.speed = speed_of(b.state);
    begin_free(b);
    fly(together.front());
    freed.push_back(together.front());
  }
  for (const int i : freed)
    if (bodies[at(i)].group < 0) look_around(i, now);
  return true;
}

}  // namespace carom
