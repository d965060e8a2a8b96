// Walls by their names, and holes: arc lengths along walls become parameters of their curves.
#include <algorithm>
#include <limits>
#include <numbers>
#include <string_view>

#include "table/numbers.hpp"
#include "table/shapes.hpp"

namespace carom::table::shapes {
namespace {

/// Has a wall the name and a number, as in NAME_12, or NAME_12.inside where the name has that end?
bool is_numbered(std::string_view wall, std::string_view name) {
  constexpr std::string_view inside = ".inside";
  if (name.ends_with(inside) && wall.ends_with(inside)) {
    wall.remove_suffix(inside.size());
    name.remove_suffix(inside.size());
  }
  return wall.size() > name.size() + 1 && wall.starts_with(name) && wall[name.size()] == '_' &&
         wall.find_first_not_of("0123456789", name.size() + 1) == std::string_view::npos;
}

class Opening {
 public:
  Opening(const HoleSpec& hole, const std::string& name, Table& table)
      : hole_(hole),
        name_(name),
        table_(table),
        walls_(stretch_named(hole.wall, hole.wall_place, table)) {
    starts_.push_back(0.0);
    for (const int k : walls_) {
      if (wall(k).twin >= 0)
        throw InputError(hole.wall_place, "particles pass wall '" + hole.wall + "' of a region",
                         "a hole of another wall");
      starts_.push_back(starts_.back() + geometry::length(wall(k).curve));
    }
    // A convex curve that is displaced by so much is longer by 2 pi times that.
    rounding_ = static_cast<double>(4 + walls_.size()) * std::numeric_limits<double>::epsilon() *
                    starts_.back() +
                2.0 * std::numbers::pi * table.curve_errors.distance;
  }

  void cut() {
    const double length = starts_.back();
    const double width = size_of(hole_.width, "width");
    if (beyond(width, length)) {
      throw InputError(hole_.width.place(), "the hole is wider than its wall",
                       "a width of at most " + ExactNumber(length).text() + ", the length of '" +
                           hole_.wall + "'");
    }
    const std::string c = quoted(hole_.center), w = quoted(hole_.width);
    const double centre = hole_.center.to_double();
    const double from = derived(c + "-" + w + "/2", hole_.center).to_double();
    const double to = derived(c + "+" + w + "/2", hole_.center).to_double();
    if (centre < 0 || beyond(centre, length)) {
      throw InputError(hole_.center.place(), "the hole's center is not on the wall",
                       "an arc length from 0 to " + ExactNumber(length).text());
    }
    const bool closed = geometry::start_point(wall(walls_.front()).curve) ==
                        geometry::end_point(wall(walls_.back()).curve);
    if (!closed && (from < 0 || beyond(to, length))) {
      throw InputError(hole_.center.place(),
                       "the hole reaches over the end of its wall '" + hole_.wall + "'",
                       "a hole within 0 … " + ExactNumber(length).text() + " of arc length");
    }
    const std::size_t before = table_.holes.size();
    if (closed && !beyond(length, to - from)) {
      add(0.0, length);  // all of it, wherever it begins
    } else if (from < 0) {
      add(length + from, length);
      add(0.0, to);
    } else if (beyond(to, length)) {
      add(from, length);
      add(0.0, to - length);
    } else {
      add(from, beyond(length, to) ? to : length);
    }
    if (table_.holes.size() == before)
      throw InputError(hole_.width.place(), "the hole is too narrow for double precision",
                       "a wider hole");
  }

 private:
  // The length of a wall is a sum of rounded numbers, and that of pieces of a curve, while an end
  // written as "pi" is not: ends that agree with the wall's to rounding mean the wall's.
  bool beyond(double s, double end) const { return s > end + rounding_; }
  Wall& wall(int index) const { return table_.walls[static_cast<std::size_t>(index)]; }
  /// What lies on each wall between two arc lengths along all of them.
  void add(double from, double to) {
    for (std::size_t k = 0; k < walls_.size(); ++k) {
      const double first = parameter(k, from), last = parameter(k, to);
      if (!(first < last)) continue;
      wall(walls_[k]).holes.push_back(static_cast<int>(table_.holes.size()));
      table_.holes.push_back({name_, walls_[k], first, last, hole_.transmission});
    }
  }
  /// On that wall, or at its nearer end.
  double parameter(std::size_t k, double s) const {
    const geometry::Curve& curve = wall(walls_[k]).curve;
    if (!(s > starts_[k])) return 0.0;
    return s < starts_[k + 1] ? geometry::parameter_at_length(curve, s - starts_[k])
                              : geometry::end_parameter(curve);
  }

