#include "events/step/curve_graph.hpp"

#include <algorithm>

namespace carom::events {

namespace {

/// Where a curve rests, no part that ends there is short enough. Its parts shrink until they are
/// smaller than the rounding of their points, 16 epsilon / 2 of the extent each.
void add_parts(const geometry::Bezier& curve, CurvePart part, std::vector<CurvePart>& parts) {
  const FramedGraph<double> framed(curve, part);
  double size = 0.0;
  for (int k = 1; k <= curve.degree; ++k) {
    const geometry::Vector e = framed.points[static_cast<std::size_t>(k)] - framed.points[0];
    size = std::max(size, std::fabs(e.x) + std::fabs(e.y));
  }
  part.straight = !(size > 16.0 * std::numeric_limits<double>::epsilon() * framed.graph.extent);
  if (part.straight || framed.is_short()) return parts.push_back(part);
  const double middle = part.from + 0.5 * (part.to - part.from);
  add_parts(curve, {part.from, middle}, parts);
  add_parts(curve, {middle, part.to}, parts);
}

}  // namespace

std::vector<CurvePart> parts_of(const geometry::Bezier& curve) {
  std::vector<CurvePart> parts;
  add_parts(curve, {}, parts);
  return parts;
}

}  // namespace carom::events
