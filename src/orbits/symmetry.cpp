#include "orbits/symmetry.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace carom::orbits {

using geometry::CurveFrame;
using geometry::Vector;

namespace {

// Points of a wall that tell where it lies; the first `ends` of them change their order when the
// wall is mirrored.
struct Shape {
  bool closed = false, circle = false;
  double length = 0.0;
  Vector middle;
  std::vector<Vector> marks;
};

Shape shape_of(const CurveFrame& frame) {
  Shape shape;
  shape.closed = frame.kind == CurveFrame::Kind::closed;
  shape.circle = shape.closed && frame.circular;
  shape.length = geometry::length(frame);
  shape.middle = frame.middle;
  if (shape.circle) return shape;
  if (shape.closed) {
    for (int quarter = 0; quarter < 4; ++quarter)
      shape.marks.push_back(geometry::point_at(frame, quarter));
    return shape;
  }
  // Start, middle by arc length, end.
  shape.middle =
      geometry::point_at(frame, geometry::parameter_at_length(frame, 0.5 * shape.length));
  shape.marks = {geometry::point_at(frame, 0.0), geometry::point_at(frame, frame.last)};
  return shape;
}

// Is `to` the image of `from`?
bool is_image(const Isometry& map, const Shape& from, const Shape& to, double error) {
  if (from.closed != to.closed || from.circle != to.circle) return false;
  if (std::abs(from.length - to.length) > 8.0 * error) return false;
  const auto near = [&](Vector a, Vector b) { return length(map(a) - b) <= error; };
  if (!near(from.middle, to.middle)) return false;
  if (from.closed)
    return std::all_of(from.marks.begin(), from.marks.end(), [&](Vector mark) {
      return std::any_of(to.marks.begin(), to.marks.end(),
                         [&](Vector image) { return near(mark, image); });
    });
  const bool turned = map.mirrors;
  return near(from.marks[0], to.marks[turned ? 1 : 0]) &&
         near(from.marks[1], to.marks[turned ? 0 : 1]);
}

bool maps_walls(Isometry& map, const std::vector<Shape>& shapes, double error) {
  map.walls.clear();
  for (const Shape& from : shapes) {
    int image = -1;
    for (std::size_t j = 0; j < shapes.size() && image < 0; ++j)
      if (is_image(map, from, shapes[j], error)) image = static_cast<int>(j);
    if (image < 0) return false;
    map.walls.push_back(image);
  }
  return true;
}

// The lattice's vector that lies at `image`, if one does.
bool cell_of(const geometry::Lattice& lattice, Vector image, double error, geometry::Cell& cell) {
  const double area = cross(lattice.first, lattice.second);
  const double a = std::nearbyint(cross(image, lattice.second) / area);
  const double b = std::nearbyint(cross(lattice.first, image) / area);
  cell = {static_cast<std::int64_t>(a), static_cast<std::int64_t>(b)};
  return length(image - lattice.translation(cell)) <= error;
}
bool maps_lattice(Isometry& map, const std::optional<geometry::Lattice>& lattice, double error) {
  if (!lattice) return true;
  return cell_of(*lattice, map(map.origin + lattice->first) - map.origin, error, map.first) &&
         cell_of(*lattice, map(map.origin + lattice->second) - map.origin, error, map.second);
}

bool is_new(const std::vector<Isometry>& known, const Isometry& map, Vector mark, double error) {
  return std::none_of(known.begin(), known.end(), [&](const Isometry& other) {
    return other.mirrors == map.mirrors && length(other(mark) - map(mark)) <= 4.0 * error;
  });
}

// Where marks lie, seen from their middle. On a lattice: the vectors to the cells around,
// which every symmetry maps onto each other.
std::vector<Vector> seen_from(const Boundary& boundary, Vector origin,
                              const std::vector<Vector>& marks) {
  std::vector<Vector> seen;
  if (!boundary.table->lattice) {
    for (const Vector mark : marks) seen.push_back(mark - origin);
  } else {
    for (const geometry::CellEdge& edge : boundary.table->lattice->edges)
      seen.push_back(boundary.table->lattice->translation(edge.beyond));
  }
  return seen;
}

}  // namespace

