#include "cli/reports/table_svg.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "carom/base/elementary.hpp"
#include "carom/base/error.hpp"
#include "carom/geometry/curve_frame.hpp"
#include "carom/geometry/hull.hpp"
#include "cli/reports/markup.hpp"

namespace carom::cli {

namespace {

using geometry::CurveFrame;
using geometry::Vector;

constexpr double drawing_size = 720.0, margin = 70.0;

// Maps the plane (y upwards) to the drawing (y downwards).
struct View {
  geometry::Box box;
  double scale = 1.0;

  Vector operator()(Vector p) const {
    return {margin + scale * (p.x - box.low.x), margin + scale * (box.high.y - p.y)};
  }
  double width() const { return 2 * margin + scale * (box.high.x - box.low.x); }
  double height() const { return 2 * margin + scale * (box.high.y - box.low.y); }
};

View view_of(const Table& table) {
  std::vector<geometry::Box> boxes;
  for (const Wall& wall : table.walls) boxes.push_back(geometry::bounding_box(wall.curve));
  if (table.lattice)
    for (const auto& edge : table.lattice->edges)
      boxes.push_back({edge.segment.from, edge.segment.from});
  if (boxes.empty())
    throw InputError({"command line", 0, 0, "-o"}, "a table without walls cannot be drawn");
  View view;
  view.box = geometry::hull_of(boxes);
  const double size = std::max(view.box.high.x - view.box.low.x, view.box.high.y - view.box.low.y);
  view.scale = drawing_size / size;
  return view;
}

std::string point(const View& view, Vector p) {
  const Vector q = view(p);
  return fmt::format("{:.3f},{:.3f}", q.x, q.y);
}

// Angle of the major axis against +x, in degrees of the drawing.
double axis_angle(const geometry::Curve& curve, bool& axis_is_major) {
  Vector axis{1.0, 0.0};
  double ratio = 1.0;
  if (const auto* arc = std::get_if<geometry::EllipticArc>(&curve)) {
    axis = arc->axis;
    ratio = arc->ratio;
  } else if (const auto* ellipse = std::get_if<geometry::Ellipse>(&curve)) {
    axis = ellipse->axis;
    ratio = ellipse->ratio;
  }
  axis_is_major = ratio <= 1.0;
  return -elementary::atan2(axis.y, axis.x) * 180.0 / 3.14159265358979324;
}

// The piece of a curve from u to v as SVG path commands that go on from the point at u. At most a
// quarter turn is one arc, so that which arc is meant is never in doubt.
std::string piece(const View& view, const geometry::Curve& curve, const CurveFrame& frame, double u,
                  double v) {
  if (frame.kind == CurveFrame::Kind::segment)
    return " L " + point(view, geometry::point_at(frame, v));
  bool axis_is_major = true;
  const double angle = axis_angle(curve, axis_is_major);
  const double along = axis_is_major ? frame.major : frame.minor;
  const double across = axis_is_major ? frame.minor : frame.major;
  const int sweep = frame.turn > 0.0 ? 0 : 1;  // y points down in the drawing
  std::string path;
  for (double from = u; from < v;) {
    const double to = std::min(v, std::floor(from) + 1.0);
    // The end of a closed curve is its start.
    const Vector end = to >= 4.0 ? geometry::start_point(curve) : geometry::point_at(frame, to);
    path += fmt::format(" A {:.3f} {:.3f} {:.3f} 0 {} {}", view.scale * along, view.scale * across,
                        angle, sweep, point(view, end));
    from = to;
  }
  return path;
}

std::string whole(const View& view, const Wall& wall, const CurveFrame& frame) {
  const bool segment = frame.kind == CurveFrame::Kind::segment;
  return piece(view, wall.curve, frame, 0.0, segment ? 1.0 : frame.end);
}

// A name beside the middle of a piece, on the side away from the domain.
std::string label(const View& view, const CurveFrame& frame, double u, const std::string& name,
                  const char* kind) {
  const Vector normal = geometry::normal_at(frame, u);
  Vector at = view(geometry::point_at(frame, u));
  at = {at.x - 16.0 * normal.x, at.y + 16.0 * normal.y + 4.0};
  const char* anchor = normal.x > 0.5 ? "end" : normal.x < -0.5 ? "start" : "middle";
  return fmt::format(
      "  <text class=\"{}\" x=\"{:.2f}\" y=\"{:.2f}\" text-anchor=\"{}\">{}</text>\n", kind, at.x,
      at.y, anchor, escaped(name));
}

// All loops as one path; the domain is where the winding leaves it filled.
std::string domain(const View& view, const Table& table, const std::vector<CurveFrame>& frames) {
  std::string path;
  if (table.lattice) {
    const auto& edges = table.lattice->edges;
    path = "M " + point(view, edges.front().segment.from);
    for (const auto& edge : edges) path += " L " + point(view, edge.segment.to);
    path += " Z ";
  }
  std::vector<bool> drawn(table.walls.size(), false);
  for (std::size_t first = 0; first < table.walls.size(); ++first) {
    if (drawn[first]) continue;
    path += "M " + point(view, geometry::start_point(table.walls[first].curve));
    for (std::size_t wall = first; !drawn[wall];
         wall = static_cast<std::size_t>(table.walls[wall].next)) {
      drawn[wall] = true;
      path += whole(view, table.walls[wall], frames[wall]);
    }
    path += " Z ";
  }
  return path;
}

constexpr const char* style =
    "  <style>\n"
    "    .domain { fill: #eef3fa; stroke: none; fill-rule: evenodd }\n"
    "    .wall { fill: none; stroke: #1b2a41; stroke-width: 2.5; stroke-linecap: round }\n"
    "    .hole { fill: none; stroke: #d1495b; stroke-width: 5 }\n"
    "    .cell { fill: none; stroke: #8d99ae; stroke-width: 1; stroke-dasharray: 6 4 }\n"
    "    text { font: 13px sans-serif; fill: #44546a }\n"
    "    text.opening { fill: #d1495b }\n"
    "    text.title { font-size: 15px; fill: #1b2a41 }\n"
    "  </style>\n";

}  // namespace

std::string table_svg(const Table& table, const std::string& title) {
  const View view = view_of(table);
  std::vector<CurveFrame> frames;
  for (const Wall& wall : table.walls) frames.push_back(geometry::frame_of(wall.curve));

  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 "
      "0 {0:.0f} "
      "{1:.0f}\">\n",
      view.width(), view.height());
  svg += style;
  svg += "  <rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n";
  if (!title.empty()) {
    svg += fmt::format("  <title>{}</title>\n", escaped(title));
    svg += fmt::format(
        "  <text class=\"title\" x=\"{:.2f}\" y=\"24\" text-anchor=\"middle\">{}</text>\n",
        view.width() / 2, escaped(title));
  }
  if (table.extent != Extent::open_plane)
    svg += fmt::format("  <path class=\"domain\" d=\"{}\"/>\n", domain(view, table, frames));
  if (table.lattice)
    for (const auto& edge : table.lattice->edges)
      svg += fmt::format("  <path class=\"cell\" d=\"M {} L {}\"/>\n",
                         point(view, edge.segment.from), point(view, edge.segment.to));
  for (std::size_t i = 0; i < table.walls.size(); ++i)
    svg += fmt::format("  <path class=\"wall\" d=\"M {}{}\"/>\n",
                       point(view, geometry::start_point(table.walls[i].curve)),
                       whole(view, table.walls[i], frames[i]));
  for (const Hole& hole : table.holes) {
    const CurveFrame& frame = frames[static_cast<std::size_t>(hole.wall)];
    svg += fmt::format("  <path class=\"hole\" d=\"M {}{}\"/>\n",
                       point(view, geometry::point_at(frame, hole.from)),
                       piece(view, table.walls[static_cast<std::size_t>(hole.wall)].curve, frame,
                             hole.from, hole.to));
  }
  for (std::size_t i = 0; i < table.walls.size(); ++i) {
    // A wall's name stands at its middle, or before the hole that is there.
    const double end = frames[i].kind == CurveFrame::Kind::segment ? 1.0 : frames[i].end;
    double u = end / 2;
    for (const int h : table.walls[i].holes) {
      const Hole& hole = table.holes[static_cast<std::size_t>(h)];
      if (hole.from <= u && u < hole.to) u = hole.from > 0.0 ? hole.from / 2 : (hole.to + end) / 2;
    }
    svg += label(view, frames[i], u, table.walls[i].name, "name");
  }
  for (const Hole& hole : table.holes)
    svg += label(view, frames[static_cast<std::size_t>(hole.wall)], (hole.from + hole.to) / 2,
                 hole.name, "opening");
  return svg + "</svg>\n";
}

}  // namespace carom::cli
