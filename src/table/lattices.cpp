// Discs: Sinai's billiard, Lorentz gases, discs in the open plane, and [lattice].
#include <algorithm>
#include <cstdio>
#include <stdexcept>

#include "carom/geometry/hull.hpp"
#include "carom/geometry/lattice_copies.hpp"
#include "table/numbers.hpp"
#include "table/shapes.hpp"

namespace carom::shapes {
namespace {

using geometry::Circle;
using geometry::Vector;

std::string shown(Vector v) {
  char text[64];
  std::snprintf(text, sizeof text, "[%.9g, %.9g]", v.x, v.y);
  return text;
}

// Cells are counted along the vectors as written. Where these are far longer than the lattice needs, the next
// cell has large numbers, and displacements are differences of much larger ones.
void refuse_long_vectors(const geometry::Lattice& lattice, const Place& place) {
  constexpr std::int64_t most = 1024;
  const auto large = [](std::int64_t n) { return n > most || n < -most; };
  if (std::none_of(lattice.edges.begin(), lattice.edges.end(),
                   [&](const geometry::CellEdge& e) { return large(e.beyond.first) || large(e.beyond.second); }))
    return;
  const auto [first, second] = geometry::shortest_cells(lattice);
  throw InputError(place,
                   "the lattice vectors are more than " + std::to_string(most) +
                       " times as long as it needs, or nearly parallel",
                   "shorter vectors of the same lattice: " + shown(geometry::displacement(lattice, first)) + " and " +
                       shown(geometry::displacement(lattice, second)));
}

void set_lattice(Table& table, Vector first, Vector second, Vector centre, const Place& place) {
  try {
    table.lattice = geometry::make_lattice(first, second, centre);
  } catch (const std::invalid_argument&) {
    throw InputError(place, "the lattice vectors are parallel or zero", "two vectors that span the plane");
  }
  refuse_long_vectors(*table.lattice, place);
  table.extent = Extent::lattice;
}

std::vector<double> radii_of(const TableSpec& spec, std::size_t count) {
  const auto list = spec.lists.find("radii");
  if (list == spec.lists.end()) {
    return std::vector<double>(count, size(spec, "radius"));
  }
  const auto single = spec.numbers.find("radius");
  if (single != spec.numbers.end()) {
    throw InputError(single->second.place(), "radius and radii are both given", "one of them");
  }
  if (list->second.size() != count) {
    throw InputError(list->second.empty() ? place_of(spec, "radii") : list->second.front().place(),
                     std::to_string(list->second.size()) + " radii for " + std::to_string(count) + " centers",
                     "one radius for each center");
  }
  std::vector<double> radii;
  for (const ExactNumber& r : list->second) radii.push_back(size_of(r, "radius"));
  return radii;
}

}  // namespace

void sinai(const TableSpec& spec, Table& table) {
  const double side = size(spec, "side");
  const ExactNumber& radius_number = number(spec, "radius");
  const double radius = size_of(radius_number, "radius");
  if (2 * radius > side) {
    throw InputError(radius_number.place(), "the disc does not fit into the square", "radius <= side/2");
  }
  const Vector middle{side / 2, side / 2};
  add_loop(table, {{"disc", Circle{middle, radius, false}}});
  close_square(table, side, spec);
}

void close_square(Table& table, double side, const TableSpec& spec) {
  if (spec.torus) {
    set_lattice(table, {side, 0}, {0, side}, {side / 2, side / 2}, spec.place);
  } else {
    add_polygon(table, {"bottom", "right", "top", "left"}, {{0, 0}, {side, 0}, {side, side}, {0, side}});
  }
}

void lorentz(const TableSpec& spec, Table& table) {
  const ExactNumber& spacing_number = number(spec, "spacing");
  const double spacing = size_of(spacing_number, "spacing");
  const ExactNumber& radius_number = number(spec, "radius");
  const double radius = size_of(radius_number, "radius");
  if (2 * radius > spacing) {
    throw InputError(radius_number.place(), "neighbouring discs overlap", "radius <= spacing/2");
  }
  const auto word = spec.words.find("lattice");
  const std::string lattice = word == spec.words.end() ? "triangular" : word->second;
  add_loop(table, {{"disc_1", Circle{Vector{0, 0}, radius, false}}});
  if (lattice == "triangular") {
    const double height = derived(quoted(spacing_number) + "*sqrt(3)/2", spacing_number).to_double();
    set_lattice(table, {spacing, 0}, {spacing / 2, height}, {0, 0}, spec.place);
  } else if (lattice == "square") {
    set_lattice(table, {spacing, 0}, {0, spacing}, {0, 0}, spec.place);
  } else {
    throw InputError(place_of(spec, "lattice"), "unknown lattice '" + lattice + "'",
                     "\"triangular\" or \"square\"", nearest_name(lattice, {"triangular", "square"}));
  }
}

void discs(const TableSpec& spec, Table& table) {
  const auto centers = spec.points.find("centers");
  if (centers == spec.points.end() || centers->second.empty()) {
    throw InputError(place_of(spec, "centers"), "the shape 'discs' needs 'centers'",
                     "a list of points [x, y]");
  }
  const std::vector<double> radii = radii_of(spec, centers->second.size());
  const std::vector<std::string> names = numbered("disc", radii.size());
  for (std::size_t k = 0; k < radii.size(); ++k) {
    add_loop(table, {{names[k], Circle{point(centers->second[k]), radii[k], false}}});
  }
  table.extent = Extent::open_plane;
}

void plane(const TableSpec&, Table& table) { table.extent = Extent::open_plane; }

void repeat(const LatticeSpec& lattice, Table& table) {
  if (table.extent == Extent::lattice) {
    throw InputError(lattice.place, "the shape '" + table.shape + "' has a lattice of its own",
                     "no [lattice] here");
  }
  if (table.extent == Extent::bounded) {
    throw InputError(lattice.place, "the table is closed by its walls, nothing leads to another cell",
                     "[lattice] with obstacles in the open plane: discs, or a path of clockwise loops");
  }
  if (table.walls.empty())
    return set_lattice(table, point(lattice.first), point(lattice.second), {0, 0}, lattice.place);
  const geometry::Box box =
      geometry::hull_of(table.walls, [](const Wall& wall) { return geometry::bounding_box(wall.curve); });
  const Vector centre{box.low.x / 2 + box.high.x / 2, box.low.y / 2 + box.high.y / 2};
  set_lattice(table, point(lattice.first), point(lattice.second), centre, lattice.place);
}

}  // namespace carom::shapes