std::vector<Isometry> isometries(const Boundary& boundary) {
  Isometry identity;
  for (std::size_t i = 0; i < boundary.frames.size(); ++i)
    identity.walls.push_back(static_cast<int>(i));
  std::vector<Isometry> found{identity};
  if (boundary.frames.empty()) return found;
  std::vector<Shape> shapes;
  std::vector<Vector> marks;
  for (const CurveFrame& frame : boundary.frames) {
    shapes.push_back(shape_of(frame));
    const std::vector<Vector>& own = shapes.back().marks;
    marks.insert(marks.end(), own.begin(), own.end());
    marks.push_back(shapes.back().middle);
  }
  Vector origin;
  for (const Vector mark : marks)
    origin = origin + (1.0 / static_cast<double>(marks.size())) * mark;
  // Every mark errs by a few roundings of its coordinates, 12 u D (chain.hpp (1)), and so does its
  // image; the origin is their mean; turns and sums add 8 u D.
  const double error = 48.0 * unit_roundoff * boundary.size;
  const std::vector<Vector> seen = seen_from(boundary, origin, marks);
  const auto farther = [](Vector a, Vector b) { return length(a) < length(b); };
  const Vector mark = *std::max_element(seen.begin(), seen.end(), farther);
  const double radius = length(mark);
  if (radius <= error) return found;
  for (const Vector to : seen) {
    if (std::abs(length(to) - radius) > 2.0 * error) continue;
    for (const bool mirrors : {false, true}) {
      const Vector from = mirrors ? Vector{mark.x, -mark.y} : mark;
      const double both = length(from) * length(to);
      Isometry map{origin, dot(from, to) / both, cross(from, to) / both, mirrors, {}, {1, 0},
                   {0, 1}};
      if (is_new(found, map, origin + mark, error) && maps_walls(map, shapes, 2.0 * error) &&
          maps_lattice(map, boundary.table->lattice, 4.0 * error))
        found.push_back(std::move(map));
    }
  }
  return found;
}

std::vector<Match> matches(const Boundary& boundary, const std::vector<Isometry>& maps,
                           const PeriodicOrbit& one, const PeriodicOrbit& other) {
  std::vector<Match> found;
  const std::size_t n = one.hits.size();
  if (other.hits.size() != n || one.family != other.family) return found;
  if (std::abs(one.length - other.length) > one.length_error + other.length_error) return found;
  const bool field = boundary.particle.omega != 0.0;
  const double error = one.position_error + other.position_error +
                       96.0 * unit_roundoff * boundary.size;  // of both images (isometries)
  for (std::size_t m = 0; m < maps.size(); ++m) {
    for (const bool reversed : {false, true}) {
      if (field && reversed != maps[m].mirrors) continue;
      for (std::size_t shift = 0; shift < n; ++shift) {
        const auto same = [&](std::size_t i) {
          const std::size_t j = reversed ? (shift + n - i) % n : (shift + i) % n;
          const OrbitHit &a = one.hits[i], &b = other.hits[j];
          const int seen = maps[m].walls[static_cast<std::size_t>(a.wall)];
          if (boundary.curves[static_cast<std::size_t>(seen)] !=
              boundary.curves[static_cast<std::size_t>(b.wall)])
            return false;
          const geometry::Cell step = reversed ? other.hits[(j + n - 1) % n].step : b.step;
          const geometry::Cell image = maps[m](a.step);
          const std::int64_t sign = reversed ? -1 : 1;
          if (image.first != sign * step.first || image.second != sign * step.second) return false;
          if (one.family) return true;
          const double half = reversed ? other.half_turns[(j + n - 1) % n] : other.half_turns[j];
          return length(maps[m](a.position) - b.position) <= error &&
                 std::abs(one.half_turns[i] - half) <= error;
        };
        bool all = true;
        for (std::size_t i = 0; i < n && all; ++i) all = same(i);
        if (all) found.push_back({m, reversed, shift});
      }
    }
  }
  return found;
}

bool repeats(const PeriodicOrbit& orbit) {
  const std::size_t n = orbit.hits.size();
  const double error = 2.0 * orbit.position_error;
  for (std::size_t part = 1; part < n; ++part) {
    if (n % part != 0) continue;
    bool same = true;
    for (std::size_t i = 0; i < n && same; ++i) {
      const OrbitHit &a = orbit.hits[i], &b = orbit.hits[(i + part) % n];
      same = a.step == b.step && length(a.position - b.position) <= error &&
             std::abs(orbit.half_turns[i] - orbit.half_turns[(i + part) % n]) <= error;
    }
    if (same) return true;
  }
  return false;
}

}  // namespace carom::orbits
