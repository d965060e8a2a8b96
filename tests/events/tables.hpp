// Tables built by hand for the tests of the event loop.
#pragma once

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "carom/events/world.hpp"
#include "carom/table/table.hpp"

namespace carom::test {

using geometry::Circle;
using geometry::CircularArc;
using geometry::Curve;
using geometry::Ellipse;
using geometry::Segment;
using geometry::Vector;

/// One loop of walls w0, w1, … appended to a table.
inline void add_loop(Table& table, const std::vector<Curve>& curves) {
  const int base = static_cast<int>(table.walls.size());
  const int n = static_cast<int>(curves.size());
  for (int i = 0; i < n; ++i) {
    Wall wall;
    wall.name = "w" + std::to_string(base + i);
    wall.curve = curves[static_cast<std::size_t>(i)];
    wall.next = base + (i + 1) % n;
    wall.previous = base + (i + n - 1) % n;
    table.walls.push_back(std::move(wall));
  }
}
inline Table loop(const std::vector<Curve>& curves) {
  Table table;
  add_loop(table, curves);
  return table;
}
inline Table polygon(const std::vector<Vector>& points) {
  std::vector<Curve> sides;
  for (std::size_t i = 0; i < points.size(); ++i)
    sides.emplace_back(Segment{points[i], points[(i + 1) % points.size()]});
  return loop(sides);
}
inline Table square() { return polygon({{0, 0}, {1, 0}, {1, 1}, {0, 1}}); }
inline Table stadium() {
  return loop({Segment{{-1, -1}, {1, -1}}, CircularArc{{1, -1}, {1, 1}, 0, true}, Segment{{1, 1}, {-1, 1}},
               CircularArc{{-1, 1}, {-1, -1}, 0, true}});
}
inline Table disc(double radius) { return loop({Circle{{0, 0}, radius, true}}); }
inline Table sinai() {
  Table table = square();
  add_loop(table, {Circle{{0.5, 0.5}, 0.25, false}});
  return table;
}
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

inline State start(Vector position, Vector velocity) {
  State s;
  s.position = position;
  s.velocity = velocity;
  return s;
}
inline Particle particle(double omega = 0.0, double speed = 1.0) {
  Particle p;
  p.omega = omega;
  p.speed = speed;
  return p;
}

/// Keeps everything it is told.
struct Recorder : Observer {
  std::vector<HitEvent> hits;
  std::vector<std::pair<double, State>> samples;
  std::vector<EndEvent> ends;
  void hit(const HitEvent& e) override { hits.push_back(e); }
  void sample(int, Time t, const State& s) override { samples.emplace_back(t.value(), s); }
  void end(const EndEvent& e) override { ends.push_back(e); }
};

}  // namespace carom::test
