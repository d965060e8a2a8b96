// Deviations of discs against differences of the engine's own orbits, over contacts and hits, and
// what a frame of them keeps.
#include "ensemble/free_group_tangent.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "carom/events/world.hpp"
#include "ensemble/force_tangent.hpp"
#include "systems.hpp"

namespace carom {

using namespace ensemble;

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

struct Follow : Observer {
  explicit Follow(GroupTangent* all, std::size_t n) : tangent(all), states(n) {}
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
  GroupTangent* tangent;
  std::vector<State> states;  ///< at the end
  int hits = 0, contacts = 0;
};
Follow end_of(const System& system, const std::vector<State>& starts, double t,
              GroupTangent* tangent = nullptr) {
  World world(*system.table, system.dynamics);
  for (std::size_t p = 0; p < starts.size(); ++p) world.add(system.particles[p], starts[p]);
  world.sample_at({t});
  Follow end(tangent, starts.size());
  world.run_until(t, end);
  return end;
}

TEST(FreeGroupTangent, IsTheDerivativeOfTheEngine) {
  for (const char* const text : discs) {
    const System system = make_system(text);
    const bool box = text == discs[0];
    const std::vector<State> starts =
        states_of(system, box ? geometry::Vector{0.5, 0.6} : geometry::Vector{});
    FreeGroupTangent tangent(system, {0, 1, 2}, Deviations::frame);
    tangent.begin(starts, 1.0);
    constexpr double h = 1e-7, t = 1.5;
    std::vector<State> more = starts, less = starts;
    for (std::size_t p = 0; p < starts.size(); ++p) {
      const Deviation d = tangent.direction(p);
      more[p].position = starts[p].position + h * d.position;
      more[p].velocity = starts[p].velocity + h * d.velocity;
      less[p].position = starts[p].position - h * d.position;
      less[p].velocity = starts[p].velocity - h * d.velocity;
    }
    const Follow middle = end_of(system, starts, t, &tangent), one = end_of(system, more, t),
                 other = end_of(system, less, t);
    ASSERT_GT(middle.contacts, 1) << text;
    ASSERT_GT(middle.hits, 2) << text;
    for (const Follow* beside : {&one, &other}) {
      ASSERT_EQ(beside->hits, middle.hits);
      ASSERT_EQ(beside->contacts, middle.contacts);
    }
    tangent.fly_to(t, {});
    const double length = std::exp(tangent.logarithms()[0]);
    for (std::size_t p = 0; p < starts.size(); ++p) {
      const Deviation d = length * tangent.direction(p);
      const geometry::Vector x = (0.5 / h) * (one.states[p].position - other.states[p].position),
                             v = (0.5 / h) * (one.states[p].velocity - other.states[p].velocity);
      EXPECT_NEAR(d.position.x, x.x, 1e-5 * length) << text << p;
      EXPECT_NEAR(d.position.y, x.y, 1e-5 * length) << text << p;
      EXPECT_NEAR(d.velocity.x, v.x, 1e-5 * length) << text << p;
      EXPECT_NEAR(d.velocity.y, v.y, 1e-5 * length) << text << p;
    }
  }
}

// Areas of phase space are kept, so the growths of each pair of lengths are opposite at all times.
TEST(FreeGroupTangent, KeepsPairsOfLengths) {
  for (const char* const text : discs) {
    const System system = make_system(text);
    const bool box = text == discs[0];
    const std::vector<State> starts =
        states_of(system, box ? geometry::Vector{0.5, 0.6} : geometry::Vector{});
    FreeGroupTangent tangent(system, {0, 1, 2}, Deviations::frame);
    tangent.begin(starts, 0.3);
    end_of(system, starts, 20.0, &tangent);
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
    const Follow end = end_of(system, starts, 5.0, &tangent);
    EXPECT_GT(end.hits, 3);
    tangent.fly_to(5.0, {});
    const auto lengths = tangent.logarithms();
    for (std::size_t i = 0; i < lengths.size(); ++i)
      EXPECT_NEAR(lengths[i] + lengths[lengths.size() - 1 - i], 0.0, 1e-9) << i;
  }
}

}  // namespace
}  // namespace carom
