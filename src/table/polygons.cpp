// Rectangle, polygon, triangle, regular polygon.
#include "carom/base/whole_number.hpp"
#include "table/direction.hpp"
#include "table/numbers.hpp"
#include "table/shapes.hpp"

namespace carom::shapes {
namespace {

using geometry::Vector;

std::vector<Vector> corners_of(const TableSpec& spec) {
  const auto found = spec.points.find("points");
  if (found == spec.points.end()) {
    throw InputError(place_of(spec, "points"), "the shape '" + spec.shape + "' needs 'points'",
                     "a list of points [x, y]");
  }
  std::vector<Vector> corners;
  for (const ExactPoint& p : found->second) {
    corners.push_back(point(p));
    if (corners.size() > 1 && corners.back() == corners[corners.size() - 2]) {
      throw InputError(p.x.place(), "the same point twice in a row", "corners that differ");
    }
  }
  if (corners.size() > 1 && corners.front() == corners.back()) {
    throw InputError(found->second.back().x.place(), "the last point is the first again",
                     "each corner once: the last side closes by itself");
  }
  return corners;
}

}  // namespace

void add_polygon(Table& table, const std::vector<std::string>& names, const std::vector<Vector>& corners,
                 int corner) {
  std::vector<NamedCurve> chain;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Vector to = corners[(k + 1) % corners.size()];
    chain.push_back({names[k], geometry::Segment{corners[k], to}, corner});
  }
  add_loop(table, std::move(chain));
}

void rectangle(const TableSpec& spec, Table& table) {
  const double width = size(spec, "width");
  const double height = size(spec, "height");
  add_polygon(table, {"bottom", "right", "top", "left"}, {{0, 0}, {width, 0}, {width, height}, {0, height}});
}

void polygon(const TableSpec& spec, Table& table) {
  const std::vector<Vector> corners = corners_of(spec);
  if (corners.size() < 3) {
    throw InputError(spec.points.at("points").empty() ? place_of(spec, "points")
                                                      : spec.points.at("points").front().x.place(),
                     "a polygon has at least three corners, not " + std::to_string(corners.size()),
                     "three points or more");
  }
  add_polygon(table, numbered("side", corners.size()), corners);
}

void triangle(const TableSpec& spec, Table& table) {
  const std::vector<Vector> corners = corners_of(spec);
  if (corners.size() != 3) {
    throw InputError(spec.points.at("points").empty() ? place_of(spec, "points")
                                                      : spec.points.at("points").front().x.place(),
                     "a triangle has three corners, not " + std::to_string(corners.size()), "three points");
  }
  add_polygon(table, numbered("side", 3), corners);
}

void regular(const TableSpec& spec, Table& table) {
  const ExactNumber& sides = number(spec, "sides");
  const auto count = whole_number(sides, 3, 10000);
  if (!count) {
    throw InputError(sides.place(), "must be a whole number of at least 3, not " + sides.text(),
                     "a whole number from 3 to 10000");
  }
  const int n = static_cast<int>(*count);
  const double radius = size(spec, "radius");
  const ExactNumber angle = number_or(spec, "angle", "0");
  std::vector<Vector> corners;
  for (int k = 0; k < n; ++k) corners.push_back(direction(angle, k, n, radius));
  // Of the interior angles pi (n - 2)/n only those of n = 3 and 4 are pi/3 and pi/2.
  const int corner = n == 3 ? 3 : n == 4 ? 2 : 0;
  add_polygon(table, numbered("side", corners.size()), corners, corner);
}

}  // namespace carom::shapes
