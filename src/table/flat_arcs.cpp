// Walls on which a hit would be misplaced by more than a small part of how far an arc is bent, or
// of a radius or semi-axis.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "carom/geometry/curve_frame.hpp"
#include "table/flat_arcs.hpp"
#include "table/shapes.hpp"

namespace carom::table {
namespace shapes {
namespace {

using namespace geometry;

/// Largest distance of a hit from its arc, in units of the arc's sagitta.
constexpr double largest_share = 0x1p-16;

struct Flatness {
  double sagitta;  ///< of the arc as one of the unit circle of its metric
  double share;    ///< of it by which a hit may lie off the arc
};

/// docs/physics/exactness.md, Flat arcs.
Flatness flatness(const Curve& curve, double offset, bool counterclockwise) {
  constexpr double u = 0x1p-53;
  const CurveFrame frame = frame_of(curve);
  // The centre is `offset` chords from the chord, in the metric of the curve: on the arc's own side
  // if the arc is the larger part of the circle.
  const double away = 2.0 * (counterclockwise ? offset : -offset),
               half = std::sqrt(1.0 + away * away);
  const double sagitta = away > 0.0 ? 1.0 / (half * (half + away)) : 1.0 - away / half;
  const Box box = bounding_box(curve);
  double extent = std::max(std::fabs(frame.middle.x), std::fabs(frame.middle.y));
  for (const Vector& v : {box.low, box.high})
    extent = std::max({extent, std::fabs(v.x), std::fabs(v.y)});
  return {sagitta, u * (10.0 * frame.major + 3.0 * extent) / (frame.minor * sagitta)};
}

/// docs/physics/exactness.md, Thin walls.
double share_of_landing(const CurveFrame& frame, const FlightSizes& sizes) {
  constexpr double u = 0x1p-53;
  return u * (10.0 * frame.major + 7.0 * sizes.farthest + 3.0 * sizes.longest) / frame.minor;
}

}  // namespace

}  // namespace shapes

Misplaced misplaced(const Wall& wall, const FlightSizes& sizes) {
  if (std::holds_alternative<geometry::Segment>(wall.curve) ||
      std::holds_alternative<geometry::Bezier>(wall.curve))
    return {};
  const geometry::CurveFrame frame = geometry::frame_of(wall.curve);
  if (const double share = shapes::share_of_landing(frame, sizes); share > shapes::largest_share) {
    return {
        "'" + wall.name + "' is too " +
            (frame.circular ? fmt::format("small: with a radius of {:.3g}, hits would be misplaced "
                                          "by up to {:.3g} of it",
                                          frame.minor, share)
                            : fmt::format("thin: with semi-axes of {:.3g} and {:.3g}, hits would "
                                          "be misplaced by up to {:.3g} of the smaller one",
                                          frame.major, frame.minor, share)),
        "a share of 2^-16 at most: no radius or semi-axis below some 3e-10 of the table's size, "
        "of its distance from the origin and of the other semi-axis"};
  }
  const auto* circular = std::get_if<geometry::CircularArc>(&wall.curve);
  const auto* elliptic = std::get_if<geometry::EllipticArc>(&wall.curve);
  if (!circular && !elliptic) return {};
  const double in_metric = elliptic ? elliptic->ratio * dot(elliptic->axis, elliptic->axis) : 1.0;
  const shapes::Flatness found =
      circular
          ? shapes::flatness(wall.curve, circular->offset, circular->counterclockwise)
          : shapes::flatness(wall.curve, in_metric * elliptic->offset, elliptic->counterclockwise);
  if (found.share <= shapes::largest_share) return {};
  const geometry::Vector chord =
      geometry::end_point(wall.curve) - geometry::start_point(wall.curve);
  return {fmt::format("the arc '{}' is too flat: with a {} of {:.3g} over a chord of {:.3g}, hits "
                      "would lie off it by up to {:.3g} of its sagitta",
                      wall.name, circular ? "radius" : "semi-axis", frame.major,
                      std::sqrt(dot(chord, chord)), found.share),
          "a straight line, or an arc bent enough for a share of 2^-16: a radius up to some 30000 "
          "chords"};
}

namespace shapes {
namespace {

/// The key of a named shape that tells how large a wall is, if there is one.
Place place_of_size(const TableSpec& spec, const Table& table, std::size_t wall) {
  Place place = place_of_wall(spec, table, wall);
  if (place.key != spec.place.key) return place;
  const auto a = spec.numbers.find("a"), b = spec.numbers.find("b");
  if (a != spec.numbers.end() && b != spec.numbers.end())
    return (a->second.to_double() < b->second.to_double() ? a : b)->second.place();
  for (const std::string& key : {table.walls[wall].name, std::string("radius")})
    if (const auto found = spec.numbers.find(key); found != spec.numbers.end())
      return found->second.place();
  return place;
}

}  // namespace
}  // namespace shapes

void shapes::refuse_misplaced(const TableSpec& spec, const Table& table) {
  const FlightSizes sizes = flight_sizes(table);
  for (std::size_t k = 0; k < table.walls.size(); ++k)
    if (const Misplaced found = misplaced(table.walls[k], sizes); !found.fault.empty())
      throw InputError(place_of_size(spec, table, k), found.fault, found.expected);
}

}  // namespace carom::table
