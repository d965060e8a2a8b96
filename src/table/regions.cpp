// Loops of walls that particles pass.
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/index.hpp"
#include "table/shapes.hpp"

namespace carom {

int region_of(const Table& table, int wall) {
  for (std::size_t r = 0; r < table.regions.size(); ++r) {
    const Region& region = table.regions[r];
    if (wall >= region.first && wall < region.first + region.count) return static_cast<int>(r);
  }
  return -1;
}

Table seen_from(const Table& table, int region) {
  Table seen;
  const auto first = table.walls.begin();
  if (region < 0) {
    seen = table;
    const int inside =
        table.regions.empty() ? static_cast<int>(table.walls.size()) : table.regions.front().first;
    seen.walls.assign(first, first + inside);
    seen.regions.clear();
    return seen;
  }
  const Region& r = table.regions[base::at(region)];
  seen.shape = "region";
  seen.walls.assign(first + r.first, first + r.first + r.count);
  for (Wall& wall : seen.walls) {
    wall.next -= r.first;
    wall.previous -= r.first;
  }
  return seen;
}

namespace table::shapes {
namespace {

/// The walls of the loop of that wall, from it on.
std::vector<int> loop_of(const Table& table, int wall) {
  std::vector<int> loop;
  for (int w = wall; loop.empty() || w != wall; w = table.walls[base::at(w)].next)
    loop.push_back(w);
  return loop;
}

void check_loop(const RegionSpec& spec, const Table& table, const std::vector<int>& loop) {
  double area = 0.0;
  for (const int w : loop) {
    const Wall& wall = table.walls[base::at(w)];
    area += geometry::area_integral(wall.curve);
    if (wall.twin >= 0)
      throw InputError(spec.wall_place, "wall '" + wall.name + "' bounds another region already",
                       "a region for each obstacle");
    if (!wall.holes.empty())
      throw InputError(spec.wall_place,
                       "wall '" + wall.name + "' has a hole, and particles pass it",
                       "holes in other walls");
  }
  // Obstacles run clockwise, which the check of the region has decided exactly.
  if (area > 0.0)
    throw InputError(spec.wall_place, "wall '" + spec.wall + "' is the table's outer wall",
                     "a wall of an obstacle");
}

Region region_of(const RegionSpec& spec) {
  Region region;
  if (spec.field) region.field = spec.field->to_double();
  region.index = spec.index.to_double();
  region.potential = spec.potential.to_double();
  if (!(region.index > 0.0 && std::isfinite(region.index)))
    throw InputError(spec.index.place(), "a refractive index is above 0", "a positive number");
  if (region.index != 1.0 && region.potential != 0.0)
    throw InputError(spec.potential.place(), "a region has an index or a potential", "one of them");
  if (spec.reflection == "s") region.reflection = Region::Reflection::s;
  if (spec.reflection == "p") {
    region.reflection = Region::Reflection::p;
    if (region.potential != 0.0)
      throw InputError(spec.place, "a potential has no polarisation", "reflection = \"s\"");
  }
  return region;
}

}  // namespace

void add_regions(const TableSpec& spec, Table& table) {
  for (const RegionSpec& one : spec.regions) {
    const std::vector<int> loop = loop_of(table, named_wall(one.wall, one.wall_place, table));
    check_loop(one, table, loop);
    Region region = region_of(one);
    region.first = static_cast<int>(table.walls.size());
    region.count = static_cast<int>(loop.size());
    for (int k = 0; k < region.count; ++k) {
      Wall& outside = table.walls[base::at(loop[base::at(k)])];
      outside.twin = region.first + k;
      Wall inside;
      inside.name = outside.name + ".inside";
      inside.curve = geometry::reversed(outside.curve);
      inside.next = region.first + (k + region.count - 1) % region.count;
      inside.previous = region.first + (k + 1) % region.count;
      inside.twin = loop[base::at(k)];
      table.walls.push_back(std::move(inside));
    }
    table.regions.push_back(std::move(region));
  }
}

}  // namespace table::shapes
}  // namespace carom
