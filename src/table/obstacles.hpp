// [[table.obstacle]]: closed walls inside the domain, besides those of the shape.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "carom/geometry/vector.hpp"
#include "carom/table/table_spec.hpp"

namespace carom::table {

/// "obstacle_1", "obstacle_2" … where none is given. A circle or ellipse is one wall of that name;
/// the sides of a polygon are NAME_side_1, NAME_side_2 …
std::string name_of_obstacle(const std::vector<ObstacleSpec>&, std::size_t index);

/// How many walls an obstacle has.
std::size_t walls_of(const ObstacleSpec&);

/// The numbers of a polygon's corners in the order of its walls, clockwise or counter-clockwise,
/// whichever way the list of corners runs. Side k leads from corner k to the next or back. Decided
/// by the exact sign of the area of the rounded corners.
struct OrderedSide {
  std::size_t from, to, side;
};
std::vector<OrderedSide> ordered_sides(const std::vector<geometry::Vector>& corners,
                                       bool clockwise);

}  // namespace carom::table
