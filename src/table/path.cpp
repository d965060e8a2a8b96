// A path: loops of straight, circular and elliptic pieces.
#include <stdexcept>

#include "table/direction.hpp"
#include "table/numbers.hpp"
#include "table/shapes.hpp"

namespace carom::shapes {
namespace {

using geometry::Vector;

geometry::Curve curve_of(const PieceSpec& piece, Vector from, Vector to) {
  switch (piece.kind) {
    case PieceSpec::Kind::line:
      return geometry::Segment{from, to};
    case PieceSpec::Kind::arc:
      try {
        return geometry::arc_through(from, point(piece.via), to);
      } catch (const std::invalid_argument&) {
        throw InputError(piece.place, "no circular arc leads through these three points",
                         "arc_via beside the straight line to arc_to");
      }
    case PieceSpec::Kind::ellipse:
      break;
  }
  try {
    const double ratio = size_of(piece.ratio, "ellipse_ratio");
    return geometry::elliptic_arc_through(from, point(piece.via), to, direction(piece.angle), ratio);
  } catch (const std::invalid_argument&) {
    throw InputError(piece.place, "no elliptic arc leads through these three points",
                     "ellipse_via beside the straight line to ellipse_to");
  }
}

void add_path_loop(const LoopSpec& loop, Table& table) {
  if (loop.pieces.empty()) throw InputError(loop.place, "the loop has no pieces", "a list of pieces");
  const Vector start = point(loop.start);
  Vector from = start;
  std::vector<NamedCurve> chain;
  for (const PieceSpec& piece : loop.pieces) {
    const Vector to = point(piece.to);
    if (to == from) {
      throw InputError(piece.place, "the piece ends where it begins", "two different points");
    }
    const std::size_t number = table.walls.size() + chain.size() + 1;
    const std::string name = piece.name.empty() ? "wall_" + std::to_string(number) : piece.name;
    chain.push_back({name, curve_of(piece, from, to)});
    from = to;
  }
  if (!(from == start)) {
    throw InputError(
        loop.pieces.back().place,
        "the path is open: it ends at (" + loop.pieces.back().to.x.text() + ", " +
            loop.pieces.back().to.y.text() + ")",
        "a last piece that ends at the start (" + loop.start.x.text() + ", " + loop.start.y.text() + ")");
  }
  add_loop(table, std::move(chain));
}

}  // namespace

void path(const TableSpec& spec, Table& table) {
  if (spec.loops.empty()) {
    throw InputError(place_of(spec, "loop"), "the shape 'path' needs a loop", "[[table.loop]]");
  }
  bool outer = false;
  for (const LoopSpec& loop : spec.loops) {
    const std::size_t first = table.walls.size();
    add_path_loop(loop, table);
    double area = 0.0;
    for (std::size_t k = first; k < table.walls.size(); ++k) {
      area += geometry::area_integral(table.walls[k].curve);
    }
    outer = outer || area > 0;
  }
  // Clockwise loops alone are obstacles in the open plane.
  if (!outer) table.extent = Extent::open_plane;
}

}  // namespace carom::shapes
