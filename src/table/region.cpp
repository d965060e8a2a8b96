// The exact check that the walls bound a region.
#include "carom/geometry/region.hpp"

#include <algorithm>
#include <utility>

#include "table/obstacles.hpp"
#include "table/shapes.hpp"

namespace carom::shapes {
namespace {

std::vector<geometry::Loop> loops_of(const Table& table) {
  std::vector<geometry::Loop> loops;
  std::vector<bool> seen(table.walls.size(), false);
  for (std::size_t first = 0; first < table.walls.size(); ++first) {
    if (seen[first]) continue;
    geometry::Loop loop;
    for (std::size_t at = first; !seen[at]; at = static_cast<std::size_t>(table.walls[at].next)) {
      seen[at] = true;
      loop.push_back({table.walls[at].name, table.walls[at].curve});
    }
    loops.push_back(std::move(loop));
  }
  return loops;
}

geometry::RegionKind kind_of(Extent extent) {
  switch (extent) {
    case Extent::bounded:
      return geometry::RegionKind::bounded;
    case Extent::open_plane:
      return geometry::RegionKind::open;
    case Extent::lattice:
      break;
  }
  return geometry::RegionKind::lattice;
}

}  // namespace

Place place_of_wall(const TableSpec& spec, const Table& table, std::size_t wall) {
  std::size_t after = table.walls.size();
  for (std::size_t k = spec.obstacles.size(); k-- > 0;) {
    after -= walls_of(spec.obstacles[k]);
    if (wall >= after) return spec.obstacles[k].place;
  }
  std::size_t left = wall;
  for (const LoopSpec& loop : spec.loops) {
    if (left < loop.pieces.size()) return loop.pieces[left].place;
    left -= loop.pieces.size();
  }
  for (const char* key : {"points", "centers"}) {
    const auto found = spec.points.find(key);
    if (found != spec.points.end() && left < found->second.size())
      return found->second[left].x.place();
  }
  return spec.place;
}

void check_region(const TableSpec& spec, const Table& table) {
  const auto faults =
      geometry::check_region(loops_of(table), kind_of(table.extent), table.lattice, 3);
  if (faults.empty()) return;
  std::string problem;
  for (const geometry::RegionFault& fault : faults) {
    problem.append(problem.empty() ? "" : "; ").append(fault.sentence);
  }
  // If two walls cross, the later one is named: it belongs to the obstacle.
  const int wall =
      std::max(table.wall_index(faults.front().first), table.wall_index(faults.front().second));
  throw InputError(
      wall < 0 ? spec.place : place_of_wall(spec, table, static_cast<std::size_t>(wall)), problem,
      "closed loops that do not cross, outer ones counter-clockwise, obstacles clockwise");
}

}  // namespace carom::shapes
