// The exact check that the walls bound a region.
#include "table/loops.hpp"

#include <algorithm>
#include <string>
#include <tuple>
#include <utility>

#include "base/index.hpp"
#include "table/obstacles.hpp"
#include "table/shapes.hpp"

namespace carom {

std::vector<std::vector<int>> table::wall_loops(const Table& table) {
  std::vector<std::vector<int>> loops;
  std::vector<bool> seen(table.walls.size(), false);
  for (std::size_t first = 0; first < table.walls.size(); ++first) {
    std::vector<int> loop;
    for (std::size_t k = first; !seen[k]; k = base::at(table.walls[k].next)) {
      seen[k] = true;
      loop.push_back(static_cast<int>(k));
    }
    if (!loop.empty()) loops.push_back(std::move(loop));
  }
  return loops;
}

geometry::Loop table::curves_of(const Table& table, const std::vector<int>& loop) {
  geometry::Loop curves;
  for (const int k : loop)
    curves.push_back({table.walls[base::at(k)].name, table.walls[base::at(k)].curve});
  return curves;
}

std::vector<geometry::RegionFault> table::faults_of(const Table& table, std::size_t limit) {
  std::vector<geometry::Loop> loops;
  for (const std::vector<int>& loop : wall_loops(table)) loops.push_back(curves_of(table, loop));
  const auto kind = table.extent == Extent::bounded      ? geometry::RegionKind::bounded
                    : table.extent == Extent::open_plane ? geometry::RegionKind::open
                                                         : geometry::RegionKind::lattice;
  return geometry::check_region(loops, kind, table.lattice, limit);
}

}  // namespace carom

namespace carom::table::shapes {

namespace {

// "side_3" is side 2.
std::size_t side_of(const std::string& name) {
  return std::stoul(name.substr(name.rfind('_') + 1)) - 1;
}

}  // namespace

Place place_of_wall(const TableSpec& spec, const Table& table, std::size_t wall) {
  const std::string& name = table.walls[wall].name;
  // Obstacles are the last loops. The last wall of a loop leads back.
  std::size_t loops = 0;
  for (std::size_t k = wall; k < table.walls.size(); ++k)
    if (static_cast<std::size_t>(table.walls[k].next) <= k) ++loops;
  if (loops <= spec.obstacles.size()) {
    const std::size_t index = spec.obstacles.size() - loops;
    const ObstacleSpec& obstacle = spec.obstacles[index];
    for (std::size_t k = 0; k < obstacle.loop.pieces.size(); ++k)
      if (name_of_piece(obstacle, name_of_obstacle(spec.obstacles, index), k) == name)
        return obstacle.loop.pieces[k].place;
    return obstacle.place;
  }
  std::size_t left = wall;
  for (const LoopSpec& loop : spec.loops) {
    const bool whole = loop.kind != LoopSpec::Kind::pieces;
    const std::size_t count = whole ? 1 : loop.pieces.size();
    if (left < count) return whole ? loop.place : loop.pieces[left].place;
    left -= count;
  }
  for (const char* key : {"points", "centers"}) {
    const auto found = spec.points.find(key);
    if (found == spec.points.end() || left >= found->second.size()) continue;
    // Side k of a polygon, which may have been turned round, belongs to the points k and k + 1.
    const std::size_t index = std::string(key) == "points" ? side_of(name) : left;
    Place place = found->second[index].x.place();
    if (place.key.ends_with("[0]")) place.key.resize(place.key.size() - 3);  // of x: the point's
    return place;
  }
  return spec.place;
}

namespace {

constexpr std::size_t most_faults = 3;

/// Of faults that are some.
[[noreturn]] void refuse(const std::vector<geometry::RegionFault>& faults, const Table& table,
                         const std::function<Place(const std::string&)>& place_of) {
  std::string problem;
  for (const geometry::RegionFault& fault : faults) {
    problem.append(problem.empty() ? "" : "; ").append(fault.sentence);
  }
  // If two walls cross, the fault is placed at the one that is written later: it belongs to the
  // obstacle. The other's place is added.
  const std::string *later = &faults.front().first, *earlier = &faults.front().second;
  Place place = place_of(*later);
  if (!earlier->empty()) {
    Place other = place_of(*earlier);
    if (std::tuple(other.line, other.column, table.wall_index(*earlier)) >
        std::tuple(place.line, place.column, table.wall_index(*later))) {
      std::swap(place, other);
      std::swap(later, earlier);
    }
    const bool apart = other.line != place.line || other.column != place.column;
    if (faults.size() == 1 && other.line > 0 && apart)
      problem += "; '" + *earlier + "' is at line " + std::to_string(other.line) + ", column " +
                 std::to_string(other.column);
  }
  throw InputError(
      place, problem,
      "closed loops that do not cross, outer ones counter-clockwise, obstacles clockwise");
}

}  // namespace

bool check_region(const TableSpec& spec, const Table& table) {
  const auto faults = faults_of(table, most_faults);
  if (faults.empty()) return false;
  const auto place_of = [&](const std::string& name) {
    const int wall = table.wall_index(name);
    return wall < 0 ? spec.place : place_of_wall(spec, table, static_cast<std::size_t>(wall));
  };
  const bool nested = std::all_of(faults.begin(), faults.end(), [](const auto& fault) {
    return fault.kind == geometry::RegionFault::Kind::nesting;
  });
  if (!nested || spec.regions.empty()) refuse(faults, table, place_of);
  return true;
}

void check_part(const Table& part, const std::function<Place(const std::string&)>& place_of) {
  if (const auto faults = faults_of(part, most_faults); !faults.empty())
    refuse(faults, part, place_of);
}

}  // namespace carom::table::shapes
