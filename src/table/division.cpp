// A table is divided into regions: parts of it, or obstacles that particles enter.
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/index.hpp"
#include "carom/geometry/hull.hpp"
#include "carom/geometry/region.hpp"
#include "table/closed_curves.hpp"
#include "table/flat_arcs.hpp"
#include "table/numbers.hpp"
#include "table/shapes.hpp"

namespace carom::table::shapes {
namespace {

using base::at;
using geometry::Vector;

Region region_of(const RegionSpec& spec) {
  Region region;
  if (spec.field) region.field = spec.field->to_double();
  region.index = spec.index.to_double();
  region.potential = spec.potential.to_double();
  if (!(region.index > 0.0 && std::isfinite(region.index)))
    throw InputError(spec.index.place(), "a refractive index is above 0", "a positive number");
  if (region.index != 1.0 && region.potential != 0.0)
    throw InputError(spec.potential.place(), "a region has an index or a potential", "one of them");
  using enum Region::Reflection;
  const std::string& mirrored = spec.reflection.text;
  region.reflection = mirrored.empty() || mirrored == "none" ? none
                      : mirrored == "s"                      ? s
                      : mirrored == "p"                      ? p
                                                             : typed;
  if (region.reflection == p && region.potential != 0.0)
    throw InputError(spec.place, "a potential has no polarisation", "reflection = \"s\"");
  if (region.reflection != typed) return region;
  const std::vector<std::string> variables{"incidence", "refraction", "n"};
  const bool word = mirrored.find_first_of("0123456789.+-*/^()") == std::string::npos;
  if (word && std::find(variables.begin(), variables.end(), mirrored) == variables.end())
    throw InputError(spec.reflection.place, "unknown reflection '" + mirrored + "'",
                     "none, s, p, or a formula in incidence, refraction and n");
  region.fraction = TypedExpression::parse(mirrored, variables, {}, spec.reflection.place);
  return region;
}

std::string text_of(const ExactPoint& p) { return "(" + p.x.text() + ", " + p.y.text() + ")"; }

/// Walls keep their numbers while others are added; at the end they are put in order, region by
/// region.
class Division {
 public:
  Division(const TableSpec& spec, Table& table)
      : spec_(spec), table_(table), whole_(table), ring_of_(table.walls.size(), -1) {
    for (const Wall& one : table.walls) names_.insert(one.name);
    for (int w = 0; w < static_cast<int>(table.walls.size()); ++w)
      if (ring_of_[at(w)] < 0) add({-1, walls_from(w, w), {}});
  }

  void run(bool nested) {
    bool whole = !nested;
    // Obstacles first: their loops are still those that were written.
    for (const bool obstacles : {true, false})
      for (std::size_t r = 0; r < spec_.regions.size(); ++r) {
        const RegionSpec& one = spec_.regions[r];
        if (one.wall.empty() == obstacles) continue;
        if (obstacles) {
          enter(one, static_cast<int>(r));
        } else {
          cut_off(one, static_cast<int>(r));
          whole = false;
        }
      }
    for (const RegionSpec& one : spec_.regions) table_.regions.push_back(region_of(one));
    put_in_order();
    if (whole) return;  // obstacles apart from each other are parts that have been checked
    for (int r = -1; r < static_cast<int>(table_.regions.size()); ++r)
      if (const Table part = seen_from(table_, r); !part.walls.empty())
        check_part(part, [&](const std::string& name) { return place_of(name); });
  }

 private:
  /// A closed loop of walls, in any order.
  struct Ring {
    int region;
    std::vector<int> walls;
    geometry::Box box;
  };

  Wall& wall(int w) { return table_.walls[at(w)]; }
  int walls() const { return static_cast<int>(table_.walls.size()); }

  /// The walls from one on to the next that begins where `end` does.
  std::vector<int> walls_from(int w, int end) const {
    std::vector<int> walls;
    do walls.push_back(w);
    while ((w = table_.walls[at(w)].next) != end);
    return walls;
  }

