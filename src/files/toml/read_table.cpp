#include <algorithm>

#include "files/toml/read.hpp"

namespace carom::files {
namespace {

// The order is that of the guide.
const std::vector<std::string>& shapes() {
  static const std::vector<std::string> names{
      "rectangle", "polygon",    "triangle", "regular",      "circle",  "ellipse", "annulus",
      "stadium",   "mushroom",   "lemon",    "sinai",        "lorentz", "discs",   "random-discs",
      "cardioid",  "limacon",    "flower",   "superellipse", "robnik",  "egg",     "path",
      "polar",     "parametric", "implicit", "spline",       "svg",     "plane"};
  return names;
}

double share_of(const Value& given) {
  const double share = as_number(given).to_double();
  if (!(share >= 0.0 && share <= 1.0))
    throw InputError(given.place, "a share is not below 0 nor above 1", "a number from 0 to 1");
  return share;
}

HoleSpec read_hole(Value& value, std::size_t index) {
  TomlSection section(value, "table.hole");
  section.check_keys();
  HoleSpec hole;
  hole.place = value.place;
  const Value& wall = section.get("wall");
  hole.wall = as_text(wall);
  hole.wall_place = wall.place;
  hole.center = as_number(section.get("center"));
  hole.width = as_number(section.get("width"));
  hole.transmission = share_of(section.get("transmission"));
  const std::string name = "hole_" + std::to_string(index + 1);
  hole.name = as_name(section.fill("name", text_value(name, section.place_of("name"))));
  return hole;
}

WallLawSpec read_law(Value& value, std::size_t) {
  const std::string law =
      read_kind(value, "table.wall", "law", {"specular", "diffuse", "mixed", "rough", "thermal"});
  TomlSection section(value, "table.wall", law);
  section.check_keys();
  WallLawSpec spec;
  spec.place = value.place;
  if (law == "diffuse") spec.specularity = 0.0;
  if (law == "mixed") spec.specularity = share_of(section.get("specularity"));
  if (law == "thermal") spec.temperature = as_positive(section.get("temperature"));
  if (law == "rough") {
    const Value& angle = section.get("angle");
    spec.roughness = as_angle(angle).to_double();
    if (!(spec.roughness > 0.0 && spec.roughness < 1.5707963267948966))
      throw InputError(angle.place, "a wall's normal is turned by less than a right angle",
                       "an angle above 0 and below pi/2");
  }
  if (const Value* wall = section.find("wall")) {
    spec.wall = as_text(*wall);
    spec.wall_place = wall->place;
  }
  return spec;
}

PieceSpec read_piece(Value& value) {
  const bool line = value.find("line_to") != nullptr;
  const bool arc = value.find("arc_to") != nullptr || value.find("arc_via") != nullptr;
  const bool ellipse = value.find("ellipse_to") != nullptr || value.find("ellipse_via") != nullptr;
  const bool bezier = value.find("bezier") != nullptr;
  if (value.kind == Value::Kind::table &&
      (line ? 1 : 0) + (arc ? 1 : 0) + (ellipse ? 1 : 0) + (bezier ? 1 : 0) > 1) {
    throw InputError(value.place,
                     "a piece is either a line or an arc or an ellipse or a Bézier curve",
                     "one of line_to, arc_to, ellipse_to, bezier");
  }
  PieceSpec piece;
  piece.place = value.place;
  TomlSection section(value, "table.loop.pieces",
                      ellipse  ? "ellipse"
                      : bezier ? "bezier"
                      : arc    ? "arc"
                               : "line");
  section.check_keys();
  if (const Value* name = section.find("name")) piece.name = as_name(*name);
  if (arc) {
    piece.kind = PieceSpec::Kind::arc;
    piece.to = as_point(section.get("arc_to"));
    piece.via = as_point(section.get("arc_via"));
  } else if (ellipse) {
    piece.kind = PieceSpec::Kind::ellipse;
    piece.to = as_point(section.get("ellipse_to"));
    piece.via = as_point(section.get("ellipse_via"));
    piece.ratio = as_number(section.get("ellipse_ratio"));
    piece.angle = as_angle(section.get("ellipse_angle"));
  } else if (bezier) {
    piece.kind = PieceSpec::Kind::bezier;
    const Value& points = section.get("bezier");
    piece.control = as_points(points);
    constexpr std::size_t most = geometry::Bezier::most;
    if (piece.control.size() < 2 || piece.control.size() > most)
      throw InputError(
          points.place,
          "a Bézier curve with " + std::to_string(piece.control.size()) + " points after its start",
          "2 to 5 points: control points and, last, the end");
    piece.to = piece.control.back();
    piece.control.pop_back();
  } else {
    piece.to = as_point(section.get("line_to"));
  }
  return piece;
}

void read_pieces(TomlSection& section, LoopSpec& loop) {
  loop.start = as_point(section.get("start"));
  Value& pieces = section.get("pieces");
  as_list(pieces);
  for (Value& piece : pieces.items) loop.pieces.push_back(read_piece(piece));
}

/// Of the first character of a text.
Place inside_quotes(const Value& text) {
  Place place = text.place;
  if (place.column > 0) ++place.column;
  return place;
}

WrittenFormula read_formula(const Value& value) { return {as_text(value), inside_quotes(value)}; }

RegionSpec read_region(Value& value, std::size_t) {
  const bool has_edge = value.find("start") != nullptr || value.find("pieces") != nullptr;
  TomlSection section(value, "table.region", has_edge ? "pieces" : "obstacle");
  section.check_keys();
  RegionSpec spec;
  spec.place = value.place;
  if (has_edge) {
    spec.edge.place = value.place;
    read_pieces(section, spec.edge);
  } else {
    const Value& wall = section.get("wall");
    spec.wall = as_text(wall);
    spec.wall_place = wall.place;
  }
  spec.index = as_number(section.get("index"));
  spec.potential = as_number(section.get("potential"));
  if (const Value* field = section.find("B")) spec.field = as_number(*field);
  spec.reflection = read_formula(section.get("reflection"));
  return spec;
}

LoopSpec read_loop(Value& value, std::size_t) {
  using Form = LoopSpec::Kind;
  const auto has = [&](const char* key) { return value.find(key) != nullptr; };
  LoopSpec loop;
  loop.place = value.place;
  loop.kind = has("radius") ? Form::circle : has("a") || has("b") ? Form::ellipse : Form::pieces;
  TomlSection section(value, "table.loop",
                      loop.kind == Form::circle    ? "circle"
                      : loop.kind == Form::ellipse ? "ellipse"
                                                   : "pieces");
  section.check_keys();
  if (loop.kind == Form::pieces) {
    read_pieces(section, loop);
    return loop;
  }
  loop.center = as_point(section.get("center"));
  if (loop.kind == Form::circle) {
    loop.radius = as_number(section.get("radius"));
  } else {
    loop.a = as_number(section.get("a"));
    loop.b = as_number(section.get("b"));
    loop.angle = as_angle(section.get("angle"));
  }
  if (const Value* name = section.find("name")) loop.name = as_name(*name);
  return loop;
}

ObstacleSpec read_obstacle(Value& value, std::size_t index) {
  using Shape = ObstacleSpec::Shape;
  static const std::vector<std::string> shapes{"circle", "ellipse",    "polygon", "path",
                                               "polar",  "parametric", "spline"};
  const std::string shape = read_kind(value, "table.obstacle", "shape", shapes);
  take_points_from_file(value, "table.obstacle");
  TomlSection section(value, "table.obstacle", shape);
  section.check_keys();
  ObstacleSpec obstacle;
  obstacle.place = value.place;
  obstacle.shape = static_cast<Shape>(std::find(shapes.begin(), shapes.end(), shape) -
                                      shapes.begin());  // in the order of the names
  switch (obstacle.shape) {
    case Shape::circle:
      obstacle.center = as_point(section.get("center"));
      obstacle.radius = as_number(section.get("radius"));
      break;
    case Shape::ellipse:
      obstacle.center = as_point(section.get("center"));
      obstacle.a = as_number(section.get("a"));
      obstacle.b = as_number(section.get("b"));
      obstacle.angle = as_angle(section.get("angle"));
      break;
    case Shape::polygon:
    case Shape::spline:
      obstacle.points = as_points(section.get("points"));
      break;
    case Shape::path:
      read_pieces(section, obstacle.loop);
      obstacle.loop.place = value.place;
      break;
    case Shape::polar:
      obstacle.center = as_point(section.get("center"));
      obstacle.radius_formula = read_formula(section.get("radius"));
      break;
    case Shape::parametric:
      obstacle.x = read_formula(section.get("x"));
      obstacle.y = read_formula(section.get("y"));
      obstacle.from = as_number(section.get("from"));
      obstacle.to = as_number(section.get("to"));
      break;
  }
  const std::string name = "obstacle_" + std::to_string(index + 1);
  obstacle.name = as_name(section.fill("name", text_value(name, section.place_of("name"))));
  return obstacle;
}

void read_key(const KeyDescription& key, const Value& value, TableSpec& spec) {
  const std::string name(key.key);
  if (key.type == "list of points") {
    spec.points[name] = as_points(value);
  } else if (key.type == "point") {
    spec.points[name] = {as_point(value)};
  } else if (key.type == "list of numbers") {
    spec.lists[name] = as_numbers(value);
  } else if (key.type == "formula") {
    spec.formulas[name] = read_formula(value);
  } else if (key.type == "string") {
    spec.words[name] = as_text(value);
  } else if (key.type == "boolean") {
    spec.torus = as_flag(value);
  } else {
    spec.numbers[name] = key.type == "angle" ? as_angle(value) : as_number(value);
  }
}

void read_lattice(Value& value, TableSpec& spec) {
  TomlSection section(value, "lattice");
  section.check_keys();
  const Value& vectors = section.get("vectors");
  const std::vector<ExactPoint> points = as_points(vectors);
  if (points.size() != 2) {
    throw InputError(vectors.place,
                     "a lattice has two vectors, not " + std::to_string(points.size()),
                     "[[x, y], [x, y]]");
  }
  spec.lattice = LatticeSpec{points[0], points[1], vectors.place};
}

// --closed where there are no walls.
bool takes_holes_of_nothing(const Value& root) {
  const Value* table = root.find("table");
  const Value* holes = table == nullptr ? nullptr : table->find("hole");
  return holes != nullptr && table->entries.size() == 1 && holes->kind == Value::Kind::list &&
         holes->items.empty();
}

}  // namespace

TableSpec read_table(Value& root) {
  if (takes_holes_of_nothing(root)) root.erase("table");
  Value* table = root.find("table");
  if (table == nullptr) {
    // Forces may hold the particles; without forces the table was forgotten.
    if (root.find("potential") == nullptr && root.find("interaction") == nullptr)
      throw InputError({root.place.file, 0, 0, "table"}, "the section [table] is missing",
                       "[table] with a shape");
    TableSpec spec;
    spec.shape = "plane";
    if (Value* lattice = root.find("lattice")) read_lattice(*lattice, spec);
    return spec;
  }
  TableSpec spec;
  read_kind(*table, "table", "shape", shapes());
  take_drawing(*table);
  spec.shape = table->find("shape")->text;
  take_points_from_file(*table, "table");
  TomlSection section(*table, "table", spec.shape);
  section.check_keys();
  spec.place = table->place;
  spec.shape_place = section.get("shape").place;
  for (const KeyDescription& key : key_table()) {
    if (key.section != "table" || !of_kind(key, spec.shape) || key.type == "list of tables")
      continue;
    if (key.key == "shape" || (!section.has(key.key) && key.fallback.empty())) continue;
    const Value& value = section.get(key.key);
    read_key(key, value, spec);
    if (key.key == "lattice" && value.text != "triangular" && value.text != "square") {
      throw InputError(value.place, "unknown lattice '" + value.text + "'",
                       "\"triangular\" or \"square\"",
                       nearest_name(value.text, {"triangular", "square"}));
    }
  }
  const auto read_all = [&](const char* key, const char* example, auto& to, auto read) {
    Value* list = section.find(key);
    if (list == nullptr) return;
    as_sections(*list, example);
    for (std::size_t k = 0; k < list->items.size(); ++k) to.push_back(read(list->items[k], k));
  };
  read_all("loop", "start = [0, 0]", spec.loops, read_loop);
  read_all("obstacle", "shape = \"circle\"", spec.obstacles, read_obstacle);
  read_all("hole", "wall = \"bottom\"", spec.holes, read_hole);
  read_all("wall", "wall = \"bottom\"", spec.laws, read_law);
  read_all("region", "wall = \"obstacle_1\"", spec.regions, read_region);
  if (Value* lattice = root.find("lattice")) read_lattice(*lattice, spec);
  return spec;
}

}  // namespace carom::files
