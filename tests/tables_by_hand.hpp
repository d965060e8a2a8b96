// Tables built by hand: walls and nothing else.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "carom/table/table.hpp"

namespace carom::tests {

using geometry::Circle;
using geometry::CircularArc;
using geometry::Curve;
using geometry::Ellipse;
using geometry::EllipticArc;
using geometry::Segment;
using geometry::Vector;

/// One loop of walls wall_0, wall_1, … appended to a table.
inline void add_loop(Table& t, const std::vector<Curve>& curves) {
  const int base = static_cast<int>(t.walls.size()), n = static_cast<int>(curves.size());
  for (int i = 0; i < n; ++i) {
    Wall w;
    w.name = "wall_" + std::to_string(base + i);
    w.curve = curves[static_cast<std::size_t>(i)];
    w.next = base + (i + 1) % n;
    w.previous = base + (i + n - 1) % n;
    t.walls.push_back(std::move(w));
  }
}
inline Table loop(const std::vector<Curve>& curves) {
  Table t;
  add_loop(t, curves);
  return t;
}
inline Table polygon(const std::vector<Vector>& points) {
  std::vector<Curve> sides;
  for (std::size_t i = 0; i < points.size(); ++i)
    sides.push_back(Segment{points[i], points[(i + 1) % points.size()]});
  return loop(sides);
}
inline Table rectangle(double a, double b) { return polygon({{0, 0}, {a, 0}, {a, b}, {0, b}}); }
inline Table square() { return rectangle(1, 1); }
inline Table stadium(double half = 1.0, double radius = 1.0, Vector at = {}) {
  const double l = at.x - half, r = at.x + half, b = at.y - radius, t = at.y + radius;
  return loop({Segment{{l, b}, {r, b}}, CircularArc{{r, b}, {r, t}, 0.0, true},
               Segment{{r, t}, {l, t}}, CircularArc{{l, t}, {l, b}, 0.0, true}});
}
inline Table mushroom(double cap, double half, double height) {
  return loop({Segment{{-half, -height}, {half, -height}}, Segment{{half, -height}, {half, 0}},
               Segment{{half, 0}, {cap, 0}}, CircularArc{{cap, 0}, {-cap, 0}, 0.0, true},
               Segment{{-cap, 0}, {-half, 0}}, Segment{{-half, 0}, {-half, -height}}});
}
inline Table with_disc(Table t, Vector centre, double radius) {
  add_loop(t, {Circle{centre, radius, false}});
  return t;
}
inline Table disc(double radius) { return loop({Circle{{0, 0}, radius, true}}); }
inline Table sinai() { return with_disc(square(), {0.5, 0.5}, 0.25); }
/// Discs of radius 1 on a lattice.
inline Table lorentz(Vector first, Vector second) {
  Table table = loop({Circle{{0, 0}, 1.0, false}});
  table.extent = Extent::lattice;
  table.lattice = geometry::make_lattice(first, second, {0, 0});
  return table;
}
inline Table discs(const std::vector<Vector>& centres) {
  Table table;
  for (const Vector& c : centres) add_loop(table, {Circle{c, 1.0, false}});
  table.extent = Extent::open_plane;
  return table;
}

}  // namespace carom::tests
