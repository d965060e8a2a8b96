#include "orbits/boundary.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <variant>

namespace carom::orbits {

using geometry::Vector;

namespace {

double size_of(Vector v) { return std::max(std::abs(v.x), std::abs(v.y)); }

/// Does the wall go on smoothly where the one before it ends, both being pieces of curves?
bool continues(const Table& table, const Wall& wall) {
  const auto is_bezier = [](const Wall& w) {
    return std::holds_alternative<geometry::Bezier>(w.curve);
  };
  return is_bezier(wall) && wall.corner == 1 && is_bezier(table.wall(wall.previous));
}

/// Along the pieces of a Bézier curve. A curve without a joint is followed round once at most.
WallPlace along_pieces(const Boundary& boundary, WallPlace at, double distance, bool& left_wall) {
  const auto frame = [&](int wall) -> const geometry::CurveFrame& {
    return boundary.frames[static_cast<std::size_t>(wall)];
  };
  double s = geometry::arc_length_at(frame(at.wall), at.u) + distance;
  for (std::size_t n = 0; n < boundary.frames.size(); ++n) {
    const Wall& wall = boundary.table->wall(at.wall);
    const double length = geometry::length(frame(at.wall));
    if (s >= 0.0 && s <= length) break;
    const int next = s < 0.0 ? wall.previous : wall.next;
    if (boundary.curves[static_cast<std::size_t>(next)] !=
            boundary.curves[static_cast<std::size_t>(at.wall)] ||
        !continues(*boundary.table, s < 0.0 ? wall : boundary.table->wall(next))) {
      left_wall = true;
      break;
    }
    s += s < 0.0 ? geometry::length(frame(next)) : -length;
    at.wall = next;
  }
  const geometry::CurveFrame& last = frame(at.wall);
  at.u = geometry::parameter_at_length(last, std::clamp(s, 0.0, geometry::length(last)));
  at.u = std::clamp(at.u, geometry::first_parameter, last.last);
  return at;
}

}  // namespace

std::vector<int> smooth_curves(const Table& table) {
  std::vector<int> curves(table.walls.size());
  std::iota(curves.begin(), curves.end(), 0);
  // Pieces take the number of those before them; a loop may begin in the middle of a curve.
  for (int round = 0; round < 2; ++round)
    for (std::size_t w = 0; w < curves.size(); ++w)
      if (continues(table, table.walls[w]))
        curves[w] = std::min(curves[w], curves[static_cast<std::size_t>(table.walls[w].previous)]);
  return curves;
}

Boundary::Boundary(const Table& of, const Particle& with)
    : table(&of), particle(with), curves(smooth_curves(of)) {
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

WallPlace moved_along(const Boundary& boundary, WallPlace at, double distance, bool& left_wall) {
  const geometry::CurveFrame& frame = boundary.frames[static_cast<std::size_t>(at.wall)];
  if (frame.bezier) return along_pieces(boundary, at, distance, left_wall);
  Vector point = geometry::point_at(frame, at.u) + distance * geometry::tangent_at(frame, at.u);
  if (frame.kind != geometry::CurveFrame::Kind::segment) {
    // Back to the conic along the ray from its centre, on which (X, Y) grows by the factor r.
    const Vector e = point - frame.origin;
    const double x = frame.start + dot(frame.along, e), y = dot(frame.across, e);
    const double r = std::sqrt(x * x + y * y);
    point = point - (1.0 - 1.0 / r) * (e + frame.start * frame.a);
  }
  const double moved = geometry::parameter_of(frame, point);
  const bool at_end = moved <= geometry::first_parameter || moved >= frame.last;
  left_wall = left_wall || (at_end && frame.kind != geometry::CurveFrame::Kind::closed);
  return {at.wall, moved};
}

}  // namespace carom::orbits
