// The exact check that the walls bound a region.
#include "carom/geometry/region.hpp"

#include <utility>

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

Place place_of_wall(const TableSpec& spec, const Table& table, const std::string& name) {
  const int index = table.wall_index(name);
  if (index < 0) return spec.place;
  std::size_t left = static_cast<std::size_t>(index);
  for (const LoopSpec& loop : spec.loops) {
    if (left < loop.pieces.size()) return loop.pieces[left].place;
    left -= loop.pieces.size();
  }
  for (const char* key : {"points", "centers"}) {
    const auto found = spec.points.find(key);
    if (found != spec.points.end() && left < found->second.size()) return found->second[left].x.place();
  }
  return spec.place;
}

void check_region(const TableSpec& spec, const Table& table) {
  const auto faults = geometry::check_region(loops_of(table), kind_of(table.extent), table.lattice, 3);
  if (faults.empty()) return;
  std::string problem;
  for (const geometry::RegionFault& fault : faults) {
    problem.append(problem.empty() ? "" : "; ").append(fault.sentence);
  }
  throw InputError(place_of_wall(spec, table, faults.front().first), problem,
                   "closed loops that do not cross, outer ones counter-clockwise, obstacles clockwise");
}

}  // namespace carom::shapes
