// Deviations of a group, carried along by the engine's orbits and taken as their differences.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "analyses/systems.hpp"
#include "carom/events/world.hpp"
#include "engines/group_tangent.hpp"

namespace carom::tests {

/// A run, with deviations that go along if there are any.
struct Followed : Observer {
  Followed(engines::GroupTangent* all, std::size_t n) : tangent(all), states(n) {}
  void hit(const HitEvent& e) override {
    ++hits;
    if (!tangent) return;
    State state;
    state.wall = e.wall;
    state.u = e.u;
    state.position = e.position;
    state.velocity = e.after;
    state.time = e.time;
    tangent->arrive(static_cast<std::size_t>(e.particle), e.time, {});
    tangent->hit(static_cast<std::size_t>(e.particle), state);
  }
  void contact(const ContactEvent& e) override {
    ++contacts;
    if (!tangent) return;
    for (const int p : {e.first, e.second})
      tangent->arrive(static_cast<std::size_t>(p), e.time, {});
    tangent->contact(e);
  }
  void sample(int particle, Time, const State& state) override {
    states[static_cast<std::size_t>(particle)] = state;
  }
  engines::GroupTangent* tangent;
  std::vector<State> states;  ///< at the end
  int hits = 0, contacts = 0;
};

inline Followed followed(const System& system, const std::vector<State>& starts, double t,
                         engines::GroupTangent* tangent = nullptr) {
  World world(*system.table, system.dynamics);
  for (std::size_t p = 0; p < starts.size(); ++p) world.add(system.particles[p], starts[p]);
  world.sample_at({t});
  Followed end(tangent, starts.size());
  world.run_until(t, end);
  return end;
}

/// The longest deviation from the starts is the difference of orbits displaced by h of it both
/// ways, but for `error` of its length. Returns the run between them.
template <class Tangent>
Followed expect_derivative(const System& system, const std::vector<State>& starts, double t,
                           Tangent& tangent, double h, double error) {
  tangent.begin(starts, 1.0);
  std::vector<State> more = starts, less = starts;
  for (std::size_t p = 0; p < starts.size(); ++p) {
    const Deviation d = tangent.direction(p);
    more[p].position = starts[p].position + h * d.position;
    more[p].velocity = starts[p].velocity + h * d.velocity;
    less[p].position = starts[p].position - h * d.position;
    less[p].velocity = starts[p].velocity - h * d.velocity;
  }
  const Followed middle = followed(system, starts, t, &tangent), one = followed(system, more, t),
                 other = followed(system, less, t);
  for (const Followed* beside : {&one, &other}) {
    EXPECT_EQ(beside->hits, middle.hits);
    EXPECT_EQ(beside->contacts, middle.contacts);
  }
  tangent.fly_to(t, {});
  const double length = std::exp(tangent.logarithms()[0]);
  for (std::size_t p = 0; p < starts.size(); ++p) {
    const Deviation d = length * tangent.direction(p);
    const geometry::Vector x = (0.5 / h) * (one.states[p].position - other.states[p].position),
                           v = (0.5 / h) * (one.states[p].velocity - other.states[p].velocity);
    EXPECT_NEAR(d.position.x, x.x, error * length) << p;
    EXPECT_NEAR(d.position.y, x.y, error * length) << p;
    EXPECT_NEAR(d.velocity.x, v.x, error * length) << p;
    EXPECT_NEAR(d.velocity.y, v.y, error * length) << p;
  }
  return middle;
}

}  // namespace carom::tests
