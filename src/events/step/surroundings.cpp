#include "events/step/surroundings.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "carom/base/error.hpp"
#include "carom/geometry/hull.hpp"
#include "carom/geometry/lattice_copies.hpp"
#include "events/step/barriers_of.hpp"
#include "events/step/group.hpp"

namespace carom::events {

using geometry::Box;
using geometry::Cell;
using geometry::Curve;
using geometry::Lattice;
using geometry::Vector;

namespace {

/// Boxes in which particles begin their steps on a lattice, widened by the way that these may lead.
/// Most begin near the cell's centre, to which they are folded; but at a hit a particle stays where
/// its wall was written, be it many cells away. One box for all walls of a cell.
std::vector<Box> ways_of_steps(const Table& table) {
  const Lattice& lattice = *table.lattice;
  struct Place {
    Cell cell;
    Box box;
  };
  std::vector<Place> places;
  places.push_back({Cell{}, geometry::hull_of(lattice.edges, [](const auto& e) {
                      return Box{e.segment.from, e.segment.from};
                    })});
  const Vector centre = centre_of_cell(lattice);
  for (const Wall& wall : table.walls) {
    const Box box = geometry::bounding_box(wall.curve);
    Vector middle = 0.5 * (box.low + box.high);
    Cell cell;
    fold_towards_centre(lattice, centre, middle, cell);
    const auto known = std::find_if(places.begin(), places.end(),
                                    [&](const Place& place) { return place.cell == cell; });
    if (known == places.end())
      places.push_back({cell, box});
    else
      known->box = geometry::hull(known->box, box);
  }
  const double way = longest_way(table);
  std::vector<Box> boxes;
  for (const Place& place : places)
    boxes.push_back({place.box.low - Vector{way, way}, place.box.high + Vector{way, way}});
  return boxes;
}

/// The cells whose copies of the curve reach into one of the boxes, ordered.
std::vector<Cell> cells_of_copies(const Curve& curve, const Lattice& lattice,
                                  const std::vector<Box>& boxes) {
  constexpr std::size_t most = 65536;
  std::vector<Cell> cells;
  for (const Box& box : boxes) {
    const auto found =
        geometry::cells_that_reach(lattice, geometry::bounding_box(curve), box, most);
    if (!found)
      throw InputError("more than " + std::to_string(most) +
                       " copies of a wall or support are within one step of a particle: it is too "
                       "wide for its lattice");
    cells.insert(cells.end(), found->begin(), found->end());
  }
  std::sort(cells.begin(), cells.end(), [](const Cell& a, const Cell& b) {
    return a.first != b.first ? a.first < b.first : a.second < b.second;
  });
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  return cells;
}

/// Of several curves, all copies that a particle may meet: `make` gives a displaced curve's.
template <class CurveOf, class Make>
std::vector<Barrier<double>> with_copies(const Table& table, std::size_t count,
                                         const CurveOf& curve_of, const Make& make) {
  std::vector<Barrier<double>> barriers;
  const std::vector<Box> boxes = table.lattice ? ways_of_steps(table) : std::vector<Box>{};
  for (std::size_t i = 0; i < count; ++i) {
    const std::vector<Cell> cells =
        table.lattice ? cells_of_copies(curve_of(i), *table.lattice, boxes) : std::vector{Cell{}};
    for (const Cell& cell : cells)
      for (Barrier<double>& b :
           make(i, table.lattice ? table.lattice->translation(cell) : Vector{})) {
        b.wall = static_cast<int>(i);
        b.cell = cell;
        barriers.push_back(std::move(b));
      }
  }
  return barriers;
}

}  // namespace

std::vector<Barrier<double>> barriers_of_edges(std::span<const Curve> edges, const Table& table) {
  return with_copies(
      table, edges.size(), [&](std::size_t i) -> const Curve& { return edges[i]; },
      [&](std::size_t i, Vector shift) { return barriers_of<double>(edges[i], shift); });
}

std::vector<Barrier<double>> barriers_of(const Table& table) {
  return with_copies(
      table, table.walls.size(),
      [&](std::size_t i) -> const Curve& { return table.walls[i].curve; },
      [&](std::size_t i, Vector shift) {
        return barriers_of<double>(table, static_cast<int>(i), shift);
      });
}

bool in_some_support(std::span<const Barrier<double>> supports, Vector x,
                     const Barrier<double>* except) {
  return std::any_of(supports.begin(), supports.end(), [&](const Barrier<double>& b) {
    const bool same = except && b.wall == except->wall && b.cell == except->cell;
    return !same && b.gap(x) > -b.slack;
  });
}

double longest_way(const Table& table) {
  double length = std::numeric_limits<double>::infinity();
  if (table.lattice) {
    for (const geometry::CellEdge& e : table.lattice->edges) {
      const Vector t = table.lattice->translation(e.beyond);
      length = std::min(length, std::sqrt(dot(t, t)));
    }
  } else if (table.extent == Extent::bounded) {
    length = 0.0;
    for (const Wall& wall : table.walls) {
      const Box box = geometry::bounding_box(wall.curve);
      length = std::max({length, box.high.x - box.low.x, box.high.y - box.low.y});
    }
    length *= 1000.0;
  }
  return length;
}

}  // namespace carom::events
