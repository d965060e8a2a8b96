// The way of stepping in time: drift with a fixed step (a rotation of the velocity with a field),
// and turn back at a wall when the step has left the table. Short and plain on purpose: it is what
// the event engine is compared with, in speed only.
#pragma once

#include <cmath>
#include <cstdint>

namespace carom::bench {

/// A table as a function that is positive inside, with its gradient.
struct Level {
  double value, gx, gy;
};

inline Level square(double x, double y) {
  const double d[4] = {x, 1 - x, y, 1 - y};
  int nearest = 0;
  for (int i = 1; i < 4; ++i)
    if (d[i] < d[nearest]) nearest = i;
  return {d[nearest],
          nearest == 0   ? 1.0
          : nearest == 1 ? -1.0
                         : 0.0,
          nearest == 2   ? 1.0
          : nearest == 3 ? -1.0
                         : 0.0};
}
inline Level stadium(double x, double y) {
  const double e = x < -1 ? x + 1 : x > 1 ? x - 1 : 0.0;
  return {1 - e * e - y * y, -2 * e, -2 * y};
}
inline Level ellipse(double x, double y) {
  return {1 - x * x - y * y / 0.5625, -2 * x, -2 * y / 0.5625};
}

struct StepResult {
  std::uint64_t hits = 0, steps = 0;
  double checksum = 0.0;  ///< so that nothing is optimised away
};

template <class Table>
StepResult step_in_time(Table table, double omega, double step, std::uint64_t hits) {
  double x = 0.3, y = 0.4, vx = 0.6, vy = 0.8;
  const double c = std::cos(omega * step), s = std::sin(omega * step);
  StepResult result;
  while (result.hits < hits) {
    const double nx = x + step * vx, ny = y + step * vy;
    const Level level = table(nx, ny);
    ++result.steps;
    if (level.value > 0) {
      x = nx;
      y = ny;
      const double rotated = c * vx + s * vy;
      vy = c * vy - s * vx;
      vx = rotated;
      continue;
    }
    const double twice =
        2 * (vx * level.gx + vy * level.gy) / (level.gx * level.gx + level.gy * level.gy);
    vx -= twice * level.gx;
    vy -= twice * level.gy;
    ++result.hits;
  }
  result.checksum = x + y + vx + vy;
  return result;
}

}  // namespace carom::bench
