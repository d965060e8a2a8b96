// [[table.obstacle]]: closed walls inside the domain, besides those of the shape.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "carom/geometry/vector.hpp"
#include "carom/table/table_spec.hpp"

namespace carom::table {

/// "obstacle_1", "obstacle_2" … where none is given. A circle, an ellipse or a path of one piece is
/// a wall of that name; the sides of a polygon are NAME_side_1, NAME_side_2 …, the walls of other
/// curves NAME_1, NAME_2 …
std::string name_of_obstacle(const std::vector<ObstacleSpec>&, std::size_t index);
/// The name of a piece of an obstacle's path.
std::string name_of_piece(const ObstacleSpec&, const std::string& obstacle, std::size_t piece);

/// The numbers of a polygon's corners in the order of its walls, clockwise or counter-clockwise,
/// whichever way the list of corners runs. Side k leads from corner k to the next or back. Decided
/// by the exact sign of the area of the rounded corners.
struct OrderedSide {
  std::size_t from, to, side;
};
std::vector<OrderedSide> ordered_sides(const std::vector<geometry::Vector>& corners,
                                       bool clockwise);

}  // namespace carom::table
