// A path: loops of pieces, whole circles and ellipses.
#include "table/closed_curves.hpp"
#include "table/numbers.hpp"

namespace carom::table::shapes {
namespace {

Chain chain_of(const LoopSpec& loop, std::size_t walls_before) {
  const auto name = [&](std::size_t k) { return "wall_" + std::to_string(walls_before + k + 1); };
  const std::string own = loop.name.empty() ? name(0) : loop.name;
  switch (loop.kind) {
    case LoopSpec::Kind::circle:
      return {{own, WrittenCircle{loop.center, loop.radius, true}}};
    case LoopSpec::Kind::ellipse:
      size_of(loop.b, "b");
      return {{own, WrittenEllipse{loop.center, loop.a, loop.b, loop.angle, true}}};
    case LoopSpec::Kind::pieces:
      break;
  }
  return loop_of_pieces(loop, name);
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
    Chain chain = chain_of(loop, walls);
    walls += chain.size();
    outer = outer || area_of(chain) > 0.0;
    shape.loops.push_back(std::move(chain));
  }
  // Clockwise loops alone are obstacles in the open plane.
  if (!outer) shape.extent = Extent::open_plane;
  return shape;
}

}  // namespace carom::table::shapes
