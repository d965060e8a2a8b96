#include "cli/reports/table_report.hpp"

#include <fmt/format.h>

#include <cmath>

#include "carom/geometry/arc.hpp"
#include "cli/common.hpp"
#include "cli/reports/aligned.hpp"

namespace carom::cli {

using files::Json;

namespace {

Json pair(geometry::Vector v) { return Json::array().push(v.x).push(v.y); }

Json wall_json(const Wall& wall) {
  Json json = Json::object();
  json.set("name", wall.name).set("kind", geometry::kind_name(wall.curve));
  json.set("length", geometry::length(wall.curve));
  json.set("from", pair(geometry::start_point(wall.curve)));
  json.set("to", pair(geometry::end_point(wall.curve)));
  const auto arc = geometry::arc_of(wall.curve);
  if (!arc) return json;
  json.set("center", pair(arc->centre));
  if (arc->a == arc->b)
    json.set("radius", arc->a);
  else
    json.set("a", arc->a).set("b", arc->b).set("axis", arc->axis);
  return json.set("angles", pair({arc->from, arc->to}));
}

Json walls_json(const Table& table) {
  Json walls = Json::array();
  for (const Wall& wall : table.walls) walls.push(wall_json(wall));
  return walls;
}

struct HoleMeasure {
  double from, to;
};
HoleMeasure measure_hole(const Table& table, const Hole& hole) {
  const geometry::Curve& curve = table.walls[static_cast<std::size_t>(hole.wall)].curve;
  const double from = geometry::arc_length_at(curve, hole.from);
  const bool to_end = !(hole.to < geometry::end_parameter(curve));
  return {from, to_end ? geometry::length(curve) : geometry::arc_length_at(curve, hole.to)};
}

Json holes_json(const TableSpec& spec) {
  Json holes = Json::array();
  for (std::size_t i = 0; i < spec.holes.size(); ++i)
    holes.push(Json::object()
                   .set("name", name_of_hole(spec.holes, i))
                   .set("wall", spec.holes[i].wall)
                   .set("center", spec.holes[i].center.to_double())
                   .set("width", spec.holes[i].width.to_double()));
  return holes;
}

constexpr std::size_t most_walls = 15;  // of the text

std::string number(double value) {
  return std::isinf(value)   ? "infinite"
         : std::isnan(value) ? "none for all: regions change speeds"
                             : fmt::format("{:.12g}", value);
}

}  // namespace

std::string table_text(const System& system, const TableMeasure& measured,
                       const std::string& output, bool verbose) {
  const Table& table = *system.table;
  std::string text = heading(system);
  text += fmt::format(
      "  shape        {}\n  area         {}\n  perimeter    {}\n  mean flight  {}\n\n", table.shape,
      number(measured.area), number(measured.perimeter), number(measured.mean_flight));
  if (const CurveErrors& off = table.curve_errors; off.distance > 0.0)
    text.insert(text.size() - 1,
                fmt::format("  curve        {} pieces, within {:.2g} of the formula plus rounding\n"
                            "               normals within {:.2g}, curvatures within {:.2g}\n",
                            table.walls.size(), off.distance, off.normal, off.curvature));
  std::vector<Column> columns{
      {"wall", {}, true}, {"kind", {}, true}, {"length", {}}, {"from", {}}, {"to", {}}};
  for (const Wall& wall : table.walls) {
    if (!verbose && columns.front().cells.size() == most_walls) break;
    const auto point = [](geometry::Vector p) { return fmt::format("({:.6g}, {:.6g})", p.x, p.y); };
    const bool whole = geometry::is_closed(wall.curve);
    const std::string cells[] = {wall.name, geometry::kind_name(wall.curve),
                                 fmt::format("{:.9g}", geometry::length(wall.curve)),
                                 point(geometry::start_point(wall.curve)),
                                 whole ? "" : point(geometry::end_point(wall.curve))};
    for (std::size_t c = 0; c < columns.size(); ++c) columns[c].cells.push_back(cells[c]);
  }
  if (!table.walls.empty()) text += fitted(columns);
  if (const std::size_t shown = columns.front().cells.size(); shown < table.walls.size())
    text += fmt::format("  and {} more; --verbose prints all\n", table.walls.size() - shown);
  for (const Hole& hole : table.holes) {
    const auto [from, to] = measure_hole(table, hole);
    text += fmt::format("  hole '{}' in '{}': arc length {:.9g} to {:.9g}", hole.name,
                        table.walls[static_cast<std::size_t>(hole.wall)].name, from, to);
    if (hole.transmission < 1.0)
      text += fmt::format(", lets a fraction {:.6g} pass", hole.transmission);
    text += "\n";
  }
  for (const Wall& wall : table.walls)
    if (wall.specularity < 1.0)
      text +=
          fmt::format("  wall '{}' mirrors a fraction {:.6g} of the hits; the others are diffuse\n",
                      wall.name, wall.specularity);
  for (const Wall& wall : table.walls)
    if (wall.roughness > 0.0)
      text += fmt::format("  wall '{}' is rough: its normal is turned by up to {:.6g}\n", wall.name,
                          wall.roughness);
  for (const Wall& wall : table.walls)
    if (wall.temperature > 0.0)
      text += fmt::format("  wall '{}' has the temperature {:.6g}\n", wall.name, wall.temperature);
  for (int w = 0; w < static_cast<int>(table.walls.size()); ++w)
    if (table.wall(w).closed && !is_inner_side(table, w))
      text += fmt::format("  the edge '{}' is a wall, from both sides\n", table.wall(w).name);
  for (const Region& region : table.regions) {
    int w = region.first;
    while (w < region.first + region.count && !is_inner_side(table, w)) ++w;
    text += w < region.first + region.count
                ? fmt::format("  region behind '{}': ", table.wall(table.wall(w).twin).name)
                : fmt::format("  region of '{}': ", table.wall(region.first).name);
    if (region.potential != 0.0)
      text += fmt::format("potential {:.6g}", region.potential);
    else
      text += fmt::format("index {:.6g}", region.index);
    if (region.field) text += fmt::format(", B = {:.6g}", *region.field);
    using enum Region::Reflection;
    if (region.reflection != none)
      text += region.reflection == s   ? ", mirrors as s"
              : region.reflection == p ? ", mirrors as p"
                                       : ", mirrors by a formula";
    text += "\n";
  }
  text += folded("  checked: that loops close, cross nowhere and lie apart, by exact signs") + "\n";
  if (!output.empty()) text += fmt::format("  drawing: {}\n", output);
  return text;
}

Json table_json(const LoadedSystem& loaded, const TableMeasure& measured, const std::string& output,
                double seconds, double cpu_seconds) {
  const System& system = loaded.system;
  Json json = Json::object();
  add_common_keys(json, system, 1, seconds, cpu_seconds);
  json.set("shape", system.table->shape);
  json.set("area", measured.area);
  json.set("perimeter", measured.perimeter);
  json.set("mean_flight", measured.mean_flight);
  if (const CurveErrors& off = system.table->curve_errors; off.distance > 0.0) {
    json.set("curve_distance", off.distance);
    json.set("curve_normal", off.normal);
    json.set("curve_curvature", off.curvature);
  }
  json.set("walls", walls_json(*system.table));
  json.set("holes", holes_json(*loaded.exact.spec));
  if (!output.empty()) json.set("drawing", output);
  return json;
}

}  // namespace carom::cli
