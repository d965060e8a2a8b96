// Tables as they were written, in any arithmetic that can enclose or hold the numbers of a system
// file.
#pragma once

#include <variant>

#include "carom/base/error.hpp"
#include "certify/number/exact_value.hpp"
#include "certify/wall/ball_table.hpp"
#include "table/shapes.hpp"

namespace carom::certify {

/// How an arithmetic N takes numbers that were written: value(number), and direction(angle, part,
/// whole), the cosine and sine of an angle plus a part of whole turns.
template <class N>
struct Source;
template <>
struct Source<Ball> {
  static Ball value(const ExactNumber& number) { return value_of(number); }
  static BallVector direction(const ExactNumber& angle, long part = 0, long whole = 1) {
    const CosSin d = direction_of(angle, part, whole);
    return {d.cos, d.sin};
  }
};

template <class N>
struct WallBuilder {
  static N value(const ExactNumber& number) { return Source<N>::value(number); }
  static VectorOf<N> point(const ExactPoint& p) { return {value(p.x), value(p.y)}; }
  static VectorOf<N> point(const table::shapes::WrittenPoint& p) {
    if (const auto* written = std::get_if<ExactPoint>(&p)) return point(*written);
    const auto& corner = std::get<table::shapes::RegularCorner>(p);
    return value(corner.radius) * Source<N>::direction(corner.angle, corner.part, corner.whole);
  }

  WallOf<N> operator()(const table::shapes::WrittenSegment& s) const {
    return segment_wall(point(s.from), point(s.to));
  }
  WallOf<N> operator()(const table::shapes::WrittenArc& s) const {
    return arc_wall(point(s.from), point(s.to), point(s.centre), square(value(s.radius)), true);
  }
  WallOf<N> operator()(const table::shapes::WrittenCircle& s) const {
    return circle_wall(point(s.centre), value(s.radius), s.counterclockwise);
  }
  WallOf<N> operator()(const table::shapes::WrittenEllipse& s) const {
    const N a = value(s.a);
    return ellipse_wall(point(s.centre), a * Source<N>::direction(s.angle), value(s.b) / a,
                        s.counterclockwise);
  }
  WallOf<N> operator()(const table::shapes::WrittenPiece& s) const {
    const VectorOf<N> from = point(s.from), to = point(s.piece.to);
    if (s.piece.kind == PieceSpec::Kind::bezier) refuse(s.piece.place);
    if (s.piece.kind == PieceSpec::Kind::line) return segment_wall(from, to);
    if (s.piece.kind == PieceSpec::Kind::arc)
      return arc_through(from, point(s.piece.via), to, s.piece.place);
    return elliptic_arc(from, s.piece);
  }

  WallOf<N> operator()(const geometry::Bezier&) const { refuse({}); }

 private:
  [[noreturn]] static void refuse(const Place& place) {
    throw InputError(place, "orbits are not certified beside Bézier curves on a lattice",
                     "walls of segments, circles and ellipses, or no lattice");
  }
  static WallOf<N> arc_through(const VectorOf<N>& from, const VectorOf<N>& via,
                               const VectorOf<N>& to, const Place& place) {
    const VectorOf<N> c = to - from, f = via - from;
    const N turn = cross(f, c);  // > 0: counter-clockwise
    const Sign side = sign(turn);
    if (side != Sign::positive && side != Sign::negative)
      throw InputError(place, "no arc leads through these three points", "a point beside the line");
    // The centre lies at from + e with 2 e.c = c.c and 2 e.f = f.f.
    const N cc = dot(c, c), ff = dot(f, f), twice = N(2) * turn;
    const VectorOf<N> e{(ff * c.y - cc * f.y) / twice, (cc * f.x - ff * c.x) / twice};
    return arc_wall(from, to, from + e, dot(e, e), side == Sign::positive);
  }
  // In the frame of its axes, the minor one stretched, it is an arc of a circle.
  static WallOf<N> elliptic_arc(const VectorOf<N>& from, const PieceSpec& piece) {
    const VectorOf<N> axis = Source<N>::direction(piece.angle), other = left(axis);
    const N ratio = Source<N>::value(piece.ratio);
    const auto seen = [&](const VectorOf<N>& P) {
      return VectorOf<N>{dot(P, axis), dot(P, other) / ratio};
    };
    const VectorOf<N> to = point(piece.to);
    const WallOf<N> circle = arc_through(seen(from), seen(point(piece.via)), seen(to), piece.place);
    const VectorOf<N> centre = circle.centre.x * axis + (ratio * circle.centre.y) * other;
    return elliptic_arc_wall(from, to, centre, sqrt(circle.radius2) * axis, ratio, circle.turn > 0);
  }
};

template <class N>
TableOf<N> table_of(const TableSpec& spec) {
  TableOf<N> table;
  const table::shapes::Shape shape = table::shapes::written_shape(spec);
  for (const table::shapes::Chain& chain : shape.loops)
    for (const table::shapes::NamedCurve& wall : chain)
      table.walls.push_back(std::visit(WallBuilder<N>{}, wall.curve));
  if (const auto& lattice = spec.lattice ? spec.lattice : shape.lattice)
    table.lattice = {WallBuilder<N>::point(lattice->first), WallBuilder<N>::point(lattice->second)};
  return table;
}

}  // namespace carom::certify
