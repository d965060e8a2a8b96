// Rectangle, polygon, triangle, regular polygon.
#include <utility>

#include "carom/base/whole_number.hpp"
#include "table/numbers.hpp"
#include "table/obstacles.hpp"
#include "table/shapes.hpp"

namespace carom::table::shapes {
namespace {

using geometry::Vector;

std::vector<WrittenPoint> corners_of(const TableSpec& spec) {
  const auto found = spec.points.find("points");
  if (found == spec.points.end()) {
    throw InputError(place_of(spec, "points"), "the shape '" + spec.shape + "' needs 'points'",
                     "a list of points [x, y]");
  }
  std::vector<WrittenPoint> corners;
  Vector before, first;
  for (const ExactPoint& p : found->second) {
    const Vector here = point(p);
    if (!corners.empty() && here == before) {
      throw InputError(p.x.place(), "the same point twice in a row", "corners that differ");
    }
    if (corners.empty()) first = here;
    before = here;
    corners.emplace_back(p);
  }
  if (corners.size() > 1 && first == before) {
    throw InputError(found->second.back().x.place(), "the last point is the first again",
                     "each corner once: the last side closes by itself");
  }
  return corners;
}

}  // namespace

void add_polygon(Shape& shape, const std::vector<std::string>& names,
                 const std::vector<WrittenPoint>& corners, int corner) {
  Chain chain;
  for (std::size_t k = 0; k < corners.size(); ++k)
    chain.push_back(
        {names[k], WrittenSegment{corners[k], corners[(k + 1) % corners.size()]}, corner});
  shape.loops.push_back(std::move(chain));
}

Shape rectangle(const TableSpec& spec) {
  const ExactNumber &w = number(spec, "width"), &h = number(spec, "height");
  size_of(w, "width");
  size_of(h, "height");
  Shape shape;
  add_polygon(shape, {"bottom", "right", "top", "left"},
              {ExactPoint{0, 0}, ExactPoint{w, 0}, ExactPoint{w, h}, ExactPoint{0, h}});
  return shape;
}

Shape polygon(const TableSpec& spec) {
  const std::vector<WrittenPoint> corners = corners_of(spec);
  const bool triangle = spec.shape == "triangle";
  if (corners.size() < 3 || (triangle && corners.size() > 3))
    throw InputError(spec.points.at("points").empty() ? place_of(spec, "points")
                                                      : spec.points.at("points").front().x.place(),
                     (triangle ? "a triangle has three corners, not "
                               : "a polygon has at least three corners, not ") +
                         std::to_string(corners.size()),
                     triangle ? "three points" : "three points or more");
  // Counter-clockwise: the sides of a clockwise list keep their names and run backwards.
  std::vector<Vector> rounded;
  for (const ExactPoint& p : spec.points.at("points")) rounded.push_back(point(p));
  const std::vector<std::string> names = numbered("side", corners.size());
  Chain chain;
  for (const OrderedSide& s : ordered_sides(rounded, false))
    chain.push_back({names[s.side], WrittenSegment{corners[s.from], corners[s.to]}});
  Shape shape;
  shape.loops.push_back(std::move(chain));
  return shape;
}

Shape regular(const TableSpec& spec) {
  const ExactNumber& sides = number(spec, "sides");
  const auto count = whole_number(sides, 3, 10000);
  if (!count) {
    throw InputError(sides.place(), "must be a whole number of at least 3, not " + sides.text(),
                     "a whole number from 3 to 10000");
  }
  const int n = static_cast<int>(*count);
  size(spec, "radius");
  std::vector<WrittenPoint> corners;
  for (int k = 0; k < n; ++k)
    corners.emplace_back(
        RegularCorner{number(spec, "radius"), number_or(spec, "angle", "0"), k, n});
  // The interior angle pi (n - 2)/n is pi over a whole number only for n = 3 and 4.
  const int corner = n == 3 ? 3 : n == 4 ? 2 : 0;
  Shape shape;
  add_polygon(shape, numbered("side", corners.size()), corners, corner);
  return shape;
}

}  // namespace carom::table::shapes
