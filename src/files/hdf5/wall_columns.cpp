// The walls of a table as pictures need them.
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "carom/geometry/arc.hpp"
#include "carom/table/table.hpp"
#include "files/hdf5/archive_file.hpp"

namespace carom::files {

void write_walls(const ArchiveFile& file, const Table& table) {
  using geometry::Arc;
  const hdf5::Handle group = file.group("walls", "The walls of the table, in their order");
  const hid_t to = group.get();
  std::vector<std::string> names, kinds;
  std::vector<Arc> arcs;
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  for (const Wall& wall : table.walls) {
    names.push_back(wall.name);
    kinds.emplace_back(geometry::kind_name(wall.curve));
    arcs.push_back(
        geometry::arc_of(wall.curve).value_or(Arc{{none, none}, none, none, none, none, none}));
  }
  hdf5::write_texts(to, "name", names, {"text", "Name of the wall"}, file.name());
  hdf5::write_texts(to, "kind", kinds, {"text", "Kind of curve"}, file.name());
  const auto column = [&](const char* name, hdf5::Description description, const auto& value) {
    std::vector<double> values;
    for (std::size_t i = 0; i < arcs.size(); ++i)
      values.push_back(value(table.walls[i].curve, arcs[i]));
    hdf5::write_column(to, name, std::span<const double>(values), description, file.name());
  };
  using geometry::Curve;
  constexpr hdf5::Description start{"length", "Where the wall begins"},
      end{"length", "Where the wall ends"},
      centre{"length", "Centre of an arc or a circle, NaN of a segment"},
      axis{"length", "Semi-axis, of a circle the radius; NaN of a segment"};
  column("length", {"length", "Length of the wall"},
         [](const Curve& c, const Arc&) { return geometry::length(c); });
  column("from_x", start, [](const Curve& c, const Arc&) { return geometry::start_point(c).x; });
  column("from_y", start, [](const Curve& c, const Arc&) { return geometry::start_point(c).y; });
  column("to_x", end, [](const Curve& c, const Arc&) { return geometry::end_point(c).x; });
  column("to_y", end, [](const Curve& c, const Arc&) { return geometry::end_point(c).y; });
  column("center_x", centre, [](const Curve&, const Arc& a) { return a.centre.x; });
  column("center_y", centre, [](const Curve&, const Arc& a) { return a.centre.y; });
  column("a", axis, [](const Curve&, const Arc& a) { return a.a; });
  column("b", axis, [](const Curve&, const Arc& a) { return a.b; });
  column("axis", {"radian", "Direction of the semi-axis a; NaN of a segment"},
         [](const Curve&, const Arc& a) { return a.axis; });
  constexpr hdf5::Description angle{
      "radian", "Angle at an end, from the semi-axis a (of an ellipse the eccentric one)"};
  column("from_angle", angle, [](const Curve&, const Arc& a) { return a.from; });
  column("to_angle", angle, [](const Curve&, const Arc& a) { return a.to; });
}

}  // namespace carom::files
