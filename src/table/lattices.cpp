// Discs: Sinai's billiard, Lorentz gases, discs in the open plane, and [lattice].
#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "carom/geometry/hull.hpp"
#include "carom/geometry/lattice_copies.hpp"
#include "table/numbers.hpp"
#include "table/shapes.hpp"

namespace carom::table::shapes {
namespace {

using geometry::Vector;

std::string shown_vector(Vector v) { return fmt::format("[{:.9g}, {:.9g}]", v.x, v.y); }

// Cells are counted along the vectors as written. Where these are far longer than the lattice
// needs, the next cell has large numbers, and displacements are differences of much larger ones.
void refuse_long_vectors(const geometry::Lattice& lattice, const Place& place) {
  constexpr std::int64_t most = 1024;
  const auto large = [](std::int64_t n) { return n > most || n < -most; };
  if (std::none_of(lattice.edges.begin(), lattice.edges.end(), [&](const geometry::CellEdge& e) {
        return large(e.beyond.first) || large(e.beyond.second);
      }))
    return;
  const auto [first, second] = geometry::shortest_cells(lattice);
  throw InputError(place,
                   "the lattice vectors are more than " + std::to_string(most) +
                       " times as long as it needs, or nearly parallel",
                   "shorter vectors of the same lattice: " +
                       shown_vector(geometry::displacement(lattice, first)) + " and " +
                       shown_vector(geometry::displacement(lattice, second)));
}

std::vector<ExactNumber> radii_of(const TableSpec& spec, std::size_t count) {
  const auto list = spec.lists.find("radii");
  if (list == spec.lists.end()) {
    size(spec, "radius");
    return std::vector<ExactNumber>(count, number(spec, "radius"));
  }
  const auto single = spec.numbers.find("radius");
  if (single != spec.numbers.end()) {
    throw InputError(single->second.place(), "radius and radii are both given", "one of them");
  }
  if (list->second.size() != count) {
    throw InputError(
        list->second.empty() ? place_of(spec, "radii") : list->second.front().place(),
        std::to_string(list->second.size()) + " radii for " + std::to_string(count) + " centers",
        "one radius for each center");
  }
  for (const ExactNumber& r : list->second) size_of(r, "radius");
  return list->second;
}

}  // namespace

void set_lattice(Table& table, const LatticeSpec& spec, Vector centre) {
  try {
    table.lattice = geometry::make_lattice(point(spec.first), point(spec.second), centre);
  } catch (const std::invalid_argument&) {
    throw InputError(spec.place, "the lattice vectors are parallel or zero",
                     "two vectors that span the plane");
  }
  refuse_long_vectors(*table.lattice, spec.place);
  table.extent = Extent::lattice;
}

Shape sinai(const TableSpec& spec) {
  const ExactNumber& side = number(spec, "side");
  const ExactNumber& radius = number(spec, "radius");
  if (2 * size_of(radius, "radius") > size_of(side, "side")) {
    throw InputError(radius.place(), "the disc does not fit into the square", "radius <= side/2");
  }
  Shape shape{{{{"disc", WrittenCircle{{half(side), half(side)}, radius, false}}}}};
  close_square(shape, side, spec);
  return shape;
}

void close_square(Shape& shape, const ExactNumber& side, const TableSpec& spec) {
  if (spec.torus) {
    shape.lattice = {{side, 0}, {0, side}, spec.place};
    shape.cell_centre = {half(side), half(side)};
  } else {
    add_polygon(
        shape, {"bottom", "right", "top", "left"},
        {ExactPoint{0, 0}, ExactPoint{side, 0}, ExactPoint{side, side}, ExactPoint{0, side}});
  }
}

Shape lorentz(const TableSpec& spec) {
  const ExactNumber& spacing = number(spec, "spacing");
  const ExactNumber& radius = number(spec, "radius");
  if (2 * size_of(radius, "radius") > size_of(spacing, "spacing")) {
    throw InputError(radius.place(), "neighbouring discs overlap", "radius <= spacing/2");
  }
  const auto word = spec.words.find("lattice");
  const std::string lattice = word == spec.words.end() ? "triangular" : word->second;
  Shape shape{{{{"disc_1", WrittenCircle{{}, radius, false}}}}};
  if (lattice == "triangular") {
    shape.lattice = {{spacing, 0},
                     {half(spacing), derived(quoted(spacing) + "*sqrt(3)/2", spacing)},
                     spec.place};
  } else if (lattice == "square") {
    shape.lattice = {{spacing, 0}, {0, spacing}, spec.place};
  } else {
    throw InputError(place_of(spec, "lattice"), "unknown lattice '" + lattice + "'",
                     "\"triangular\" or \"square\"",
                     nearest_name(lattice, {"triangular", "square"}));
  }
  return shape;
}

Shape discs(const TableSpec& spec) {
  const auto centers = spec.points.find("centers");
  if (centers == spec.points.end() || centers->second.empty()) {
    throw InputError(place_of(spec, "centers"), "the shape 'discs' needs 'centers'",
                     "a list of points [x, y]");
  }
  const std::vector<ExactNumber> radii = radii_of(spec, centers->second.size());
  const std::vector<std::string> names = numbered("disc", radii.size());
  Shape shape;
  for (std::size_t k = 0; k < radii.size(); ++k)
    shape.loops.push_back({{names[k], WrittenCircle{centers->second[k], radii[k], false}}});
  shape.extent = Extent::open_plane;
  return shape;
}

Shape plane(const TableSpec&) { return {{}, Extent::open_plane}; }

void repeat(const LatticeSpec& lattice, Table& table) {
  if (table.extent == Extent::lattice) {
    throw InputError(lattice.place, "the shape '" + table.shape + "' has a lattice of its own",
                     "no [lattice] here");
  }
  if (table.extent == Extent::bounded) {
    throw InputError(
        lattice.place, "the table is closed by its walls, so no particle reaches another cell",
        "[lattice] with obstacles in the open plane: discs, or a path of clockwise loops");
  }
  if (table.walls.empty()) return set_lattice(table, lattice, {0, 0});
  const geometry::Box box = geometry::hull_of(
      table.walls, [](const Wall& wall) { return geometry::bounding_box(wall.curve); });
  const Vector centre{box.low.x / 2 + box.high.x / 2, box.low.y / 2 + box.high.y / 2};
  set_lattice(table, lattice, centre);
}

}  // namespace carom::table::shapes
