// Deviations of discs against differences of the engine's own orbits, over contacts and hits, and
// what a frame of them keeps.
#include "engines/free_group_tangent.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "engines/force_tangent.hpp"
#include "engines/group_deviations.hpp"

namespace carom {

using namespace engines;

namespace {

const char* const discs[] = {
    // Straight walls; unequal masses, and a field that turns them unequally.
    R"toml([table]
shape = "rectangle"
width = 1
height = 1.2
[particles]
count = 3
mass = [1, 2.5, 0.7]
charge = [1, -2, 0.5]
[field]
B = 0.8
[interaction]
kind = "hard-discs"
radius = 0.15
)toml",
    // A bent wall, whose centres meet another curvature.
    R"toml([table]
shape = "circle"
radius = 0.7
[particles]
count = 3
mass = [1, 3, 1]
[interaction]
kind = "hard-discs"
radius = 0.13
)toml"};

std::vector<State> states_of(const System& system, geometry::Vector middle) {
  const geometry::Vector places[] = {{0.31, 0.02}, {-0.25, 0.1}, {0.05, -0.33}},
                         velocities[] = {{-0.9, 0.5}, {0.7, 0.1}, {0.6, 0.7}};
  std::vector<State> states(system.particles.size());
  for (std::size_t p = 0; p < states.size(); ++p) {
    states[p].position = middle + places[p];
    states[p].velocity = velocities[p];
  }
  return states;
}

std::vector<State> starts_of(const System& system, const char* text) {
  return states_of(system, text == discs[0] ? geometry::Vector{0.5, 0.6} : geometry::Vector{});
}

TEST(FreeGroupTangent, IsTheDerivativeOfTheEngine) {
  for (const char* const text : discs) {
    SCOPED_TRACE(text);
    const System system = make_system(text);
    FreeGroupTangent tangent(system, {0, 1, 2}, Deviations::frame);
    const tests::Followed run =
        tests::expect_derivative(system, starts_of(system, text), 1.5, tangent, 1e-7, 1e-5);
    EXPECT_GT(run.contacts, 1);
    EXPECT_GT(run.hits, 2);
  }
}

// Areas of phase space are kept, so the growths of each pair of lengths are opposite at all times.
TEST(FreeGroupTangent, KeepsPairsOfLengths) {
  for (const char* const text : discs) {
    const System system = make_system(text);
    const std::vector<State> starts = starts_of(system, text);
    FreeGroupTangent tangent(system, {0, 1, 2}, Deviations::frame);
    tangent.begin(starts, 0.3);
    tests::followed(system, starts, 20.0, &tangent);
    tangent.fly_to(20.0, {});
    const auto lengths = tangent.logarithms();
    EXPECT_GT(lengths[0], 10.0);
    for (std::size_t i = 0; i < lengths.size(); ++i)
      EXPECT_NEAR(lengths[i] + lengths[lengths.size() - 1 - i], 0.0, 1e-9) << text << i;
  }
}

TEST(ForceTangent, KeepsPairsOfLengths) {
  for (const char* const table : {"ellipse\"\na = 1.2\nb = 0.9", "circle\"\nradius = 1.1"}) {
    const System system = make_system("[table]\nshape = \"" + std::string(table) + R"toml(
[particles]
count = 3
mass = [1, 2, 1.5]
[field]
B = 0.8
[interaction]
kind = "coulomb"
strength = 0.2
[[potential]]
kind = "gaussian"
height = 0.5
width = 0.4
[integrator]
step = 0.01
)toml");
    const std::vector<State> starts = states_of(system, {});
    ForceTangent tangent(system, {0, 1, 2}, Deviations::frame);
    tangent.begin(starts, 0.7);
    const tests::Followed end = tests::followed(system, starts, 5.0, &tangent);
    EXPECT_GT(end.hits, 3);
    tangent.fly_to(5.0, {});
    const auto lengths = tangent.logarithms();
    for (std::size_t i = 0; i < lengths.size(); ++i)
      EXPECT_NEAR(lengths[i] + lengths[lengths.size() - 1 - i], 0.0, 1e-9) << i;
  }
}

}  // namespace
}  // namespace carom
