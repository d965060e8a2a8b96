// From a specification to a table.
#include <algorithm>
#include <set>
#include <utility>

#include "table/numbers.hpp"
#include "table/shapes.hpp"

namespace carom {

using namespace table;

namespace table::shapes {

std::vector<std::string> numbered(const std::string& stem, std::size_t count) {
  std::vector<std::string> names;
  for (std::size_t k = 1; k <= count; ++k) names.push_back(stem + "_" + std::to_string(k));
  return names;
}

}  // namespace table::shapes

namespace {

using Builder = shapes::Shape (*)(const TableSpec&);
const std::pair<const char*, Builder> builders[] = {
    {"rectangle", shapes::rectangle},
    {"polygon", shapes::polygon},
    {"triangle", shapes::polygon},
    {"regular", shapes::regular},
    {"circle", shapes::circle},
    {"ellipse", shapes::ellipse},
    {"annulus", shapes::annulus},
    {"stadium", shapes::stadium},
    {"mushroom", shapes::mushroom},
    {"lemon", shapes::lemon},
    {"sinai", shapes::sinai},
    {"lorentz", shapes::lorentz},
    {"discs", shapes::discs},
    {"random-discs", shapes::random_discs},
    {"cardioid", shapes::curve_of_formulas},
    {"limacon", shapes::curve_of_formulas},
    {"flower", shapes::curve_of_formulas},
    {"superellipse", shapes::curve_of_formulas},
    {"robnik", shapes::curve_of_formulas},
    {"egg", shapes::curve_of_formulas},
    {"path", shapes::path},
    {"polar", shapes::curve_of_formulas},
    {"parametric", shapes::curve_of_formulas},
    {"implicit", shapes::implicit_curve},
    {"spline", shapes::spline_curve},
    {"plane", shapes::plane},
};

Builder builder_of(const TableSpec& spec) {
  std::vector<std::string> names;
  std::string list;
  for (const auto& [name, builder] : builders) {
    if (spec.shape == name) return builder;
    names.emplace_back(name);
    list += (list.empty() ? "" : ", ") + names.back();
  }
  throw InputError(spec.shape_place, "unknown shape '" + spec.shape + "'", "one of " + list,
                   nearest_name(spec.shape, names));
}

void add_loop(Table& table, const shapes::Chain& chain) {
  const int first = static_cast<int>(table.walls.size());
  const int count = static_cast<int>(chain.size());
  for (int k = 0; k < count; ++k) {
    const shapes::NamedCurve& piece = chain[static_cast<std::size_t>(k)];
    Wall wall;
    wall.name = piece.name;
    wall.curve = rounded(piece.curve);
    wall.next = first + (k + 1) % count;
    wall.previous = first + (k + count - 1) % count;
    wall.corner = piece.corner;
    table.walls.push_back(std::move(wall));
  }
}

void check_names(const TableSpec& spec, const Table& table) {
  std::set<std::string> names;
  for (std::size_t k = 0; k < table.walls.size(); ++k) {
    const std::string& name = table.walls[k].name;
    if (!names.insert(name).second)
      throw InputError(shapes::place_of_wall(spec, table, k), "two walls are called '" + name + "'",
                       "a name of its own for each");
  }
}

}  // namespace

shapes::Shape shapes::written_shape(const TableSpec& spec) {
  Shape shape = builder_of(spec)(spec);
  add_obstacles(spec, shape);
  return shape;
}

namespace {

int index_of(const auto& list, const std::string& name) {
  for (std::size_t k = 0; k < list.size(); ++k)
    if (list[k].name == name) return static_cast<int>(k);
  return -1;
}

bool is_mirror(const Wall& wall) {
  return !(wall.specularity < 1.0) && !(wall.roughness > 0.0) && !(wall.temperature > 0.0);
}

}  // namespace

int Table::wall_index(const std::string& name) const { return index_of(walls, name); }
int Table::hole_index(const std::string& name) const { return index_of(holes, name); }

bool scatters(const Table& table) {
  return !std::all_of(table.walls.begin(), table.walls.end(), is_mirror) ||
         std::any_of(table.holes.begin(), table.holes.end(),
                     [](const Hole& hole) { return hole.transmission < 1.0; });
}

bool is_thermal(const Table& table) {
  return std::any_of(table.walls.begin(), table.walls.end(),
                     [](const Wall& wall) { return wall.temperature > 0.0; });
}

void refuse_all_but_mirrors(const Table& table, const char* what) {
  for (const Wall& wall : table.walls) {
    if (!is_mirror(wall))
      throw InputError(Place{"", 0, 0, "table.wall"},
                       "wall '" + wall.name + "' reflects at random, and there are no " + what +
                           " with such walls",
                       "law = \"specular\"");
  }
  if (!table.regions.empty())
    throw InputError(
        Place{"", 0, 0, "table.region"},
        std::string("particles enter regions of the table, and there are no ") + what + " there",
        "no [[table.region]]");
  for (const Hole& hole : table.holes)
    if (hole.transmission < 1.0)
      throw InputError(Place{"", 0, 0, "table.hole"},
                       "hole '" + hole.name + "' lets pass at random, and there are no " + what +
                           " with such holes",
                       "transmission = 1");
}

std::vector<int> hole_numbers(const Table& table) {
  std::vector<int> numbers;
  int number = -1;
  for (std::size_t i = 0; i < table.holes.size(); ++i) {
    if (i == 0 || table.holes[i].name != table.holes[i - 1].name) ++number;
    numbers.push_back(number);
  }
  return numbers;
}

std::vector<std::string> hole_names(const Table& table) {
  std::vector<std::string> names;
  for (const Hole& hole : table.holes)
    if (names.empty() || names.back() != hole.name) names.push_back(hole.name);
  return names;
}

Table build_table(const TableSpec& spec) {
  Table table;
  table.shape = spec.shape;
  const shapes::Shape shape = shapes::written_shape(spec);
  table.extent = shape.extent;
  table.curve_errors = shape.curve_errors;
  for (const shapes::Chain& chain : shape.loops) add_loop(table, chain);
  if (shape.lattice) shapes::set_lattice(table, *shape.lattice, shapes::point(shape.cell_centre));
  if (spec.lattice) shapes::repeat(*spec.lattice, table);
  check_names(spec, table);
  const bool nested = !table.walls.empty() && shapes::check_region(spec, table);
  shapes::refuse_misplaced(spec, table);
  if (!spec.regions.empty()) shapes::divide(spec, table, nested);
  shapes::add_holes(spec, table);
  shapes::add_laws(spec, table);
  return table;
}

}  // namespace carom
