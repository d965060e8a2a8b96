#include "table/inset.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

#include "carom/base/error.hpp"
#include "carom/geometry/prepared_curve.hpp"
#include "table/loops.hpp"

namespace carom::table {

namespace {

using geometry::Circle;
using geometry::CircularArc;
using geometry::Curve;
using geometry::Segment;
using geometry::Vector;

InputError refused(const std::string& problem) {
  Place place;
  place.key = "interaction";
  return InputError(
      place, "hard discs on this table: " + problem,
      "no walls, or walls of segments and circular arcs that meet smoothly or in convex corners of "
      "segments, with room for the discs");
}

/// Where the joint between two walls moves.
Vector moved_joint(const Wall& before, const Wall& after, double radius) {
  const bool straight =
      std::holds_alternative<Segment>(before.curve) && std::holds_alternative<Segment>(after.curve);
  const Vector n = geometry::normal_at(before.curve, geometry::end_parameter(before.curve));
  const Vector m = geometry::normal_at(after.curve, 0.0);
  const Vector joint = geometry::start_point(after.curve);
  const double turn = geometry::cross(n, m), same = dot(n, m);
  if (straight && turn > 0.0) {
    // Both walls' lines moved by the radius meet here.
    const double share = radius / (1.0 + same);
    return joint + share * (n + m);
  }
  // A smooth joint is one to rounding: normals are unit vectors with some roundings each.
  if (!(same > 0.0 && std::fabs(turn) <= 16.0 * geometry::unit_roundoff))
    throw refused("walls '" + before.name + "' and '" + after.name +
                  "' meet in a corner where a disc would turn");
  return joint + radius * (std::holds_alternative<Segment>(before.curve) ? n : m);
}

Curve moved_wall(const Wall& wall, const Table& table, double radius) {
  if (const auto* circle = std::get_if<Circle>(&wall.curve)) {
    const double r = circle->radius + (circle->counterclockwise ? -radius : radius);
    if (!(r > 0.0))
      throw refused("a disc of radius " + std::to_string(radius) + " does not fit into '" +
                    wall.name + "'");
    return Circle{circle->centre, r, circle->counterclockwise};
  }
  const bool segment = std::holds_alternative<Segment>(wall.curve);
  if (!segment && !std::holds_alternative<CircularArc>(wall.curve))
    throw refused("the wall '" + wall.name +
                  "' is part of an ellipse, and the curve at a distance from it is none");
  const auto at = [&](int i) -> const Wall& { return table.walls[static_cast<std::size_t>(i)]; };
  const Vector from = moved_joint(at(wall.previous), wall, radius),
               to = moved_joint(wall, at(wall.next), radius);
  const Vector old = geometry::end_point(wall.curve) - geometry::start_point(wall.curve);
  if (!(dot(to - from, old) > 0.0))
    throw refused("a disc of radius " + std::to_string(radius) + " does not reach the wall '" +
                  wall.name + "'");
  if (segment) return Segment{from, to};
  CircularArc arc = std::get<CircularArc>(wall.curve);
  // The same centre, the same angle: the figure is only smaller or larger about the centre.
  arc.from = from;
  arc.to = to;
  return arc;
}

void check(const Table& table) {
  const auto faults = faults_of(table, 1);
  if (!faults.empty()) throw refused("seen by the centre of a disc, " + faults.front().sentence);
}

/// The parameter on the moved wall of the point above u.
double moved_parameter(const Wall& wall, const Curve& moved, double u, double radius) {
  if (!(u > 0.0)) return 0.0;
  if (u >= geometry::end_parameter(wall.curve)) return geometry::end_parameter(moved);
  if (!std::holds_alternative<Segment>(wall.curve)) return u;  // the same angle
  const Vector foot =
      geometry::point_at(wall.curve, u) + radius * geometry::normal_at(wall.curve, u);
  const Vector from = geometry::start_point(moved), along = geometry::end_point(moved) - from;
  return std::clamp(dot(foot - from, along) / dot(along, along), 0.0, 1.0);
}

}  // namespace

Table inset_table(const Table& table, double radius) {
  Table result = table;
  for (std::size_t i = 0; i < table.walls.size(); ++i)
    result.walls[i].curve = moved_wall(table.walls[i], table, radius);
  for (Hole& hole : result.holes) {
    const std::size_t w = static_cast<std::size_t>(hole.wall);
    hole.from = moved_parameter(table.walls[w], result.walls[w].curve, hole.from, radius);
    hole.to = moved_parameter(table.walls[w], result.walls[w].curve, hole.to, radius);
  }
  if (!result.walls.empty()) check(result);
  return result;
}

double touched_parameter(const Wall& wall, double u, Vector centre) {
  // Across from a segment; on an arc at the same angle.
  return std::holds_alternative<Segment>(wall.curve) ? geometry::parameter_of(wall.curve, centre)
                                                     : u;
}

}  // namespace carom::table
