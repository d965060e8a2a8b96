#include "motion/free_motion.hpp"

#include <cmath>
#include <tuple>

#include "carom/base/elementary.hpp"

namespace carom::motion {

using geometry::Vector;

geometry::EnergyShell<double> energy_shell(double speed) {
  const double square = speed * speed, weight = 0.5 / square;
  return {weight, std::fma(weight, square, -0.5)};
}

Vector reflected_at_corner(Vector v, Vector before, Vector after, int n) {
  if (n % 2 == 0) return -v;
  if (n == 1) return geometry::reflected(v, after, dot(after, after), 1.0, 0.0);
  for (int i = 0; i < n; ++i) {
    const Vector normal = i % 2 == 0 ? before : after;
    v = geometry::reflected(v, normal, dot(normal, normal), 1.0, 0.0);
  }
  return v;
}

std::pair<Vector, Vector> moved(Vector x, Vector v, double omega, double duration) {
  if (omega == 0.0) return {geometry::moved(x, duration, v), v};
  // The chord has length |v| sin(h t)/h along the velocity at half time, h = omega/2.
  const double h = 0.5 * omega;
  const auto [s, c] = elementary::sincos(h * duration);
  const Vector j = geometry::right(v);
  const Vector middle = c * v + s * j;
  const Vector turned = (c * c - s * s) * v + (2.0 * s * c) * j;
  return {x + (s / h) * middle, turned};
}

State flown(const State& last, double omega, Time t) {
  State now = last;
  const double duration = t - last.time;
  now.time = t;
  if (duration > 0.0) {
    std::tie(now.position, now.velocity) = moved(last.position, last.velocity, omega, duration);
    now.wall = -1;
  }
  return now;
}

}  // namespace carom::motion
