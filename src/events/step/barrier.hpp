// A curve seen from integrated motion: the sign of a gap, which the path of a particle must not
// change.
//
// Free flights meet curves by algebra (next_hit.hpp). A path that is only known step by step meets
// the zero of a gap function: the distance from a line, (1 - |y|^2)/2 where y is the point seen
// from a conic in units of its axes, or the height above the graph of a part of a Bézier curve. The
// gap is positive on the domain's side.
#pragma once

#include <cmath>
#include <limits>
#include <memory>

#include "carom/geometry/curve.hpp"
#include "carom/geometry/lattice.hpp"
#include "events/step/curve_graph.hpp"

namespace carom::events {

template <class Real>
struct Barrier {
  using Vector = geometry::BasicVector<Real>;

  bool conic = false;
  std::shared_ptr<const CurveGraph<Real>> graph;  ///< of a part of a Bézier curve; else null
  Vector origin;  ///< a point of the line; the graph's; centre of the conic
  /// Line: unit normal into the domain, and unused; conic: rows of the map to y; graph: unit
  /// vectors across the chord, into the domain, and along it.
  Vector first, second;
  Real orientation{1};                        ///< conic: +1 domain inside, -1 outside
  bool closed = false;                        ///< every point of the carrier belongs to the piece
  bool begins_wall = true, ends_wall = true;  ///< a part's ends may lie within its wall
  Vector from, to;                            ///< ends of the piece, if it has any
  Real reach_from{0}, reach_to{0};            ///< there, reach_of_wall of the walls that meet it
  Real zone_from{0},
      zone_to{0};  ///< how far from there a particle on those may be beyond this wall
  Real thin_from{0}, thin_to{0};  ///< how far from there both sides of a needle are one to rounding
  Real side{1};  ///< conic: the piece lies where side * cross(to - from, x - from) <= 0
  Real lowest{0}, highest{0};  ///< graph: its heights above the chord lie between them
  Vector low, high;            ///< a box about the piece, larger than any rounding
  int wall = -1;               ///< which wall or support it is
  geometry::Cell cell;         ///< the cell whose copy of it this is
  Real slack{0};               ///< at least on_wall() roundings of the gap, everywhere on the piece

