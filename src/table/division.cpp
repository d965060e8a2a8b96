// A table is divided into regions: parts of it, or obstacles that particles enter.
#include <algorithm>
#include <cmath>
#include <map>
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
  if (spec.reflection == "s") region.reflection = Region::Reflection::s;
  if (spec.reflection == "p") {
    region.reflection = Region::Reflection::p;
    if (region.potential != 0.0)
      throw InputError(spec.place, "a potential has no polarisation", "reflection = \"s\"");
  }
  return region;
}

std::string text_of(const ExactPoint& p) { return "(" + p.x.text() + ", " + p.y.text() + ")"; }

/// Walls keep their numbers while others are added; at the end they are put in order, region by
/// region.
class Division {
 public:
  Division(const TableSpec& spec, Table& table)
      : spec_(spec), table_(table), whole_(table), ring_of_(table.walls.size(), -1) {
    for (int w = 0; w < static_cast<int>(table.walls.size()); ++w)
      if (ring_of_[at(w)] < 0) add({-1, walls_from(w, w), {}});
  }

  void run(bool nested) {
    bool whole = !nested;
    for (std::size_t r = 0; r < spec_.regions.size(); ++r) {
      const RegionSpec& one = spec_.regions[r];
      table_.regions.push_back(region_of(one));
      if (!one.wall.empty()) {
        enter(one, static_cast<int>(r));
      } else {
        cut_off(one, static_cast<int>(r));
        whole = false;
      }
    }
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

  double area_of(const std::vector<int>& walls) const {
    double area = 0.0;
    for (const int w : walls) area += geometry::area_integral(table_.walls[at(w)].curve);
    return area;
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

  /// What lies within a ring of one region goes to another.
  void move_contents(int around, int from, int to) {
    const Ring& outer = rings_[at(around)];
    const auto loop_of = [&](const Ring& ring) {
      geometry::Loop loop;
      for (const int w : walls_from(ring.walls.front(), ring.walls.front()))
        loop.push_back({wall(w).name, wall(w).curve});
      return loop;
    };
    geometry::Loop outline;
    for (int k = 0; k < static_cast<int>(rings_.size()); ++k) {
      Ring& ring = rings_[at(k)];
      const auto &low = ring.box.low, &high = ring.box.high;
      if (k == around || ring.region != from || low.x < outer.box.low.x ||
          low.y < outer.box.low.y || high.x > outer.box.high.x || high.y > outer.box.high.y)
        continue;
      if (outline.empty()) outline = loop_of(outer);
      if (geometry::lies_inside(loop_of(ring), outline)) ring.region = to;
    }
  }

  /// An obstacle gets walls within.
  void enter(const RegionSpec& one, int region) {
    const int named = named_wall(one.wall, one.wall_place, table_);
    const std::vector<int> loop = walls_from(named, named);
    for (const int w : loop)
      if (wall(w).twin >= 0)
        throw InputError(one.wall_place,
                         "wall '" + wall(w).name + "' bounds another region already",
                         "a region for each obstacle");
    // Obstacles run clockwise, which the check of the region has decided exactly.
    if (area_of(loop) > 0.0)
      throw InputError(one.wall_place, "wall '" + one.wall + "' is the table's outer wall",
                       "a wall of an obstacle");
    const int first = walls(), count = static_cast<int>(loop.size());
    Ring within{region, {}, {}};
    for (int k = 0; k < count; ++k) {
      Wall inside;
      inside.name = wall(loop[at(k)]).name + ".inside";
      inside.curve = geometry::reversed(wall(loop[at(k)]).curve);
      inside.next = first + (k + count - 1) % count;
      inside.previous = first + (k + 1) % count;
      inside.twin = loop[at(k)];
      wall(loop[at(k)]).twin = first + k;
      within.walls.push_back(walls());
      table_.walls.push_back(std::move(inside));
    }
    add(std::move(within));
    const int around = ring_of_[at(named)];
    move_contents(around, rings_[at(around)].region, region);
  }

  /// Where a cut begins and ends: the walls that begin there.
  struct Cut {
    int from = -1, to = -1;
  };

  Cut find_cut(const RegionSpec& one, double area_of_edge) const {
    const Vector start = point(one.edge.start), end = point(one.edge.pieces.back().to);
    bool starts = false, ends = false, joined = false;
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
      if (cut.from < 0 || cut.to < 0 || cut.from == cut.to) continue;
      joined = true;
      const double left = area_of_edge + area_of(walls_from(cut.to, cut.from)),
                   right = area_of(walls_from(cut.from, cut.to)) - area_of_edge;
      if (left > 0.0 && (right > 0.0) == (left + right > 0.0)) return cut;
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
      throw InputError(one.place, "the edge leads from one closed line of walls to another",
                       "two corners of the same: the edge divides what they bound");
    throw InputError(one.place, "no part of the table is on the left of the edge",
                     "an edge within the table, with the region on its left");
  }

  /// The names of pieces without one: "region_2", or of several "region_2_1", "region_2_2" …
  Chain edge_of(const RegionSpec& one, int region) const {
    const std::string own = "region_" + std::to_string(region + 1);
    Chain chain = chain_of_pieces(one.edge, [&](std::size_t k) {
      return one.edge.pieces.size() == 1 ? own : own + "_" + std::to_string(k + 1);
    });
    for (std::size_t k = 0; k < chain.size(); ++k)
      if (table_.wall_index(chain[k].name) >= 0)
        throw InputError(one.edge.pieces[k].place, "two walls are called '" + chain[k].name + "'",
                         "a name of its own for each");
    return chain;
  }

  /// The part of the table on the left of an edge becomes a region.
  void cut_off(const RegionSpec& one, int region) {
    const Chain chain = edge_of(one, region);
    const int count = static_cast<int>(chain.size()), first = walls();
    const FlightSizes sizes = flight_sizes(whole_);
    double area = 0.0;
    std::vector<Wall> edge;
    for (const NamedCurve& piece : chain) {
      edge.emplace_back();
      edge.back().name = piece.name;
      edge.back().curve = rounded(piece.curve);
      area += geometry::area_integral(edge.back().curve);
      const Place& place = one.edge.pieces[edge.size() - 1].place;
      place_of_edge_[piece.name] = place;
      if (const Misplaced found = misplaced(edge.back(), sizes); !found.fault.empty())
        throw InputError(place, found.fault, found.expected);
    }
    const Cut cut = find_cut(one, area);
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
    const int divided = ring_of_[at(cut.from)], from = rings_[at(divided)].region;
    outer.region = from;
    ring_of_.resize(table_.walls.size(), -1);
    set(divided, std::move(outer));
    add(std::move(inner));
    move_contents(static_cast<int>(rings_.size()) - 1, from, region);
  }

  void put_in_order() {
    std::vector<int> order;
    for (int r = -1; r < static_cast<int>(table_.regions.size()); ++r) {
      const int first = static_cast<int>(order.size());
      for (const Ring& ring : rings_)
        if (ring.region == r) order.insert(order.end(), ring.walls.begin(), ring.walls.end());
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
  std::map<std::string, Place> place_of_edge_;
  std::vector<int> ring_of_;
  std::vector<Ring> rings_;
};

}  // namespace

void divide(const TableSpec& spec, Table& table, bool nested) { Division(spec, table).run(nested); }

}  // namespace carom::table::shapes
