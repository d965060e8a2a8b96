#include "orbits/boundary.hpp"

#include <algorithm>
#include <cmath>

#include "carom/geometry/hull.hpp"

namespace carom::orbits {

using geometry::Vector;

namespace {
double size_of(Vector v) { return std::max(std::abs(v.x), std::abs(v.y)); }
}  // namespace

Boundary::Boundary(const Table& of, const Particle& with) : table(&of), particle(with) {
  for (const Wall& wall : of.walls) {
    frames.push_back(geometry::frame_of(wall.curve));
    const geometry::Box box = geometry::bounding_box(wall.curve);
    size = std::max({size, size_of(box.low), size_of(box.high)});
  }
  if (of.lattice) size = std::max({size, size_of(of.lattice->first), size_of(of.lattice->second)});
}

WallPoint wall_point(const Boundary& boundary, int wall, double u) {
  const geometry::CurveFrame& frame = boundary.frames[static_cast<std::size_t>(wall)];
  return {geometry::point_at(frame, u), geometry::tangent_at(frame, u),
          geometry::normal_at(frame, u), geometry::curvature_at(frame, u)};
}

double moved_along(const Boundary& boundary, int wall, double u, double distance, bool& left_wall) {
  const geometry::CurveFrame& frame = boundary.frames[static_cast<std::size_t>(wall)];
  Vector point = geometry::point_at(frame, u) + distance * geometry::tangent_at(frame, u);
  if (frame.kind != geometry::CurveFrame::Kind::segment && !frame.bezier) {
    // Back to the conic along the ray from its centre, on which (X, Y) grows by the factor r.
    const Vector e = point - frame.origin;
    const double x = frame.start + dot(frame.along, e), y = dot(frame.across, e);
    const double r = std::sqrt(x * x + y * y);
    point = point - (1.0 - 1.0 / r) * (e + frame.start * frame.a);
  }
  const double moved = geometry::parameter_of(frame, point);
  const bool at_end = moved <= geometry::first_parameter || moved >= frame.last;
  left_wall = left_wall || (at_end && frame.kind != geometry::CurveFrame::Kind::closed);
  return moved;
}

}  // namespace carom::orbits
