#include "carom/events/surface.hpp"

#include <cmath>

#include "carom/base/elementary.hpp"
#include "events/bracketed_root.hpp"
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

// A flight as it is seen from a surface.
class SeenFlight {
 public:
  SeenFlight(const Surface& surface, const FreeFlight& flight)
      : surface_(surface), flight_(flight) {}
  Point at(double time) const {
    const auto [position, velocity] =
        motion::moved(flight_.position, flight_.velocity, flight_.omega, time);
    return {time, surface_function(surface_, position, velocity), position, velocity};
  }
  static double time(const Point& p) { return p.time; }
  static double g(const Point& p) { return p.g; }
  double rate(const Point& p) const {
    return surface_rate(surface_, p.position, p.velocity,
                        flight_.omega * geometry::right(p.velocity));
  }

 private:
  const Surface& surface_;
  const FreeFlight& flight_;
};

// The phase in [0, pi) at which dg/dt = 0 for the first time, of a Larmor flight with phase |omega|
// t.
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
    case Surface::Kind::segment:
      return cross(s.to - s.from, position - s.from);
    case Surface::Kind::circle: {
      const Vector d = position - s.from;
      return dot(d, d) - s.radius * s.radius;
    }
    case Surface::Kind::position_x:
      return position.x - s.value;
    case Surface::Kind::position_y:
      return position.y - s.value;
    case Surface::Kind::velocity_x:
      return velocity.x - s.value;
    case Surface::Kind::velocity_y:
      break;
  }
  return velocity.y - s.value;
}

double surface_rate(const Surface& s, Vector position, Vector velocity, Vector acceleration) {
  switch (s.kind) {
    case Surface::Kind::line:
    case Surface::Kind::segment:
      return cross(s.to - s.from, velocity);
    case Surface::Kind::circle:
      return 2.0 * dot(position - s.from, velocity);
    case Surface::Kind::position_x:
      return velocity.x;
    case Surface::Kind::position_y:
      return velocity.y;
    case Surface::Kind::velocity_x:
      return acceleration.x;
    case Surface::Kind::velocity_y:
      break;
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

void crossings(const Surface& s, const FreeFlight& f, std::size_t most,
               std::vector<SurfaceCrossing>& found) {
  found.clear();
  const SeenFlight seen(s, f);
  Point before{0.0, surface_function(s, f.position, f.velocity), f.position, f.velocity};
  // Adds the crossing on a stretch on which g is monotone.
  const auto stretch = [&](const Point& after) {
    if ((before.g > 0.0) != (after.g > 0.0)) {
      const Point p = events::bracketed_root(seen, before, after);
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
      if (time > 0.0) stretch(seen.at(time));
    }
  } else if (s.kind == Surface::Kind::circle) {
    const double time = -dot(f.position - s.from, f.velocity) / dot(f.velocity, f.velocity);
    if (time > 0.0 && time < f.duration) stretch(seen.at(time));
  }
  if (found.size() >= most) return;
  Point last = seen.at(f.duration);
  last.position = f.end;
  last.g = surface_function(s, f.end, last.velocity);
  stretch(last);
}

}  // namespace carom
