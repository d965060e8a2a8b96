// The stated error of a reference beside kinks, against orbits in closed form.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "analyses/compare/setting.hpp"
#include "analyses/systems.hpp"

namespace carom::analyses {
namespace {

/// One coordinate under |x|: it falls to 0 with the acceleration -1 or 1, and on the other side
/// again. Between zeros it flies twice the speed there.
struct Coordinate {
  double x, v;
  Coordinate after(double t) const {
    const double side = x > 0.0 ? 1.0 : -1.0, fast = std::sqrt(v * v + 2.0 * std::fabs(x));
    const double first = side * v + fast;  // at 0
    if (t < first) return {x + t * (v - side * t / 2.0), v - side * t};
    t -= first;
    double sign = -side;
    for (; t > 2.0 * fast; t -= 2.0 * fast) sign = -sign;
    return {sign * t * (fast - t / 2.0), sign * (fast - t)};
  }
};

// Each halving moves the kinks to another place within their steps: changes may be small by chance,
// many times smaller than the error. The largest of all counts.
TEST(CompareBesideKinks, TheStatedErrorHolds) {
  const System system = make_system(R"toml(
[particles]
speed = 1
[initial]
kind = "rectangle"
min = [-0.3, -0.3]
max = [0.3, 0.3]
[[potential]]
kind = "expression"
expression = "abs(x) + abs(y)"
[integrator]
step = 0.1
)toml");
  const double t = 0.5;
  int beside_kinks = 0;
  for (std::uint64_t trajectory = 0; trajectory < 5; ++trajectory) {
    SCOPED_TRACE(trajectory);
    const Runs runs(system, trajectory, {});
    const Setting setting = setting_of(runs, t);
    const State& start = runs.starts().front();
    const Coordinate x{start.position.x, start.velocity.x}, y{start.position.y, start.velocity.y};
    StateDistance error;
    for (int k = 0; k < states_compared; ++k) {
      const double now = t * (states_compared + 1 + k) / (2 * states_compared);
      const Coordinate p = x.after(now), q = y.after(now);
      const PlaneState& state = setting.reference.states[static_cast<std::size_t>(k)].front();
      error.position =
          std::max(error.position, geometry::length(state.position - geometry::Vector{p.x, q.x}));
      error.velocity =
          std::max(error.velocity, geometry::length(state.velocity - geometry::Vector{p.v, q.v}));
    }
    EXPECT_LE(error.in(setting.units), setting.reference_error + 4e-15);
    EXPECT_LT(setting.reference_error, 1e-2);
    if (setting.reference_error > 1e-9) {
      ++beside_kinks;
      EXPECT_FALSE(setting.in_34_digits);
    }
  }
  EXPECT_GT(beside_kinks, 3);
}

}  // namespace
}  // namespace carom::analyses
