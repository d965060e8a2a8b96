#include "carom/events/surface.hpp"

#include <algorithm>
#include <cmath>

#include "carom/base/elementary.hpp"
#include "motion/free_motion.hpp"

namespace carom {

using geometry::Vector;

namespace {

constexpr double pi = 3.141592653589793;

struct Point {
  double time;
  double g;
  Vector position, velocity;
};

Point at(const Surface& s, const FreeFlight& f, double time) {
  const auto [position, velocity] = moved(f.position, f.velocity, f.omega, time);
  return {time, surface_function(s, position, velocity), position, velocity};
}

// Newton's method between two points with different signs, halving where it leaves them.
Point refined(const Surface& s, const FreeFlight& f, Point low, Point high) {
  const bool rising = high.g > 0.0;
  const double width = high.time - low.time;
  const auto nearer = [&] { return std::fabs(low.g) < std::fabs(high.g) ? low : high; };
  Point best = nearer();
  for (int i = 0; i < 200 && best.g != 0.0; ++i) {
    const double newton = best.g / surface_rate(s, best.position, best.velocity, f.omega * geometry::right(best.velocity));
    if (std::fabs(newton) <= 0x1p-52 * best.time) break;
    double time = best.time - newton;
    if (!(time > low.time && time < high.time)) time = low.time + 0.5 * (high.time - low.time);
    if (!(time > low.time && time < high.time)) break;
    const Point next = at(s, f, time);
    const bool better = std::fabs(next.g) < std::fabs(best.g);
    const double step = std::fabs(next.time - best.time);
    ((next.g > 0.0) == rising ? high : low) = next;
    best = better ? next : nearer();
    // A small step that does not improve has met the rounding of g.
    if (!better && step <= 1e-8 * width) break;
  }
  return best;
}

// The phase in [0, pi) at which dg/dt = 0 for the first time, of a Larmor flight with phase |omega| t.
double first_extreme(const Surface& s, const FreeFlight& f) {
  const Vector v = f.velocity, turned = (f.omega > 0.0 ? 1.0 : -1.0) * geometry::right(v);
  // dg/dt = a cos(phase) + b sin(phase): zero at the phase of (b, -a).
  double a = 0.0, b = 0.0;
  switch (s.kind) {
    case Surface::Kind::line:
    case Surface::Kind::segment:
      a = cross(s.to - s.from, v);
      b = cross(s.to - s.from, turned);
      break;
    case Surface::Kind::circle:
      a = dot(f.position - s.from, v);
      b = dot(f.position - s.from, turned) + dot(v, v) / std::fabs(f.omega);
      break;
    case Surface::Kind::position_x:
      a = v.x;
      b = turned.x;
      break;
    case Surface::Kind::position_y:
      a = v.y;
      b = turned.y;
      break;
    case Surface::Kind::velocity_x:
      a = turned.x;
      b = -v.x;
      break;
    case Surface::Kind::velocity_y:
      a = turned.y;
      b = -v.y;
      break;
  }
  double phase = elementary::atan2(-a, b);
  if (phase < 0.0) phase += pi;
  return phase < pi ? phase : 0.0;
}

}  // namespace

bool of_velocity(const Surface& s) {
  return s.kind == Surface::Kind::velocity_x || s.kind == Surface::Kind::velocity_y;
}

double surface_function(const Surface& s, Vector position, Vector velocity) {
  switch (s.kind) {
    case Surface::Kind::line:
    case Surface::Kind::segment: return cross(s.to - s.from, position - s.from);
    case Surface::Kind::circle: {
      const Vector d = position - s.from;
      return dot(d, d) - s.radius * s.radius;
    }
    case Surface::Kind::position_x: return position.x - s.value;
    case Surface::Kind::position_y: return position.y - s.value;
    case Surface::Kind::velocity_x: return velocity.x - s.value;
    case Surface::Kind::velocity_y: break;
  }
  return velocity.y - s.value;
}

double surface_rate(const Surface& s, Vector position, Vector velocity, Vector acceleration) {
  switch (s.kind) {
    case Surface::Kind::line:
    case Surface::Kind::segment: return cross(s.to - s.from, velocity);
    case Surface::Kind::circle: return 2.0 * dot(position - s.from, velocity);
    case Surface::Kind::position_x: return velocity.x;
    case Surface::Kind::position_y: return velocity.y;
    case Surface::Kind::velocity_x: return acceleration.x;
    case Surface::Kind::velocity_y: break;
  }
  return acceleration.y;
}

bool on_surface_part(const Surface& s, Vector position) {
  if (s.kind != Surface::Kind::segment) return true;
  const Vector along = s.to - s.from;
  const double part = dot(position - s.from, along);
  return part >= 0.0 && part < dot(along, along);
}

SurfaceCoordinates surface_coordinates(const Surface& s, Vector position, Vector velocity) {
  if (of_velocity(s)) return {};
  if (s.kind == Surface::Kind::position_x) return {position.y, velocity.y};
  if (s.kind == Surface::Kind::position_y) return {position.x, velocity.x};
  const Vector d = position - s.from;
  if (s.kind == Surface::Kind::circle) {
    double angle = elementary::atan2(d.y, d.x);
    if (angle < 0.0) angle += 2.0 * pi;
    return {s.radius * angle, cross(d, velocity) / s.radius};
  }
  const Vector along = s.to - s.from;
  const double length = std::sqrt(dot(along, along));
  return {dot(d, along) / length, dot(velocity, along) / length};
}

void crossings(const Surface& s, const FreeFlight& f, std::size_t most, std::vector<SurfaceCrossing>& found) {
  found.clear();
  Point before{0.0, surface_function(s, f.position, f.velocity), f.position, f.velocity};
  // Adds the crossing on a stretch on which g is monotone.
  const auto stretch = [&](const Point& after) {
    if ((before.g > 0.0) != (after.g > 0.0)) {
      const Point p = refined(s, f, before, after);
      if (on_surface_part(s, p.position))
        found.push_back({p.time, after.g > 0.0 ? 1 : -1, p.position, p.velocity});
    }
    before = after;
  };
  if (f.omega != 0.0) {
    // A whole turn without a crossing is followed by others.
    const auto in_vain = [&found](double extremes) { return extremes > 3.0 && found.empty(); };
    const double phase = first_extreme(s, f), per_time = 1.0 / std::fabs(f.omega);
    for (double k = 0.0; found.size() < most && !in_vain(k); k += 1.0) {
      const double time = (phase + k * pi) * per_time;
      if (!(time < f.duration)) break;
      if (time > 0.0) stretch(at(s, f, time));
    }
  } else if (s.kind == Surface::Kind::circle) {
    const double time = -dot(f.position - s.from, f.velocity) / dot(f.velocity, f.velocity);
    if (time > 0.0 && time < f.duration) stretch(at(s, f, time));
  }
  if (found.size() >= most) return;
  Point last = at(s, f, f.duration);
  last.position = f.end;
  last.g = surface_function(s, f.end, last.velocity);
  stretch(last);
}

}  // namespace carom
