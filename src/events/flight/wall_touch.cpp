#include "events/flight/wall_touch.hpp"

#include <algorithm>
#include <cmath>

#include "carom/geometry/hull.hpp"

namespace carom::events {

using geometry::Vector;

WallTouch::WallTouch(const Table& table, int grid_from) {
  for (const Wall& wall : table.walls) {
    curves_.push_back(wall.curve);
    frames_.push_back(geometry::frame_of(wall.curve));
  }
  if (table.walls.empty() || static_cast<int>(table.walls.size()) < grid_from) return;
  std::vector<geometry::Piece> pieces;
  for (const Wall& wall : table.walls) pieces.push_back({wall.curve, {}, wall.next, false});
  const geometry::Box whole = geometry::hull_of(
      table.walls, [](const Wall& wall) { return geometry::bounding_box(wall.curve); });
  grid_ = std::make_unique<const WallGrid>(pieces, Vector{}, Vector{}, whole);
}

bool WallTouch::on(std::size_t i, Vector point) const {
  // A point of the wall is reproduced by its parameter to some ulps. This asks 2^12 of them, and
  // only to spare the exact stage the points that are far away.
  const Vector image = geometry::point_at(frames_[i], geometry::parameter_of(frames_[i], point));
  const double size =
      std::max({std::abs(point.x), std::abs(point.y), frames_[i].major, frames_[i].minor,
                std::abs(frames_[i].origin.x), std::abs(frames_[i].origin.y)});
  const double distance = std::max(std::abs(point.x - image.x), std::abs(point.y - image.y));
  return !(distance > 0x1p-40 * size) && geometry::passes_through(curves_[i], point);
}

bool WallTouch::on_wall(Vector point) const {
  if (grid_) {
    for (const int wall : grid_->pieces_at(point))
      if (on(static_cast<std::size_t>(wall), point)) return true;
    return false;
  }
  for (std::size_t i = 0; i < frames_.size(); ++i)
    if (on(i, point)) return true;
  return false;
}

}  // namespace carom::events
