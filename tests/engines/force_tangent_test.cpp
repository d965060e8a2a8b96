// Deviations under forces against differences of the engine's own orbits, hits included.
#include "engines/force_tangent.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "engines/group_deviations.hpp"

namespace carom {

using namespace engines;

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

TEST(ForceTangent, IsTheDerivativeOfTheEngine) {
  for (const char* const text : forces) {
    SCOPED_TRACE(text);
    const System system = system_of(text);
    const std::vector<State> starts = states_of(system);
    std::vector<std::size_t> all;
    for (std::size_t p = 0; p < starts.size(); ++p) all.push_back(p);
    ForceTangent tangent(system, all);
    const tests::Followed run = tests::expect_derivative(system, starts, 2.0, tangent, 1e-6, 1e-6);
    EXPECT_GT(run.hits, 1);
  }
}

}  // namespace
}  // namespace carom
