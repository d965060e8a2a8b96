// Deviations under forces against differences of the engine's own orbits, hits included.
#include "ensemble/force_tangent.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "carom/ensemble/trajectories.hpp"
#include "carom/events/world.hpp"
#include "systems.hpp"

namespace carom {

using namespace ensemble;

namespace {

const char* const forces[] = {
    // Forces at straight walls, with and without a field.
    R"toml([table]
shape = "rectangle"
width = 1
height = 1
[[potential]]
kind = "linear"
force = [0.3, -1.1]
[[potential]]
kind = "expression"
expression = "x*y^2 + sin(2*x)"
)toml",
    R"toml([table]
shape = "rectangle"
width = 1
height = 1
[field]
B = 0.8
[[potential]]
kind = "gaussian"
height = 0.4
width = 0.3
center = [0.4, 0.55]
)toml",
    // A bent wall, and several particles that feel each other.
    R"toml([table]
shape = "ellipse"
a = 1.2
b = 0.9
[particles]
count = 3
mass = [1, 2, 1.5]
[interaction]
kind = "coulomb"
strength = 0.2
[[potential]]
kind = "harmonic"
omega = 0.7
)toml"};

System system_of(const char* text) {
  return make_system(std::string(text) +
                     "[integrator]\nstep = 0.01\n"
                     "[run]\nt_max = 3\ntrajectories = 1\n");
}

std::vector<State> states_of(const System& system) {
  const geometry::Vector places[] = {{0.31, 0.42}, {-0.4, 0.1}, {0.2, -0.5}},
                         velocities[] = {{0.9, 0.5}, {-0.3, 0.8}, {0.6, 0.2}};
  std::vector<State> states(system.particles.size());
  for (std::size_t p = 0; p < states.size(); ++p) {
    states[p].position = places[p];
    states[p].velocity = velocities[p];
  }
  return states;
}

struct Follow : Observer {
  void hit(const HitEvent& e) override {
    ++hits;
    if (!tangent) return;
    tangent->fly_to(e.time, {});
    State state;
    state.wall = e.wall;
    state.u = e.u;
    state.position = e.position;
    state.velocity = e.after;
    state.time = e.time;
    tangent->hit(static_cast<std::size_t>(e.particle), state);
  }
  ForceTangent* tangent = nullptr;
  int hits = 0;
};

// The states at the end, sampled.
struct End : Follow {
  explicit End(std::size_t n) : states(n) {}
  void sample(int particle, Time, const State& state) override {
    states[static_cast<std::size_t>(particle)] = state;
  }
  std::vector<State> states;
};
End end_of(const System& system, const std::vector<State>& starts, double t,
           ForceTangent* tangent = nullptr) {
  World world(*system.table, system.dynamics);
  for (std::size_t p = 0; p < starts.size(); ++p) world.add(system.particles[p], starts[p]);
  world.sample_at({t});
  End end(starts.size());
  end.tangent = tangent;
  world.run_until(t, end);
  return end;
}

TEST(ForceTangent, IsTheDerivativeOfTheEngine) {
  for (const char* const text : forces) {
    const System system = system_of(text);
    const std::vector<State> starts = states_of(system);
    std::vector<std::size_t> all;
    for (std::size_t p = 0; p < starts.size(); ++p) all.push_back(p);
    ForceTangent tangent(system, all);
    tangent.begin(starts, 1.0);
    constexpr double h = 1e-6, t = 2.0;
    std::vector<State> more = starts, less = starts;
    for (std::size_t p = 0; p < starts.size(); ++p) {
      const Deviation d = tangent.direction(p);
      more[p].position = starts[p].position + h * d.position;
      more[p].velocity = starts[p].velocity + h * d.velocity;
      less[p].position = starts[p].position - h * d.position;
      less[p].velocity = starts[p].velocity - h * d.velocity;
    }
    const End middle = end_of(system, starts, t, &tangent), one = end_of(system, more, t),
              other = end_of(system, less, t);
    ASSERT_GT(middle.hits, 1) << text;
    ASSERT_EQ(one.hits, middle.hits);
    ASSERT_EQ(other.hits, middle.hits);
    tangent.fly_to(t, {});
    const double length = std::exp(tangent.logarithms()[0]);
    for (const std::size_t p : all) {
      const Deviation d = length * tangent.direction(p);
      const auto difference = [&](const geometry::Vector& a, const geometry::Vector& b) {
        return (0.5 / h) * (a - b);
      };
      const geometry::Vector x = difference(one.states[p].position, other.states[p].position),
                             v = difference(one.states[p].velocity, other.states[p].velocity);
      EXPECT_NEAR(d.position.x, x.x, 1e-6 * length) << text << p;
      EXPECT_NEAR(d.position.y, x.y, 1e-6 * length) << text << p;
      EXPECT_NEAR(d.velocity.x, v.x, 1e-6 * length) << text << p;
      EXPECT_NEAR(d.velocity.y, v.y, 1e-6 * length) << text << p;
    }
  }
}

}  // namespace
}  // namespace carom
