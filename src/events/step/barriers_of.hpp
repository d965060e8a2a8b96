// The barriers of curves and of a table's walls, in any Real.
#pragma once

#include <cmath>
#include <cstddef>
#include <memory>
#include <variant>
#include <vector>

#include "carom/geometry/curve.hpp"
#include "carom/table/table.hpp"
#include "events/step/barrier.hpp"

namespace carom::events {

namespace barriers {

template <class Real>
geometry::BasicVector<Real> exact(const geometry::Vector& a) {
  return {Real(a.x), Real(a.y)};
}

/// Its box, widened, and its slack, which follows from that.
template <class Real>
void bound(Barrier<Real>& b, const geometry::BasicVector<Real>& low,
           const geometry::BasicVector<Real>& high) {
  using Vector = geometry::BasicVector<Real>;
  const auto size = [](const Real& a) { return a < Real(0) ? -a : a; };
  const auto larger = [&](const Real& p, const Real& q) {
    return size(p) < size(q) ? size(q) : size(p);
  };
  const Real wider = Real(0x1p-20) * (size(low.x) + size(low.y) + size(high.x) + size(high.y));
  b.low = low - Vector{wider, wider};
  b.high = high + Vector{wider, wider};
  b.slack =
      Barrier<Real>::on_wall() * b.rounding({larger(b.low.x, b.high.x), larger(b.low.y, b.high.y)});
  // Near the origin roundings are those of the rest of a curve.
  b.low = b.low - Vector{b.slack, b.slack};
  b.high = b.high + Vector{b.slack, b.slack};
}

/// Of a segment, or a conic or an arc of one.
template <class Real>
Barrier<Real> of_conic(const geometry::Curve& curve, const geometry::BasicVector<Real>& shift) {
  using Vector = geometry::BasicVector<Real>;
  using std::sqrt;
  const auto length = [](const Vector& a) { return sqrt(dot(a, a)); };
  Barrier<Real> b;
  const auto conic = [&](const Vector& centre, const Vector& along, const Real& a,
                         const Real& ratio, bool ccw) {
    const Vector unit = (Real(1) / length(along)) * along;
    b.conic = true;
    b.origin = centre + shift;
    b.first = (Real(1) / a) * unit;
    b.second = (Real(1) / (a * ratio)) * left(unit);
    b.orientation = ccw ? Real(1) : Real(-1);
    b.side = b.orientation;
  };
  const auto ends = [&](const geometry::Vector& from, const geometry::Vector& to) {
    b.from = exact<Real>(from) + shift;
    b.to = exact<Real>(to) + shift;
  };
  if (const auto* s = std::get_if<geometry::Segment>(&curve)) {
    ends(s->from, s->to);
    const Vector chord = b.to - b.from;
    b.origin = b.from;
    b.first = left((Real(1) / length(chord)) * chord);
  } else if (const auto* c = std::get_if<geometry::Circle>(&curve)) {
    b.closed = true;
    conic(exact<Real>(c->centre), Vector{Real(1), Real(0)}, Real(c->radius), Real(1),
          c->counterclockwise);
  } else if (const auto* e = std::get_if<geometry::Ellipse>(&curve)) {
    b.closed = true;
    conic(exact<Real>(e->centre), exact<Real>(e->axis), length(exact<Real>(e->axis)),
          Real(e->ratio), e->counterclockwise);
  } else if (const auto* a = std::get_if<geometry::CircularArc>(&curve)) {
    const Vector from = exact<Real>(a->from), to = exact<Real>(a->to);
    const Vector centre = Real(0.5) * (from + to) + Real(a->offset) * left(to - from);
    conic(centre, from - centre, length(from - centre), Real(1), a->counterclockwise);
    ends(a->from, a->to);
  } else if (const auto* l = std::get_if<geometry::EllipticArc>(&curve)) {
    // centre = middle + offset K(to - from), K e = -(e.q) p + k^2 (e.p) q (curve.hpp).
    const Vector from = exact<Real>(l->from), to = exact<Real>(l->to), axis = exact<Real>(l->axis);
    const Vector q = left(axis), chord = to - from;
    const Real k = Real(l->ratio);
    const Vector centre =
        Real(0.5) * (from + to) +
        Real(l->offset) * ((-dot(chord, q)) * axis + (k * k * dot(chord, axis)) * q);
    const Vector r = from - centre;
    const Real along = dot(r, axis), across = dot(r, q) / k;
    conic(centre, axis, sqrt((along * along + across * across) / dot(axis, axis)), k,
          l->counterclockwise);
    ends(l->from, l->to);
  }
  const geometry::Box box = geometry::bounding_box(curve);
  bound(b, exact<Real>(box.low) + shift, exact<Real>(box.high) + shift);
  return b;
}

template <class Real>
Barrier<Real> of_part(const geometry::Bezier& curve, const CurvePart& part,
                      const geometry::BasicVector<Real>& shift) {
  using Vector = geometry::BasicVector<Real>;
  const FramedGraph<Real> framed(curve, part);
  const Vector start = exact<Real>(framed.base) + shift;
  Barrier<Real> b;
  b.graph = std::make_shared<const CurveGraph<Real>>(framed.graph);
  b.begins_wall = part.from == 0.0;
  b.ends_wall = part.to == 1.0;
  b.from = b.origin = start + framed.points[0];
  b.to = b.ends_wall ? exact<Real>(curve.to) + shift : start + framed.end();
  b.first = framed.across;
  b.second = framed.along;
  b.lowest = framed.graph.lowest;
  b.highest = framed.graph.highest;
  Vector low = b.from, high = b.from;
  for (int k = 1; k <= framed.graph.degree; ++k) {
    const Vector x = start + framed.points[static_cast<std::size_t>(k)];
    low = {x.x < low.x ? x.x : low.x, x.y < low.y ? x.y : low.y};
    high = {high.x < x.x ? x.x : high.x, high.y < x.y ? x.y : high.y};
  }
  bound(b, low, high);
  return b;
}

}  // namespace barriers

/// The barriers of a curve displaced by `shift`, in order: several of a Bézier curve, one of
/// others. Their numbers are those of the curve, computed in Real.
template <class Real>
std::vector<Barrier<Real>> barriers_of(const geometry::Curve& curve,
                                       const geometry::BasicVector<Real>& shift) {
  std::vector<Barrier<Real>> all;
  if (const auto* bezier = std::get_if<geometry::Bezier>(&curve)) {
    for (const CurvePart& part : parts_of(*bezier))
      all.push_back(barriers::of_part<Real>(*bezier, part, shift));
  } else {
    all.push_back(barriers::of_conic<Real>(curve, shift));
  }
  return all;
}

/// Those of a wall, which know those that they meet.
template <class Real>
std::vector<Barrier<Real>> barriers_of(const Table& table, int wall,
                                       const geometry::BasicVector<Real>& shift) {
  using End = typename Barrier<Real>::End;
  const Wall& w = table.wall(wall);
  std::vector<Barrier<Real>> all = barriers_of<Real>(w.curve, shift);
  for (Barrier<Real>& b : all) b.wall = wall;
  if (all.front().closed) return all;
  for (std::size_t k = 0; k + 1 < all.size(); ++k) {
    all[k].meet(End::to, all[k + 1]);
    all[k + 1].meet(End::from, all[k]);
  }
  all.front().meet(End::from, barriers_of<Real>(table.wall(w.previous).curve, shift).back());
  all.back().meet(End::to, barriers_of<Real>(table.wall(w.next).curve, shift).front());
  return all;
}

}  // namespace carom::events
