#include "carom/table/make.hpp"

#include <utility>

namespace carom {
namespace {

Place place_in_code(const std::string& key) { return {"", 0, 0, key}; }
std::string numbered(const std::string& key, std::size_t index) {
  return key + "[" + std::to_string(index) + "]";
}

std::shared_ptr<const Table> built(const TableSpec& spec, const Place& where) {
  try {
    return std::make_shared<const Table>(build_table(spec));
  } catch (const InputError& error) {
    if (!error.place().key.empty()) throw;
    throw InputError(where, error.problem(), error.expected(), error.nearest());
  }
}

TableSpec shaped(const char* shape, std::map<std::string, ExactNumber> numbers = {}) {
  TableSpec spec;
  spec.shape = shape;
  spec.place = place_in_code("table");
  spec.shape_place = place_in_code("table.shape");
  spec.numbers = std::move(numbers);
  return spec;
}

MadeTable of_discs(std::vector<ExactPoint> centers, TableSpec spec) {
  spec.points["centers"] = std::move(centers);
  return MadeTable(std::move(spec));
}

}  // namespace

MadeTable::MadeTable(TableSpec s, const Place& where)
    : spec(std::make_shared<const TableSpec>(std::move(s))), table(built(*spec, where)) {}
MadeTable::MadeTable(TableSpec s) : MadeTable(std::move(s), place_in_code("table")) {}

MadeTable MadeTable::hole(const std::string& wall, HoleSpec hole) const {
  TableSpec more = *spec;
  hole.wall = wall;
  hole.place = place_in_code(numbered("table.hole", more.holes.size()));
  hole.wall_place = place_in_code(hole.place.key + ".wall");
  const Place where = hole.place;
  more.holes.push_back(std::move(hole));
  return MadeTable(std::move(more), where);
}

MadeTable MadeTable::obstacle(ObstacleSpec obstacle, const std::string& name) const {
  TableSpec more = *spec;
  if (!name.empty()) obstacle.name = name;
  obstacle.place = place_in_code(numbered("table.obstacle", more.obstacles.size()));
  const Place where = obstacle.place;
  more.obstacles.push_back(std::move(obstacle));
  return MadeTable(std::move(more), where);
}

MadeTable MadeTable::lattice(const ExactPoint& first, const ExactPoint& second) const {
  TableSpec more = *spec;
  const Place where = place_in_code("lattice.vectors");
  more.lattice = LatticeSpec{first, second, where};
  return MadeTable(std::move(more), where);
}

MadeTable rectangle(const ExactNumber& width, const ExactNumber& height) {
  return MadeTable(shaped("rectangle", {{"width", width}, {"height", height}}));
}
MadeTable polygon(std::vector<ExactPoint> points) {
  TableSpec spec = shaped("polygon");
  spec.points["points"] = std::move(points);
  return MadeTable(std::move(spec));
}
MadeTable regular_polygon(int sides, const ExactNumber& radius, const ExactNumber& angle) {
  return MadeTable(shaped("regular", {{"sides", sides}, {"radius", radius}, {"angle", angle}}));
}
MadeTable circle(const ExactNumber& radius) {
  return MadeTable(shaped("circle", {{"radius", radius}}));
}
MadeTable ellipse(const ExactNumber& a, const ExactNumber& b) {
  return MadeTable(shaped("ellipse", {{"a", a}, {"b", b}}));
}
MadeTable annulus(const ExactNumber& outer, const ExactNumber& inner, const ExactNumber& offset) {
  return MadeTable(shaped("annulus", {{"outer", outer}, {"inner", inner}, {"offset", offset}}));
}
MadeTable stadium(const ExactNumber& half_length, const ExactNumber& radius) {
  return MadeTable(shaped("stadium", {{"half_length", half_length}, {"radius", radius}}));
}
MadeTable mushroom(const ExactNumber& cap_radius, const ExactNumber& stem_width,
                   const ExactNumber& stem_height) {
  return MadeTable(shaped(
      "mushroom",
      {{"cap_radius", cap_radius}, {"stem_width", stem_width}, {"stem_height", stem_height}}));
}
MadeTable lemon(const ExactNumber& radius, const ExactNumber& separation) {
  return MadeTable(shaped("lemon", {{"radius", radius}, {"separation", separation}}));
}
MadeTable cardioid(const ExactNumber& radius) {
  return MadeTable(shaped("cardioid", {{"radius", radius}}));
}
MadeTable limacon(const ExactNumber& radius, const ExactNumber& epsilon) {
  return MadeTable(shaped("limacon", {{"radius", radius}, {"epsilon", epsilon}}));
}
MadeTable flower(const ExactNumber& radius, const ExactNumber& epsilon, int petals) {
  return MadeTable(
      shaped("flower", {{"radius", radius}, {"epsilon", epsilon}, {"petals", petals}}));
}
MadeTable superellipse(const ExactNumber& a, const ExactNumber& b, int exponent) {
  return MadeTable(shaped("superellipse", {{"a", a}, {"b", b}, {"exponent", exponent}}));
}
MadeTable robnik(const ExactNumber& radius, const ExactNumber& lambda) {
  return MadeTable(shaped("robnik", {{"radius", radius}, {"lambda", lambda}}));
}
MadeTable egg(const ExactNumber& a, const ExactNumber& b, const ExactNumber& epsilon) {
  return MadeTable(shaped("egg", {{"a", a}, {"b", b}, {"epsilon", epsilon}}));
}
MadeTable sinai(const ExactNumber& side, const ExactNumber& radius, bool torus) {
  TableSpec spec = shaped("sinai", {{"side", side}, {"radius", radius}});
  spec.torus = torus;
  return MadeTable(std::move(spec));
}
MadeTable lorentz(const ExactNumber& spacing, const ExactNumber& radius,
                  const std::string& lattice) {
  TableSpec spec = shaped("lorentz", {{"spacing", spacing}, {"radius", radius}});
  spec.words["lattice"] = lattice;
  return MadeTable(std::move(spec));
}
MadeTable discs(std::vector<ExactPoint> centers, const ExactNumber& radius) {
  return of_discs(std::move(centers), shaped("discs", {{"radius", radius}}));
}
MadeTable discs(std::vector<ExactPoint> centers, std::vector<ExactNumber> radii) {
  TableSpec spec = shaped("discs");
  spec.lists["radii"] = std::move(radii);
  return of_discs(std::move(centers), std::move(spec));
}
MadeTable path(std::vector<LoopSpec> loops) {
  TableSpec spec = shaped("path");
  spec.loops = std::move(loops);
  return MadeTable(std::move(spec));
}

ObstacleSpec disc(const ExactPoint& center, const ExactNumber& radius) {
  ObstacleSpec obstacle;
  obstacle.center = center;
  obstacle.radius = radius;
  return obstacle;
}
ObstacleSpec elliptic_disc(const ExactPoint& center, const ExactNumber& a, const ExactNumber& b,
                           const ExactNumber& angle) {
  ObstacleSpec obstacle;
  obstacle.shape = ObstacleSpec::Shape::ellipse;
  obstacle.center = center;
  obstacle.a = a;
  obstacle.b = b;
  obstacle.angle = angle;
  return obstacle;
}
ObstacleSpec block(std::vector<ExactPoint> points) {
  ObstacleSpec obstacle;
  obstacle.shape = ObstacleSpec::Shape::polygon;
  obstacle.points = std::move(points);
  return obstacle;
}

}  // namespace carom
