#include "events/flight/wall_touch.hpp"

#include <algorithm>
#include <cmath>

#include "carom/geometry/hull.hpp"

namespace carom::events {

using geometry::Vector;

WallTouch::WallTouch(const Table& table, int grid_from)
    : loop_of_(table.walls.size(), table.walls.size()) {
  for (const Wall& wall : table.walls) frames_.push_back(geometry::frame_of(wall.curve));
  for (std::size_t first = 0; first < table.walls.size(); ++first) {
    if (loop_of_[first] < loops_.size()) continue;
    geometry::Loop loop;
    for (std::size_t wall = first; loop_of_[wall] >= table.walls.size();
         wall = static_cast<std::size_t>(table.walls[wall].next)) {
      loop_of_[wall] = loops_.size();
      loop.push_back({table.walls[wall].name, table.walls[wall].curve});
    }
    loops_.push_back(std::move(loop));
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
  return !(distance > 0x1p-40 * size) && geometry::locate(loops_[loop_of_[i]], point) == 0;
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
