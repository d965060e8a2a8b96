// Why Carom looks for walls within the steps: the simpler way, with the walls in the drifts of a
// scheme, heats. Velocity Verlet in an anisotropic well off the centre of a hard circle; a drift is
// a straight flight that is reflected, kicks come between.
//
//   walls_in_drifts        prints the root mean square of the energy's change;
//   docs/physics/walls-in-steps.md
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

#include "carom/events/world.hpp"
#include "carom/forces/force_field.hpp"
#include "carom/table/make.hpp"

namespace {

using namespace carom;
using geometry::Vector;

constexpr double radius = 0.5, omega_x = 1.14, omega_y = 0.8366;
constexpr Vector centre{0.21, -0.13};
constexpr int orbits = 16;

Vector force(Vector x) {
  return {-omega_x * omega_x * (x.x - centre.x), -omega_y * omega_y * (x.y - centre.y)};
}
double energy(Vector x, Vector v) {
  const Vector f = force(x), d = x - centre;
  return 0.5 * dot(v, v) - 0.5 * dot(f, d);
}

/// A flight among walls and nothing else.
void drift(Vector& x, Vector& v, double time) {
  for (;;) {
    // |x + v t| = radius
    const double vv = dot(v, v), xv = dot(x, v), rest = radius * radius - dot(x, x);
    const double hit = (std::sqrt(std::max(0.0, xv * xv + vv * rest)) - xv) / vv;
    if (!(hit < time)) break;
    x = x + hit * v;
    x = (radius / std::sqrt(dot(x, x))) * x;
    v = v - (2.0 * dot(v, x) / dot(x, x)) * x;
    time -= hit;
  }
  x = x + time * v;
}

double change_in_drifts(Vector x, Vector v, double step, double t_end) {
  const double before = energy(x, v);
  for (double t = 0.0; t < t_end; t += step) {
    v = v + 0.5 * step * force(x);
    drift(x, v, step);
    v = v + 0.5 * step * force(x);
  }
  return energy(x, v) - before;
}

double change_within_steps(Vector x, Vector v, double step, double t_end) {
  static const MadeTable circle = carom::circle(radius);
  PotentialSpec well;
  well.kind = PotentialSpec::Kind::harmonic;
  well.omega_x = omega_x;
  well.omega_y = omega_y;
  well.centers = {centre};
  Particle particle;
  Dynamics dynamics;
  dynamics.forces = ForceField::build({{well}, {}}, {particle}, std::nullopt);
  dynamics.integrator.scheme = "velocity-verlet";
  dynamics.integrator.step = step;
  World world(*circle.table, dynamics);
  State start;
  start.position = x;
  start.velocity = v;
  world.add(particle, start);
  world.run_until(t_end);
  const State end = world.state_at(0, Time(t_end));
  return energy(end.position, end.velocity) - energy(x, v);
}

template <class Change>
double spread(const Change& change, double step, double t_end) {
  double squares = 0.0;
  for (int k = 0; k < orbits; ++k) {
    const double d = change(Vector{0.125 - k / 64.0, 0.0625}, Vector{0.75, 0.5}, step, t_end);
    squares += d * d;
  }
  return std::sqrt(squares / orbits);
}

}  // namespace

int main() {
  std::printf("%8s %8s %16s %16s\n", "step", "time", "in the drifts", "within the steps");
  for (const double step : {1.0 / 16.0, 1.0 / 64.0})
    for (const double t_end : {64.0, 1024.0})
      std::printf("%8g %8g %16.2g %16.2g\n", step, t_end, spread(change_in_drifts, step, t_end),
                  spread(change_within_steps, step, t_end));
  std::printf("%8g %8g %16.2g\n", 1.0 / 16.0, 16384.0,
              spread(change_in_drifts, 1.0 / 16.0, 16384.0));
}
