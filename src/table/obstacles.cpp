#include "table/obstacles.hpp"

#include <algorithm>
#include <utility>

#include "carom/base/exact_sum.hpp"
#include "carom/base/fused_product.hpp"
#include "table/closed_curves.hpp"
#include "table/numbers.hpp"
#include "table/quintic.hpp"

namespace carom::table {
namespace {

using geometry::Vector;

// Twice the area, positive where the corners run counter-clockwise; its sign is exact.
double signed_area(const std::vector<Vector>& corners) {
  ExactSum twice_the_area;
  const auto add_product = [&](double a, double b) {
    const double product = a * b;
    twice_the_area.add(product);
    twice_the_area.add(fused_product(a, b, -product));  // what rounding took: exact
  };
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Vector p = corners[k], q = corners[(k + 1) % corners.size()];
    add_product(p.x, q.y);
    add_product(-p.y, q.x);
  }
  return twice_the_area.value();
}

std::vector<Vector> corners_of(const ObstacleSpec& obstacle) {
  std::vector<Vector> corners;
  for (const ExactPoint& p : obstacle.points) corners.push_back(shapes::point(p));
  return corners;
}

}  // namespace

std::string name_of_obstacle(const std::vector<ObstacleSpec>& obstacles, std::size_t index) {
  return obstacles[index].name.empty() ? "obstacle_" + std::to_string(index + 1)
                                       : obstacles[index].name;
}

std::string name_of_piece(const ObstacleSpec& o, const std::string& obstacle, std::size_t piece) {
  if (!o.loop.pieces[piece].name.empty()) return o.loop.pieces[piece].name;
  return o.loop.pieces.size() == 1 ? obstacle : obstacle + "_" + std::to_string(piece + 1);
}

std::vector<OrderedSide> ordered_sides(const std::vector<Vector>& corners, bool clockwise) {
  const std::size_t n = corners.size();
  const double area = signed_area(corners);
  const bool turn_round = clockwise ? area > 0.0 : area < 0.0;
  std::vector<OrderedSide> sides;
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t side = turn_round ? n - 1 - k : k, next = (side + 1) % n;
    sides.push_back(turn_round ? OrderedSide{next, side, side} : OrderedSide{side, next, side});
  }
  return sides;
}

namespace shapes {
namespace {

Chain polygon_obstacle(const ObstacleSpec& obstacle, const std::string& name) {
  const std::vector<Vector> corners = corners_of(obstacle);
  if (corners.size() < 3)
    throw InputError(obstacle.place,
                     "a polygon has at least three corners, not " + std::to_string(corners.size()),
                     "three points or more");
  for (std::size_t k = 0; k < corners.size(); ++k)
    if (corners[k] == corners[(k + 1) % corners.size()])
      throw InputError(obstacle.points[k].x.place(), "the same point twice in a row",
                       "corners that differ");
  const std::vector<std::string> names = numbered(name + "_side", corners.size());
  Chain chain;
  for (const OrderedSide& s : ordered_sides(corners, true))
    chain.push_back(
        {names[s.side], WrittenSegment{obstacle.points[s.from], obstacle.points[s.to]}});
  return chain;
}

ClosedCurve curve_of(const ObstacleSpec& o, const std::string& name) {
  using Kind = ObstacleSpec::Shape;
  const Layout layout{name, true};
  switch (o.shape) {
    case Kind::circle:
      break;
    case Kind::ellipse:
      size_of(o.b, "b");
      return {{{name, WrittenEllipse{o.center, o.a, o.b, o.angle, false}}}};
    case Kind::polygon:
      return {polygon_obstacle(o, name)};
    case Kind::path:
      return {turned(
          loop_of_pieces(o.loop, [&](std::size_t k) { return name_of_piece(o, name, k); }), true)};
    case Kind::polar:
    case Kind::parametric:
      return drawn(*formulas_of(o), layout);
    case Kind::spline:
      return {spline(o.points, o.place, layout)};
  }
  return {{{name, WrittenCircle{o.center, o.radius, false}}}};
}

}  // namespace

void add_obstacles(const TableSpec& spec, Shape& shape) {
  for (std::size_t k = 0; k < spec.obstacles.size(); ++k) {
    ClosedCurve curve = curve_of(spec.obstacles[k], name_of_obstacle(spec.obstacles, k));
    shape.loops.push_back(std::move(curve.chain));
    include(shape.curve_errors, curve.errors);
  }
}

}  // namespace shapes
}  // namespace carom::table
