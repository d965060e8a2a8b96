// Arcs that are too flat: a hit would lie off its wall by more than a small part of how far the arc
// is bent.
#include <algorithm>
#include <cmath>
#include <cstdio>

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

std::string shown(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", x);
  return text;
}

}  // namespace

}  // namespace shapes

std::string flat_arc(const Wall& wall) {
  const auto* circular = std::get_if<geometry::CircularArc>(&wall.curve);
  const auto* elliptic = std::get_if<geometry::EllipticArc>(&wall.curve);
  if (!circular && !elliptic) return "";
  const double in_metric = elliptic ? elliptic->ratio * dot(elliptic->axis, elliptic->axis) : 1.0;
  const shapes::Flatness found =
      circular
          ? shapes::flatness(wall.curve, circular->offset, circular->counterclockwise)
          : shapes::flatness(wall.curve, in_metric * elliptic->offset, elliptic->counterclockwise);
  if (found.share <= shapes::largest_share) return "";
  const geometry::CurveFrame frame = geometry::frame_of(wall.curve);
  const geometry::Vector chord =
      geometry::end_point(wall.curve) - geometry::start_point(wall.curve);
  return "the arc '" + wall.name + "' is too flat: with a " +
         (circular ? "radius of " : "semi-axis of ") + shapes::shown(frame.major) +
         " over a chord of " + shapes::shown(std::sqrt(dot(chord, chord))) +
         ", hits would lie off it by up to " + shapes::shown(found.share) + " of its sagitta";
}

void shapes::refuse_flat_arcs(const TableSpec& spec, const Table& table) {
  for (std::size_t k = 0; k < table.walls.size(); ++k)
    if (const std::string fault = flat_arc(table.walls[k]); !fault.empty())
      throw InputError(place_of_wall(spec, table, k), fault, bent_enough);
}

}  // namespace carom::table
