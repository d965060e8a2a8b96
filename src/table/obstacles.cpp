#include "table/obstacles.hpp"

#include "carom/base/exact_sum.hpp"
#include "carom/base/fused_product.hpp"
#include "table/numbers.hpp"
#include "table/shapes.hpp"

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

std::size_t walls_of(const ObstacleSpec& obstacle) {
  return obstacle.shape == ObstacleSpec::Shape::polygon ? obstacle.points.size() : 1;
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

}  // namespace

void add_obstacles(const TableSpec& spec, Shape& shape) {
  for (std::size_t k = 0; k < spec.obstacles.size(); ++k) {
    const ObstacleSpec& o = spec.obstacles[k];
    const std::string name = name_of_obstacle(spec.obstacles, k);
    switch (o.shape) {
      case ObstacleSpec::Shape::circle:
        shape.loops.push_back({{name, WrittenCircle{o.center, o.radius, false}}});
        break;
      case ObstacleSpec::Shape::ellipse:
        size_of(o.b, "b");
        shape.loops.push_back({{name, WrittenEllipse{o.center, o.a, o.b, o.angle, false}}});
        break;
      case ObstacleSpec::Shape::polygon:
        shape.loops.push_back(polygon_obstacle(o, name));
        break;
    }
  }
}

}  // namespace shapes
}  // namespace carom::table
