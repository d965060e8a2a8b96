// Systems for tests of certified orbits.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "carom/certify/certified_orbit.hpp"
#include "certify/number/enclosure_of.hpp"

namespace carom::tests {

inline ExactNumber exactly(const std::string& text) { return {text, Place{}}; }

inline CertifiedTask task_of(std::uint64_t collisions, int digits) {
  CertifiedTask task;
  task.collisions = collisions;
  task.digits = digits;
  return task;
}

/// Does the enclosure of a run of few digits contain that of many? Where the former took more
/// attempts it may have turned out the smaller one: then the two must meet.
inline bool holds(const CertifiedNumber& few, const CertifiedNumber& many) {
  const certify::Ball &a = certify::ball_of(few), &b = certify::ball_of(many);
  return few.log2_error() < many.log2_error() ? a.overlaps(b) : a.contains(b);
}

struct Shaped {
  TableSpec spec;
  ExactPoint inside;  ///< a point of the domain
};

inline Shaped shaped(const std::string& shape,
                     const std::vector<std::pair<const char*, const char*>>& numbers, const char* x,
                     const char* y) {
  Shaped s;
  s.spec.shape = shape;
  for (const auto& [key, text] : numbers) s.spec.numbers[key] = exactly(text);
  s.inside = {exactly(x), exactly(y)};
  return s;
}

/// One table of every shape.
inline std::vector<Shaped> all_shapes() {
  std::vector<Shaped> all{
      shaped("rectangle", {{"width", "1"}, {"height", "sqrt(2)/2"}}, "0.3", "0.2"),
      shaped("regular", {{"sides", "5"}, {"radius", "1"}, {"angle", "0.1"}}, "0.1", "0.2"),
      shaped("regular", {{"sides", "6"}, {"radius", "1"}, {"angle", "pi/2"}}, "0.1", "0.2"),
      shaped("circle", {{"radius", "0.9"}}, "0.1", "0.2"),
      shaped("ellipse", {{"a", "1"}, {"b", "3/4"}}, "0.1", "0.2"),
      shaped("annulus", {{"outer", "1"}, {"inner", "0.3"}, {"offset", "0.1"}}, "-0.6", "0.2"),
      shaped("stadium", {{"half_length", "1"}, {"radius", "1"}}, "0.1", "0.2"),
      shaped("mushroom", {{"cap_radius", "1"}, {"stem_width", "0.7"}, {"stem_height", "0.9"}},
             "0.1", "0.2"),
      shaped("lemon", {{"radius", "1"}, {"separation", "1.1"}}, "0.1", "0.2"),
      shaped("sinai", {{"side", "1"}, {"radius", "0.4"}}, "0.05", "0.07"),
      shaped("lorentz", {{"spacing", "2.2"}, {"radius", "1"}}, "1.09", "0.1"),
  };
  Shaped walled = shaped("sinai", {{"side", "1"}, {"radius", "0.3"}}, "0.05", "0.07");
  walled.spec.torus = false;
  all.push_back(walled);
  // A corner is free whatever the arrangement.
  Shaped many =
      shaped("random-discs", {{"side", "4"}, {"radius", "0.3"}, {"count", "7"}}, "0.02", "0.03");
  many.spec.torus = false;
  all.push_back(many);
  // Obstacles of every kind, one of them across the corners of a cell.
  Shaped room = shaped("rectangle", {{"width", "3"}, {"height", "2"}}, "0.3", "0.2");
  ObstacleSpec disc;
  disc.center = {exactly("1"), exactly("sqrt(2)/2")};
  disc.radius = exactly("1/3");
  ObstacleSpec egg = disc;
  egg.shape = ObstacleSpec::Shape::ellipse;
  egg.center = {exactly("2"), exactly("3/2")};
  egg.a = exactly("0.4");
  egg.b = exactly("0.2");
  egg.angle = exactly("pi/12");
  ObstacleSpec block;
  block.shape = ObstacleSpec::Shape::polygon;
  block.points = {{exactly("2"), exactly("0.2")},
                  {exactly("2.5"), exactly("1/3")},
                  {exactly("2.1"), exactly("sqrt(3)/2")}};
  room.spec.obstacles = {disc, egg, block};
  all.push_back(room);
  Shaped cell = shaped("sinai", {{"side", "2"}, {"radius", "0.4"}}, "0.05", "1.07");
  cell.spec.obstacles = {disc};
  cell.spec.obstacles[0].center = {};
  all.push_back(cell);
  Shaped polygon = shaped("polygon", {}, "0.3", "0.4");
  polygon.spec.points["points"] = {{exactly("0"), exactly("0")},
                                   {exactly("2"), exactly("0.1")},
                                   {exactly("0.5"), exactly("0.6")},
                                   {exactly("1/3"), exactly("sqrt(3)")}};
  all.push_back(polygon);
  Shaped path = shaped("path", {}, "0.3", "0.3");
  LoopSpec loop;
  loop.start = {exactly("0"), exactly("0")};
  PieceSpec line;
  line.to = {exactly("1"), exactly("0")};
  PieceSpec arc;
  arc.kind = PieceSpec::Kind::arc;
  arc.via = {exactly("1.1"), exactly("0.8")};
  arc.to = {exactly("0"), exactly("1")};
  PieceSpec dent;
  dent.kind = PieceSpec::Kind::arc;
  dent.via = {exactly("0.1"), exactly("0.5")};
  dent.to = {exactly("0"), exactly("0")};
  loop.pieces = {line, arc, dent};
  path.spec.loops = {loop};
  all.push_back(path);
  Shaped elliptic = path;
  PieceSpec bulge;
  bulge.kind = PieceSpec::Kind::ellipse;
  bulge.via = {exactly("1.2"), exactly("0.7")};
  bulge.to = {exactly("0"), exactly("1")};
  bulge.ratio = exactly("2/3");
  bulge.angle = exactly("pi/5");
  PieceSpec hollow = bulge;
  hollow.via = {exactly("0.1"), exactly("0.4")};
  hollow.to = {exactly("0"), exactly("0")};
  hollow.angle = exactly("0.4");
  elliptic.spec.loops[0].pieces = {line, bulge, hollow};
  all.push_back(elliptic);
  return all;
}

inline ExactSystem system_of(const Shaped& s, const ExactPoint& direction) {
  ExactSystem system;
  system.spec = std::make_shared<const TableSpec>(s.spec);
  system.table = std::make_shared<const Table>(build_table(s.spec));
  system.start.position = s.inside;
  system.start.direction = direction;
  return system;
}

}  // namespace carom::tests
