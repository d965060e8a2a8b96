// A path: loops of straight, circular and elliptic pieces.
#include "table/numbers.hpp"
#include "table/shapes.hpp"

namespace carom::table::shapes {
namespace {

using geometry::Vector;

Chain path_loop(const LoopSpec& loop, std::size_t walls_before) {
  if (loop.pieces.empty())
    throw InputError(loop.place, "the loop has no pieces", "a list of pieces");
  const Vector start = point(loop.start);
  Vector from = start;
  ExactPoint written_from = loop.start;
  Chain chain;
  for (const PieceSpec& piece : loop.pieces) {
    const Vector to = point(piece.to);
    if (to == from && piece.kind != PieceSpec::Kind::bezier) {
      throw InputError(piece.place, "the piece ends where it begins", "two different points");
    }
    const std::size_t number = walls_before + chain.size() + 1;
    const std::string name = piece.name.empty() ? "wall_" + std::to_string(number) : piece.name;
    chain.push_back({name, WrittenPiece{written_from, piece}});
    from = to;
    written_from = piece.to;
  }
  if (!(from == start)) {
    throw InputError(loop.pieces.back().place,
                     "the path is open: it ends at (" + loop.pieces.back().to.x.text() + ", " +
                         loop.pieces.back().to.y.text() + ")",
                     "a last piece that ends at the start (" + loop.start.x.text() + ", " +
                         loop.start.y.text() + ")");
  }
  return chain;
}

}  // namespace

Shape path(const TableSpec& spec) {
  if (spec.loops.empty()) {
    throw InputError(place_of(spec, "loop"), "the shape 'path' needs a loop", "[[table.loop]]");
  }
  Shape shape;
  std::size_t walls = 0;
  bool outer = false;
  for (const LoopSpec& loop : spec.loops) {
    shape.loops.push_back(path_loop(loop, walls));
    walls += loop.pieces.size();
    double area = 0.0;
    for (const NamedCurve& piece : shape.loops.back())
      area += geometry::area_integral(rounded(piece.curve));
    outer = outer || area > 0;
  }
  // Clockwise loops alone are obstacles in the open plane.
  if (!outer) shape.extent = Extent::open_plane;
  return shape;
}

}  // namespace carom::table::shapes