  Real gap(const Vector& x) const {
    const Vector e = x - origin;
    if (graph) return dot(first, e) - graph->at(dot(second, e)).y;
    if (!conic) return dot(first, e);
    const Real p = dot(first, e), q = dot(second, e);
    return orientation * (Real(1) - (p * p + q * q)) / Real(2);
  }
  /// Bound on the rounding error of gap(x): differences, two products and two sums a coordinate,
  /// each within half an epsilon of what it is made of; for a conic |y| is about 1 where it
  /// matters. Of a graph: 6 for the height, as the origin was rounded twice, half as many for the
  /// place, and those of the graph itself.
  Real rounding(const Vector& x) const {
    const Real half = std::numeric_limits<Real>::epsilon() / Real(2);
    const auto size = [](const Real& a) { return a < Real(0) ? -a : a; };
    const Real reach = size(x.x) + size(x.y) + size(origin.x) + size(origin.y);
    const Real largest = size(first.x) + size(first.y) + size(second.x) + size(second.y);
    if (graph)
      return half * (Real(6) * largest * reach + CurveGraph<Real>::roundings() * graph->extent);
    return Real(conic ? 8 : 4) * half * largest * reach;
  }
  /// How many roundings a particle on the wall may be from it: the search for a hit leaves it
  /// within one, another wall of the corner moves it onto itself by two, the next cell of a lattice
  /// has it within one more.
  static Real on_wall() { return Real(4); }
  /// Is the particle on the piece, or beyond it, to rounding?
  bool is_on(const Vector& x) const {
    const Real g = gap(x);
    return !(g > Real(0)) && !(g < -off_wall(x)) &&
           (covers(x) || is_at(End::from, x) || is_at(End::to, x));
  }
  /// How far below 0 the gap of a particle may be that is on this wall, or at a joint on the one
  /// that it meets there.
  Real off_wall(const Vector& x) const {
    Real most = on_wall() * rounding(x);
    if (closed) return most;
    for (const End end : {End::from, End::to}) {
      const Real other = stretch() * (end == End::from ? reach_from : reach_to);
      if (most < other &&
          (is_at(end, x) || is_within(end == End::from ? zone_from : zone_to, end, x)))
        most = other;
    }
    return most;
  }
  /// The gap changes by no more than this times the way.
  Real stretch() const {
    const auto size = [](const Real& a) { return a < Real(0) ? -a : a; };
    return size(first.x) + size(first.y) + size(second.x) + size(second.y);
  }
  /// Rate of change of the gap at x for the velocity v.
  Real rate(const Vector& x, const Vector& v) const {
    const Vector e = x - origin;
    if (graph) return dot(first, v) - graph->at(dot(second, e)).slope * dot(second, v);
    if (!conic) return dot(first, v);
    return -orientation * (dot(first, e) * dot(first, v) + dot(second, e) * dot(second, v));
  }
  /// Bound on what rate(x, v) errs against the exact normal by, in epsilon halves. Line: the unit
  /// normal 5, products and sum 3. Conic: a map to y 9, twice; its rows 5, twice; the point and the
  /// centre 4 together. Graph: twice a line's, 64 of the slope, what the place changes that by, and
  /// what the control points, which err by 32 of the extent, turn the tangent by: the degree times
  /// two of them, over the length.
  Real rate_rounding(const Vector& x, const Vector& v) const {
    const Real half = std::numeric_limits<Real>::epsilon() / Real(2);
    const auto size = [](const Real& a) { return a < Real(0) ? -a : a; };
    const Real largest = size(first.x) + size(first.y) + size(second.x) + size(second.y);
    const Real speed = size(v.x) + size(v.y);
    if (graph)
      return speed * (Real(80) * half + graph->bend * rounding(x) +
                      Real(64 * graph->degree) * half * graph->extent / graph->length());
    if (!conic) return Real(8) * half * largest * speed;
    const Real reach = size(x.x) + size(x.y) + size(origin.x) + size(origin.y);
    return Real(32) * half * (largest * reach) * (largest * speed);
  }
  /// A normal into the domain, of any length.
  Vector normal(const Vector& x) const {
    const Vector e = x - origin;
    if (graph) return first - graph->at(dot(second, e)).slope * second;
    if (!conic) return first;
    return (-orientation * dot(first, e)) * first + (-orientation * dot(second, e)) * second;
  }
  /// How far from the wall a particle on it may be.
  Real reach_of_wall(const Vector& x) const {
    const auto size = [](const Real& a) { return a < Real(0) ? -a : a; };
    const auto norm = [&](const Vector& a) { return size(a.x) + size(a.y); };
    if (graph) return on_wall() * rounding(x);
    // The gap of a conic changes by 1 / axis or more with the way, and a row is as long as that.
    const Real p = norm(first), q = norm(second);
    return on_wall() * rounding(x) / (!conic || p < q ? p : q);
  }
  /// Does a point on the carrier lie on the piece, ends included? A path through the end of one
  /// piece, which is where the next begins, is found beyond either by no more than a particle on
  /// the wall is off it: both pieces reach as far beyond their ends.
  bool covers(const Vector& x) const {
    if (closed) return true;
    const Vector chord = to - from, e = x - from;
    const auto size = [](const Real& a) { return a < Real(0) ? -a : a; };
    const Real beyond = (size(chord.x) + size(chord.y)) * reach_of_wall(x);
    if (conic) return !(side * cross(chord, e) > beyond);
    const Real along = dot(chord, e);
    return !(along < -beyond) && !(along > dot(chord, chord) + beyond);
  }
  /// One of the ends: its point, and how far from it particles may be that are on this wall, or on
  /// the one that it meets there.
  enum class End { from, to };
  const Vector& point(End end) const { return end == End::from ? from : to; }
  Real reach_of_joint(End end, const Real& reach) const {
    const Real& other = end == End::from ? reach_from : reach_to;
    return Real(2) * (reach < other ? other : reach);
  }
  /// Is a point on the carrier that end of the piece, to rounding?
  bool is_at(End end, const Vector& x) const {
    return is_within(reach_of_joint(end, reach_of_wall(x)), end, x);
  }
  bool is_within(const Real& distance, End end, const Vector& x) const {
    const auto size = [](const Real& a) { return a < Real(0) ? -a : a; };
    const Vector e = x - point(end);
    return !closed && !(size(e.x) + size(e.y) > distance);
  }
  /// Is the point, which is on the wall, where a needle is too thin to tell its sides apart?
  bool is_thin(const Vector& x) const {
    return (thin_from > Real(0) && is_within(thin_from, End::from, x)) ||
           (thin_to > Real(0) && is_within(thin_to, End::to, x));
  }
  /// Its end meets another wall.
  void meet(End end, const Barrier& other);
};

// A particle on the other wall is within its reach R of it. Along that wall, a way s from the
// joint, the two are apart by s sin(angle) - k s^2 / 2, or more, k being the sum of their
// curvatures: so the particle is beyond this wall where s is less than the smaller root of R = s
// sin(angle) - k s^2 / 2, and nowhere by more than R. Likewise a needle between the two is thinner
// than the reaches of both together.
template <class Real>
void Barrier<Real>::meet(End end, const Barrier& other) {
  using std::sqrt;
  const auto length = [](const Vector& a) { return sqrt(dot(a, a)); };
  const bool begins = end == End::from;
  const Vector joint = point(end), own = normal(joint), others = other.normal(joint);
  const Real reach = other.reach_of_wall(joint), lengths = length(own) * length(others);
  (begins ? reach_from : reach_to) = reach;
  if (slack < stretch() * reach) slack = stretch() * reach;
  const Real turn = begins ? cross(others, own) : cross(own, others);
  const Real turn_error = rate_rounding(joint, others) + other.rate_rounding(joint, own);
  const auto curvature = [&](const Barrier& b, const Vector& n) {
    if (b.graph) return b.graph->bend;
    return b.conic ? (dot(b.first, b.first) + dot(b.second, b.second)) / length(n) : Real(0);
  };
  const Real curvatures = curvature(*this, own) + curvature(other, others);
  // A reach grows along the walls as the size of their points does, whose 1-norm is less than twice
  // the way.
  const auto norm = [](const Vector& a) {
    return (a.x < Real(0) ? -a.x : a.x) + (a.y < Real(0) ? -a.y : a.y);
  };
  const auto grows = [&](const Barrier& b, const Real& at_joint) {
    const Real size = norm(joint) + norm(b.origin);
    return size > Real(0) ? Real(2) * at_joint / size : Real(0);
  };
  // Twice the way to where the walls are `apart`, or 0 if they need not come to be. The 1-norm is
  // less than that.
  const auto way = [&](const Real& sine, const Real& apart) {
    const Real square = sine * sine - Real(2) * curvatures * apart;
    return sine > Real(0) && square > Real(0) ? Real(4) * apart / (sine + sqrt(square)) : Real(0);
  };
  const bool sharp = dot(own, others) < Real(0);
  Real& zone = begins ? zone_from : zone_to;
  zone = way((turn - turn_error) / lengths - grows(other, reach), reach);
  if (sharp && !(zone > Real(0)) && !(turn < -turn_error))
    zone =
        std::numeric_limits<Real>::infinity();  // a cusp, or too sharp to be distinguished from one
  const Real here = reach_of_wall(joint);
  if (sharp)
    (begins ? thin_from : thin_to) = way(
        (-turn - turn_error) / lengths - grows(other, reach) - grows(*this, here), reach + here);
}

}  // namespace carom::events
