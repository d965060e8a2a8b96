// Arcs that are too flat: a hit would lie off its wall by more than a small part of how far the arc is bent.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "carom/geometry/curve_frame.hpp"
#include "table/shapes.hpp"

namespace carom::shapes {
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
  // The centre is `offset` chords from the chord, in the metric of the curve: on the arc's own side if the arc is
  // the larger part of the circle.
  const double away = 2.0 * (counterclockwise ? offset : -offset), half = std::sqrt(1.0 + away * away);
  const double sagitta = away > 0.0 ? 1.0 / (half * (half + away)) : 1.0 - away / half;
  const Box box = bounding_box(curve);
  double extent = std::max(std::fabs(frame.middle.x), std::fabs(frame.middle.y));
  for (const Vector& v : {box.low, box.high}) extent = std::max({extent, std::fabs(v.x), std::fabs(v.y)});
  return {sagitta, u * (10.0 * frame.major + 3.0 * extent) / (frame.minor * sagitta)};
}

std::string shown(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", x);
  return text;
}

}  // namespace

void refuse_flat_arcs(const TableSpec& spec, const Table& table) {
  for (const Wall& wall : table.walls) {
    const auto* circular = std::get_if<CircularArc>(&wall.curve);
    const auto* elliptic = std::get_if<EllipticArc>(&wall.curve);
    if (!circular && !elliptic) continue;
    const double in_metric = elliptic ? elliptic->ratio * dot(elliptic->axis, elliptic->axis) : 1.0;
    const Flatness found =
        circular ? flatness(wall.curve, circular->offset, circular->counterclockwise)
                 : flatness(wall.curve, in_metric * elliptic->offset, elliptic->counterclockwise);
    if (found.share <= largest_share) continue;
    const CurveFrame frame = frame_of(wall.curve);
    const Vector chord = end_point(wall.curve) - start_point(wall.curve);
    throw InputError(place_of_wall(spec, table, wall.name),
                     "the arc '" + wall.name + "' is too flat: with a " +
                         (circular ? "radius of " : "semi-axis of ") + shown(frame.major) + " over a chord of " +
                         shown(std::sqrt(dot(chord, chord))) + ", hits would lie off it by up to " +
                         shown(found.share) + " of its sagitta",
                     "a straight line, or an arc bent enough for a share of 2^-16: a radius up to some 30000 chords");
  }
}

}  // namespace carom::shapes
