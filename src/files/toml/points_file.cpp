#include "files/toml/read.hpp"

#include <utility>

#include "files/toml/number_lines.hpp"
#include "files/toml/toml_section.hpp"

namespace carom::files {

void take_points_from_file(Value& table, const std::string& section_name) {
  const Value* shape = table.find("shape");
  if (shape == nullptr ||
      (shape->text != "discs" && shape->text != "polygon" && shape->text != "spline"))
    return;
  const bool discs = shape->text == "discs";
  TomlSection section(table, section_name, shape->text);
  if (!section.has("path")) return;
  section.check_keys();
  const std::string key = discs ? "centers" : "points";
  section.exclude("path", key);
  const Value path = section.get("path");
  as_text(path);
  const Row row = discs ? Row{"disc", "x y or x y radius", 2, 3}
                        : Row{shape->text == "spline" ? "point" : "corner", "x y", 2, 2};
  Value points = rows_of_file(located(path), path.place, row);
  Value radii;
  radii.kind = Value::Kind::list;
  radii.place = path.place;
  const std::size_t numbers = points.items.front().items.size();
  for (Value& point : points.items) {
    if (point.items.size() != numbers)
      throw InputError(point.place,
                       numbers == 3 ? "this disc has no radius, those before have one"
                                    : "this disc has a radius, those before have none",
                       "the same number of values in each line");
    if (numbers < 3) continue;
    radii.items.push_back(std::move(point.items.back()));
    point.items.pop_back();
  }
  if (numbers == 3) {
    for (const char* other : {"radius", "radii"})
      if (const Value* written = table.find(other))
        throw InputError(written->place,
                         "the file '" + path.text + "' has the discs' radii already",
                         "x y in each line of the file, or no " + std::string(other) + " here");
    table.set("radii", std::move(radii));
  }
  table.erase("path");
  table.set(key, std::move(points));
}

}  // namespace carom::files
