// The parts of a table that was divided into regions.
#include <algorithm>

#include "base/index.hpp"
#include "carom/table/table.hpp"

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
  seen.holes = table.holes;
  seen.walls.assign(first + r.first, first + r.first + r.count);
  for (Wall& wall : seen.walls) {
    wall.next -= r.first;
    wall.previous -= r.first;
  }
  return seen;
}

bool regions_change_speeds(const Table& table) {
  return std::any_of(table.regions.begin(), table.regions.end(),
                     [](const Region& r) { return r.index != 1.0 || r.potential != 0.0; });
}

bool is_inner_side(const Table& table, int wall) {
  const Wall& w = table.wall(wall);
  return w.twin >= 0 && w.name.size() > table.wall(w.twin).name.size();  // by ".inside"
}

}  // namespace carom
