#include "base/parts.hpp"
#include "files/toml/read.hpp"
#include "table/shapes.hpp"

namespace carom::files {
namespace {

constexpr const char* forms =
    "boundary, wall:NAME, line:x0,y0:x1,y1, segment:x0,y0:x1,y1, circle:x,y,r, x=c, y=c, vx=c or "
    "vy=c";

std::vector<double> numbers_of(const std::string& text, char between, std::size_t count,
                               const Place& place) {
  std::vector<double> numbers;
  for (const std::string& part : base::parts_of(text, between))
    numbers.push_back(ExactNumber(part, place).to_double());
  if (numbers.size() != count)
    throw InputError(place,
                     "'" + text + "' holds " + std::to_string(numbers.size()) + " numbers, not " +
                         std::to_string(count),
                     forms);
  return numbers;
}

geometry::Vector point_of(const std::string& text, const Place& place) {
  const std::vector<double> xy = numbers_of(text, ',', 2, place);
  return {xy[0], xy[1]};
}

Surface line_of(Surface::Kind kind, const std::string& text, const Place& place) {
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) throw InputError(place, "a line needs two points", forms);
  Surface surface;
  surface.kind = kind;
  surface.from = point_of(text.substr(0, colon), place);
  surface.to = point_of(text.substr(colon + 1), place);
  if (surface.from == surface.to)
    throw InputError(place, "the two points of the line are the same", "two points");
  return surface;
}

// The surface that is written, or none for the walls.
void read_on(const Value& value, const Table& table, SectionPlan& plan) {
  const std::string& text = as_text(value);
  const Place& place = value.place;
  if (text == "boundary") return;
  if (text.starts_with("wall:")) {
    plan.wall = table::shapes::named_wall(text.substr(5), place, table);
    return;
  }
  plan.boundary = false;
  if (text.starts_with("line:")) {
    plan.surface = line_of(Surface::Kind::line, text.substr(5), place);
  } else if (text.starts_with("segment:")) {
    plan.surface = line_of(Surface::Kind::segment, text.substr(8), place);
  } else if (text.starts_with("circle:")) {
    const std::vector<double> circle = numbers_of(text.substr(7), ',', 3, place);
    plan.surface.kind = Surface::Kind::circle;
    plan.surface.from = {circle[0], circle[1]};
    plan.surface.radius = circle[2];
    if (!(circle[2] > 0)) throw InputError(place, "the circle has no radius", "a radius > 0");
  } else {
    const std::pair<const char*, Surface::Kind> conditions[] = {{"x=", Surface::Kind::position_x},
                                                                {"y=", Surface::Kind::position_y},
                                                                {"vx=", Surface::Kind::velocity_x},
                                                                {"vy=", Surface::Kind::velocity_y}};
    for (const auto& [start, kind] : conditions) {
      if (!text.starts_with(start)) continue;
      plan.surface.kind = kind;
      plan.surface.value = ExactNumber(text.substr(text.find('=') + 1), place).to_double();
      return;
    }
    throw InputError(place, "cannot read the section '" + text + "'", forms);
  }
}

}  // namespace

SectionPlan read_section(Value& root, const Table& table) {
  SectionPlan plan;
  Value* written = root.find("section");
  if (written == nullptr) return plan;
  TomlSection section(*written, "section");
  section.check_keys();
  read_on(section.get("on"), table, plan);
  const Value& direction = section.get("direction");
  const std::string& name = as_text(direction);
  if (name != "both" && name != "positive" && name != "negative")
    throw InputError(direction.place, "unknown direction '" + name + "'",
                     "both, positive or negative",
                     nearest_name(name, {"both", "positive", "negative"}));
  if (name != "both" && plan.boundary)
    throw InputError(direction.place, "a section at the walls has one direction only", "both");
  plan.direction = name == "both" ? 0 : name == "positive" ? 1 : -1;
  plan.points = as_count(section.get("points"), 1);
  if (const Value* orbits = section.find("orbits")) plan.orbits = as_count(*orbits, 1);
  return plan;
}

}  // namespace carom::files