  void add_to(geometry::Loop& loop, const std::vector<int>& walls) const {
    for (const int w : walls) loop.push_back({table_.walls[at(w)].name, table_.walls[at(w)].curve});
  }
  geometry::Loop loop_of(const Ring& ring) const {
    geometry::Loop loop;
    add_to(loop, walls_from(ring.walls.front(), ring.walls.front()));
    return loop;
  }

  /// A name for a new wall.
  void take(const std::string& name, const Place& place) {
    if (!names_.insert(name).second)
      throw InputError(place, "two walls are called '" + name + "'", "a name of its own for each");
  }

  void set(int index, Ring ring) {
    ring.box = geometry::hull_of(
        ring.walls, [&](int w) { return geometry::bounding_box(table_.walls[at(w)].curve); });
    for (const int w : ring.walls) ring_of_[at(w)] = index;
    rings_[at(index)] = std::move(ring);
  }
  void add(Ring ring) {
    ring_of_.resize(table_.walls.size(), -1);
    rings_.emplace_back();
    set(static_cast<int>(rings_.size()) - 1, std::move(ring));
  }

  /// What lies within a ring goes to another region, except the ring `beside`.
  void move_contents(int around, int beside, int to) {
    const Ring& outer = rings_[at(around)];
    const int from = rings_[at(beside)].region;
    geometry::Loop outline;
    for (int k = 0; k < static_cast<int>(rings_.size()); ++k) {
      Ring& ring = rings_[at(k)];
      // Boxes are larger than what is in them: whether one is in the other does not tell.
      if (k == around || k == beside || ring.region != from ||
          !geometry::overlap(ring.box, outer.box))
        continue;
      if (outline.empty()) outline = loop_of(outer);
      if (geometry::lies_inside(loop_of(ring), outline)) ring.region = to;
    }
  }

  /// An obstacle gets walls within.
  void enter(const RegionSpec& one, int region) {
    const std::vector<int> all = walls_named(one.wall, one.wall_place, table_);
    const int named = all.front();
    for (const int k : all)
      if (ring_of_[at(k)] != ring_of_[at(named)])
        throw InputError(
            one.wall_place,
            "the walls '" + one.wall + "_1', '" + one.wall + "_2' … belong to several obstacles",
            "a region for each obstacle");
    const std::vector<int> loop = walls_from(named, named);
    if (wall(named).twin >= 0)
      throw InputError(one.wall_place, "wall '" + one.wall + "' bounds another region already",
                       "a region for each obstacle");
    const int around = ring_of_[at(named)];
    if (geometry::runs_counterclockwise(loop_of(rings_[at(around)])))
      throw InputError(one.wall_place, "wall '" + one.wall + "' is the table's outer wall",
                       "a wall of an obstacle");
    const int first = walls(), count = static_cast<int>(loop.size());
    Ring within{region, {}, {}};
    for (int k = 0; k < count; ++k) {
      Wall inside;
      inside.name = wall(loop[at(k)]).name + ".inside";
      take(inside.name, one.wall_place);
      inside.curve = geometry::reversed(wall(loop[at(k)]).curve);
      inside.next = first + (k + count - 1) % count;
      inside.previous = first + (k + 1) % count;
      inside.twin = loop[at(k)];
      wall(loop[at(k)]).twin = first + k;
      within.walls.push_back(walls());
      table_.walls.push_back(std::move(inside));
    }
    add(std::move(within));
    move_contents(static_cast<int>(rings_.size()) - 1, around, region);
  }

  /// Where a cut begins and ends: the walls that begin there.
  struct Cut {
    int from = -1, to = -1;
  };

