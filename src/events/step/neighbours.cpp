#include "events/step/neighbours.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/index.hpp"
#include "forces/nearest_copy.hpp"

namespace carom::events {

using geometry::Vector;

namespace {

using base::at;

double speed_of(const State& s) { return std::sqrt(dot(s.velocity, s.velocity)); }

/// How many times its present speed a particle of a group may have within the next step.
constexpr double acceleration_factor = 2.0;

}  // namespace

/// By how much two particles are farther apart than the range.
double Neighbours::gap(Vector x, Vector y) const {
  Vector d = x - y;
  if (table_.lattice) d = forces::nearest_copy(d, *table_.lattice);
  return std::sqrt(dot(d, d)) - dynamics_.forces->pair_range();
}

Neighbours::Found Neighbours::around(std::vector<int> members, const Time& now) const {
  Found found;
  std::vector<char> taken(at(bodies_.size()), 0);
  const auto take = [&](int i) {
    taken[at(i)] = 1;
    found.members.push_back(i);
  };
  for (const int i : members) take(i);
  for (std::size_t m = 0; m < found.members.size(); ++m) {
    const State here = groups_.state_at(found.members[m], now);
    const double speed = speed_of(here);
    for (int j = 0; j < bodies_.size(); ++j) {
      const Body& other = bodies_[j];
      if (taken[at(j)] || other.finished) continue;
      // Within its step a group is left alone: it looked around when that began. A particle that is
      // still to come looks around itself.
      if (other.group ? other.group->time() < now : other.state.time > now) continue;
      const State there = groups_.state_at(j, now);
      const double distance = gap(here.position, there.position);
      const double closing = speed + speed_of(there);
      if (!(distance < acceleration_factor * closing * dynamics_.integrator.step)) {
        if (other.group == nullptr) found.free_for = std::min(found.free_for, distance / closing);
      } else if (other.group == nullptr) {
        take(j);
      } else {
        for (const int i : other.group->bodies()) take(i);
      }
    }
  }
  return found;
}

std::vector<std::vector<int>> Neighbours::parts(const std::vector<int>& members) const {
  std::vector<std::size_t> part(members.size());
  std::iota(part.begin(), part.end(), std::size_t{0});
  for (std::size_t i = 0; i < members.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const State a = bodies_.state(members[i]), b = bodies_.state(members[j]);
      const double closing = speed_of(a) + speed_of(b);
      const double far = 2.0 * acceleration_factor * closing * dynamics_.integrator.step;
      if (!(gap(a.position, b.position) < far)) continue;
      const std::size_t from = part[i], to = part[j];
      for (std::size_t& p : part)
        if (p == from) p = to;
    }
  std::vector<std::vector<int>> parts;
  for (std::size_t p = 0; p < members.size(); ++p) {
    std::vector<int> together;
    for (std::size_t i = 0; i < members.size(); ++i)
      if (part[i] == p) together.push_back(members[i]);
    if (!together.empty()) parts.push_back(std::move(together));
  }
  return parts;
}

}  // namespace carom::events
