// Holes: arc lengths along a wall become parameters of its curve.
#include <algorithm>
#include <cmath>
#include <limits>

#include "table/numbers.hpp"
#include "table/shapes.hpp"

namespace carom::table::shapes {
namespace {

// The length of a wall is a rounded number, while an end written as "pi" is not: ends that agree
// with the wall's to rounding mean the wall's.
bool beyond(double s, double length) {
  return s > length * (1 + 4 * std::numeric_limits<double>::epsilon());
}

class Opening {
 public:
  Opening(const HoleSpec& hole, const std::string& name, int wall, Table& table)
      : hole_(hole),
        name_(name),
        wall_(wall),
        table_(table),
        curve_(table.walls[wall_index()].curve) {
    if (table.walls[wall_index()].twin >= 0)
      throw InputError(hole.wall_place, "particles pass wall '" + hole.wall + "' of a region",
                       "a hole of another wall");
  }

  void cut() {
    const double length = geometry::length(curve_);
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
    const bool closed = geometry::is_closed(curve_);
    if (!closed && (from < 0 || beyond(to, length))) {
      throw InputError(hole_.center.place(),
                       "the hole reaches over the end of its wall '" + hole_.wall + "'",
                       "a hole within 0 … " + ExactNumber(length).text() + " of arc length");
    }
    if (closed && to - from >= length) {
      add(0.0, end());  // all of it, wherever it begins
    } else if (from < 0) {
      add(parameter(length + from, length), end());
      add(0.0, parameter(to, length));
    } else if (beyond(to, length)) {
      add(parameter(from, length), end());
      add(0.0, parameter(to - length, length));
    } else {
      add(parameter(from, length), parameter(to, length));
    }
  }

 private:
  std::size_t wall_index() const { return static_cast<std::size_t>(wall_); }
  double end() const { return geometry::end_parameter(curve_); }
  double parameter(double s, double length) const {
    if (!(s > 0)) return 0.0;
    return s < length ? geometry::parameter_at_length(curve_, s) : end();
  }
  void add(double from, double to) {
    if (!(from < to)) {
      throw InputError(hole_.width.place(), "the hole is too narrow for double precision",
                       "a wider hole");
    }
    table_.walls[wall_index()].holes.push_back(static_cast<int>(table_.holes.size()));
    table_.holes.push_back({name_, wall_, from, to, hole_.transmission});
  }

  const HoleSpec& hole_;
  const std::string& name_;
  int wall_;
  Table& table_;
  const geometry::Curve& curve_;
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
    Opening(hole, name, named_wall(hole.wall, hole.wall_place, table), table).cut();
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
    const int named = law.wall.empty() ? -1 : named_wall(law.wall, law.wall_place, table);
    // The edge of a region that is given a law is a wall, from either side; its inner side may then
    // get another one.
    const bool one = named >= 0 && table.wall(named).closed && is_inner_side(table, named);
    const int other = named < 0 || one ? -1 : table.wall(named).twin;
    for (int k = 0; k < static_cast<int>(table.walls.size()); ++k) {
      Wall& wall = table.walls[static_cast<std::size_t>(k)];
      if (named < 0 ? is_passed(wall) : k != named && k != other) continue;
      wall.closed = wall.twin >= 0;
      wall.specularity = law.specularity;
      wall.roughness = law.roughness;
      wall.temperature = law.temperature;
    }
  }
}

}  // namespace carom::table::shapes