  Cut find_cut(const RegionSpec& one, const std::vector<Wall>& edge) const {
    const Vector start = geometry::start_point(edge.front().curve),
                 end = geometry::end_point(edge.back().curve);
    if (start == end)
      throw InputError(one.place, "the edge ends where it begins",
                       "another corner, or an obstacle as a region");
    bool starts = false, ends = false, joined = false;
    std::string crossing;
    const auto is_part = [&](const geometry::Loop& loop, bool counterclockwise) {
      using geometry::RegionKind;
      const auto faults = geometry::check_region(
          {loop}, counterclockwise ? RegionKind::bounded : RegionKind::open, std::nullopt, 1);
      if (!faults.empty() && faults.front().kind == geometry::RegionFault::Kind::crossing)
        crossing = faults.front().sentence;
      return faults.empty();
    };
    for (const Ring& ring : rings_) {
      Cut cut;
      for (const int w : ring.walls) {
        const geometry::Curve& curve = table_.walls[at(w)].curve;
        if (geometry::is_closed(curve)) continue;
        if (geometry::start_point(curve) == start) cut.from = w;
        if (geometry::start_point(curve) == end) cut.to = w;
      }
      starts = starts || cut.from >= 0;
      ends = ends || cut.to >= 0;
      if (cut.from < 0 || cut.to < 0) continue;
      joined = true;
      const bool around = geometry::runs_counterclockwise(loop_of(ring));
      if (is_part(left_of(edge, cut), true) && is_part(right_of(edge, cut), around)) return cut;
    }
    const char* const corner = "a point at which a wall of the table begins";
    if (!starts)
      throw InputError(one.edge.start.x.place(),
                       "the edge begins at " + text_of(one.edge.start) + ", where no corner is",
                       corner);
    if (!ends)
      throw InputError(
          one.edge.pieces.back().place,
          "the edge ends at " + text_of(one.edge.pieces.back().to) + ", where no corner is",
          corner);
    if (!joined)
      throw InputError(one.place, "the corners at the ends of the edge are of different parts",
                       "two corners of one closed line of walls, which the edge divides");
    if (!crossing.empty())
      throw InputError(one.place, crossing, "an edge that crosses and touches nothing");
    throw InputError(one.place, "no part of the table is on the left of the edge",
                     "an edge within the table, with the region on its left");
  }

  /// The two parts of a closed line of walls that an edge divides.
  geometry::Loop left_of(const std::vector<Wall>& edge, const Cut& cut) const {
    geometry::Loop loop;
    for (const Wall& w : edge) loop.push_back({w.name, w.curve});
    add_to(loop, walls_from(cut.to, cut.from));
    return loop;
  }
  geometry::Loop right_of(const std::vector<Wall>& edge, const Cut& cut) const {
    geometry::Loop loop;
    for (auto w = edge.rbegin(); w != edge.rend(); ++w)
      loop.push_back({w->name, geometry::reversed(w->curve)});
    add_to(loop, walls_from(cut.from, cut.to));
    return loop;
  }

  /// The names of pieces without one: "region_2", or of several "region_2_1", "region_2_2" …
  Chain edge_of(const RegionSpec& one, int region) {
    if (one.edge.pieces.empty())
      throw InputError(one.place, "the edge has no pieces", "a list of pieces");
    const std::string own = "region_" + std::to_string(region + 1);
    Chain chain = chain_of_pieces(one.edge, [&](std::size_t k) {
      return one.edge.pieces.size() == 1 ? own : own + "_" + std::to_string(k + 1);
    });
    for (std::size_t k = 0; k < chain.size(); ++k)
      for (const char* side : {"", ".inside"}) take(chain[k].name + side, one.edge.pieces[k].place);
    return chain;
  }