  const HoleSpec& hole_;
  const std::string& name_;
  Table& table_;
  const std::vector<int> walls_;
  std::vector<double> starts_;  ///< arc lengths at which the walls begin, and the last one ends
  double rounding_ = 0.0;       ///< of the last one
};

}  // namespace

int named_wall(const std::string& name, const Place& place, const Table& table) {
  const int wall = table.wall_index(name);
  if (wall >= 0) return wall;
  std::vector<std::string> names;
  std::string list;
  for (const Wall& w : table.walls) {
    names.push_back(w.name);
    if (names.size() <= 8) list += (list.empty() ? "" : ", ") + w.name;
  }
  if (names.size() > 8) list += ", …";
  throw InputError(place, "unknown wall '" + name + "'", "one of " + list,
                   nearest_name(name, names));
}

std::vector<int> walls_named(const std::string& name, const Place& place, const Table& table) {
  std::vector<int> walls;
  for (int k = 0; k < static_cast<int>(table.walls.size()); ++k)
    if (is_numbered(table.wall(k).name, name)) walls.push_back(k);
  if (walls.empty() || table.wall_index(name) >= 0) return {named_wall(name, place, table)};
  return walls;
}

std::vector<int> stretch_named(const std::string& name, const Place& place, const Table& table) {
  const std::vector<int> named = walls_named(name, place, table);
  std::vector<bool> marked(table.walls.size());
  for (const int k : named) marked[static_cast<std::size_t>(k)] = true;
  const auto among = [&](int wall) { return wall >= 0 && marked[static_cast<std::size_t>(wall)]; };
  // The next one of the name, -1: none. An edge of a region may have parted them since they were
  // drawn; their ends are still the same point.
  const auto behind = [&](int wall) {
    if (among(table.wall(wall).next)) return table.wall(wall).next;
    const geometry::Vector end = geometry::end_point(table.wall(wall).curve);
    for (const int k : named)
      if (geometry::start_point(table.wall(k).curve) == end) return k;
    return -1;
  };
  // All round it begins where the numbers do: the walls of obstacles run the other way.
  const int one = table.wall_index(name + "_1"), two = table.wall_index(name + "_2");
  int first = among(one) ? one : named.front();
  if (first == one && two >= 0 && behind(one) != two && behind(one) >= 0) first = behind(one);
  // Else it begins where nothing of the name comes before.
  std::vector<bool> follows(table.walls.size());
  for (const int k : named)
    if (const int next = behind(k); next >= 0) follows[static_cast<std::size_t>(next)] = true;
  for (const int k : named)
    if (!follows[static_cast<std::size_t>(k)]) first = k;
  std::vector<int> walls{first};
  for (int k = behind(first); k != first && k >= 0 && walls.size() < named.size(); k = behind(k))
    walls.push_back(k);
  if (walls.size() < named.size())
    throw InputError(place,
                     "the walls '" + name + "_1', '" + name + "_2' … do not follow each other",
                     "one of them");
  return walls;
}

void add_holes(const TableSpec& spec, Table& table) {
  std::vector<std::size_t> origin;  // which specification a hole of the table came from
  std::vector<std::string> names;
  for (std::size_t k = 0; k < spec.holes.size(); ++k) {
    const HoleSpec& hole = spec.holes[k];
    const std::string name = name_of_hole(spec.holes, k);
    if (std::find(names.begin(), names.end(), name) != names.end()) {
      throw InputError(hole.place, "two holes are called '" + name + "'", "a name of its own");
    }
    names.push_back(name);
    Opening(hole, name, table).cut();
    origin.resize(table.holes.size(), k);
  }
  for (Wall& wall : table.walls) {
    const auto hole = [&](int index) -> const Hole& {
      return table.holes[static_cast<std::size_t>(index)];
    };
    std::sort(wall.holes.begin(), wall.holes.end(),
              [&](int a, int b) { return hole(a).from < hole(b).from; });
    for (std::size_t k = 1; k < wall.holes.size(); ++k) {
      const int before = wall.holes[k - 1], after = wall.holes[k];
      if (hole(after).from >= hole(before).to) continue;
      const int later = std::max(before, after), earlier = std::min(before, after);
      throw InputError(spec.holes[origin[static_cast<std::size_t>(later)]].center.place(),
                       "the hole '" + hole(later).name + "' overlaps '" + hole(earlier).name +
                           "' on wall '" + wall.name + "'",
                       "holes that are apart");
    }
  }
}

void add_laws(const TableSpec& spec, Table& table) {
  for (const WallLawSpec& law : spec.laws) {
    if (law.temperature > 0.0 && !table.regions.empty())
      throw InputError(law.place, "walls that change speeds beside regions that change them",
                       "another law, or no [[table.region]]");
    std::vector<bool> meant;
    for (const Wall& wall : table.walls) meant.push_back(law.wall.empty() && !is_passed(wall));
    // The edge of a region that is given a law is a wall, from either side; its inner side may then
    // get another one.
    if (!law.wall.empty()) {
      for (const int k : walls_named(law.wall, law.wall_place, table)) {
        const Wall& wall = table.wall(k);
        meant[static_cast<std::size_t>(k)] = true;
        if (wall.twin >= 0 && !(wall.closed && is_inner_side(table, k)))
          meant[static_cast<std::size_t>(wall.twin)] = true;
      }
    }
    for (std::size_t k = 0; k < table.walls.size(); ++k) {
      if (!meant[k]) continue;
      Wall& wall = table.walls[k];
      wall.closed = wall.twin >= 0;
      wall.specularity = law.specularity;
      wall.roughness = law.roughness;
      wall.temperature = law.temperature;
    }
  }
}

}  // namespace carom::table::shapes