  /// The part of the table on the left of an edge becomes a region.
  void cut_off(const RegionSpec& one, int region) {
    const Chain chain = edge_of(one, region);
    const int count = static_cast<int>(chain.size()), first = walls();
    const FlightSizes sizes = flight_sizes(whole_);
    std::vector<Wall> edge;
    for (const NamedCurve& piece : chain) {
      edge.emplace_back();
      edge.back().name = piece.name;
      edge.back().curve = rounded(piece.curve);
      const Place& place = one.edge.pieces[edge.size() - 1].place;
      place_of_edge_[piece.name] = place;
      if (const Misplaced found = misplaced(edge.back(), sizes); !found.fault.empty())
        throw InputError(place, found.fault, found.expected);
    }
    const Cut cut = find_cut(one, edge);
    const int last_left = wall(cut.from).previous, last_right = wall(cut.to).previous;
    const std::vector<int> left = walls_from(cut.to, cut.from);
    Ring outer{-1, walls_from(cut.from, cut.to), {}}, inner{region, {}, {}};
    for (int k = 0; k < count; ++k) {  // as they are written, with the region on the left
      Wall inside = edge[at(k)];
      inside.name += ".inside";
      inside.previous = k > 0 ? first + k - 1 : last_left;
      inside.next = k + 1 < count ? first + k + 1 : cut.to;
      inside.twin = first + count + k;
      inner.walls.push_back(first + k);
      table_.walls.push_back(std::move(inside));
    }
    for (int k = 0; k < count; ++k) {
      Wall& outside = edge[at(k)];
      outside.curve = geometry::reversed(outside.curve);
      outside.previous = k + 1 < count ? first + count + k + 1 : last_right;
      outside.next = k > 0 ? first + count + k - 1 : cut.from;
      outside.twin = first + k;
      outer.walls.push_back(first + count + k);
      table_.walls.push_back(std::move(outside));
    }
    wall(last_left).next = first;
    wall(last_right).next = first + 2 * count - 1;
    wall(cut.to).previous = first + count - 1;
    wall(cut.from).previous = first + count;
    wall(cut.to).corner = wall(cut.from).corner = 0;
    inner.walls.insert(inner.walls.end(), left.begin(), left.end());
    const int divided = ring_of_[at(cut.from)];
    outer.region = rings_[at(divided)].region;
    ring_of_.resize(table_.walls.size(), -1);
    set(divided, std::move(outer));
    add(std::move(inner));
    move_contents(static_cast<int>(rings_.size()) - 1, divided, region);
  }

  void put_in_order() {
    std::vector<int> order;
    for (int r = -1; r < static_cast<int>(table_.regions.size()); ++r) {
      const int first = static_cast<int>(order.size());
      for (const Ring& ring : rings_)
        if (ring.region == r) order.insert(order.end(), ring.walls.begin(), ring.walls.end());
      std::sort(order.begin() + first, order.end());
      if (r < 0) continue;
      table_.regions[at(r)].first = first;
      table_.regions[at(r)].count = static_cast<int>(order.size()) - first;
    }
    std::vector<int> now(order.size());
    for (int k = 0; k < walls(); ++k) now[at(order[at(k)])] = k;
    std::vector<Wall> ordered;
    for (const int w : order) {
      Wall& one = ordered.emplace_back(std::move(wall(w)));
      one.next = now[at(one.next)];
      one.previous = now[at(one.previous)];
      if (one.twin >= 0) one.twin = now[at(one.twin)];
    }
    table_.walls = std::move(ordered);
  }

  Place place_of(const std::string& name) const {
    const std::string own = name.ends_with(".inside") ? name.substr(0, name.rfind('.')) : name;
    if (const int w = whole_.wall_index(own); w >= 0) return place_of_wall(spec_, whole_, at(w));
    const auto found = place_of_edge_.find(own);
    return found == place_of_edge_.end() ? spec_.place : found->second;
  }

  const TableSpec& spec_;
  Table& table_;
  const Table whole_;  ///< as it was, with its walls where they were written
  std::set<std::string> names_;
  std::map<std::string, Place> place_of_edge_;
  std::vector<int> ring_of_;
  std::vector<Ring> rings_;
};

}  // namespace

void divide(const TableSpec& spec, Table& table, bool nested) { Division(spec, table).run(nested); }

}  // namespace carom::table::shapes
