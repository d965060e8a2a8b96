// A part of a Bézier curve as a graph over its chord, for paths that are known step by step.
//
// In the frame of the part's chord the curve is y = h(s): s along the chord, y across it, towards
// the domain. Parts are so short that |h'| <= 1/2 and that X'(u), the rate of s, changes by a
// factor of at most 3/2: then a step of Newton's for X(u) = s leaves at most half of an error, and
// soon its square. Beyond its ends the graph goes on straight.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "carom/geometry/curve.hpp"

namespace carom::events {

/// The parameters between which a part lies.
struct CurvePart {
  double from = 0.0, to = 1.0;
  /// Too short to differ from its chord in double precision: at an end where the curve rests.
  bool straight = false;
};
/// Parts as above, in order, from 0 to 1.
std::vector<CurvePart> parts_of(const geometry::Bezier& curve);

template <class Real>
struct CurveGraph {
  using Vector = geometry::BasicVector<Real>;

  int degree = 1;
  std::array<Vector, geometry::Bezier::most + 1> control{};  ///< (s, y); the first is the origin
  Real slope{0}, bend{0}, turn{0};                           ///< bounds of |h'|, |h''| and |h'''|
  Real lowest{0}, highest{0};                                ///< h lies between them
  Real extent{0};  ///< largest 1-norm of the whole curve's points from that end

  const Real& length() const { return control[static_cast<std::size_t>(degree)].x; }
  struct Place {
    Real y, slope, bend;  ///< h, h' and h''
  };
  /// In units of epsilon / 2 of the extent, y errs by less than 72: the control points by 1 for
  /// their difference from the start, 15 for the part's and 8 for the frame, y by 15 more, and s,
  /// which counts half, by 39 and what Newton's steps leave, 16.
  static Real roundings() { return Real(72); }
  Place at(const Real& s) const {
    const auto size = [](const Real& a) { return a < Real(0) ? -a : a; };
    const Vector& last = control[static_cast<std::size_t>(degree)];
    if (!(s > Real(0))) return beyond(s, Vector{Real(0), Real(0)}, Real(0));
    if (!(s < last.x)) return beyond(s, last, Real(1));
    const Real enough = Real(8) * std::numeric_limits<Real>::epsilon() * extent;
    Real u = s / last.x;
    Jet jet = jet_at(u);
    for (int n = 0; n < 2 * std::numeric_limits<Real>::digits; ++n) {
      const Real off = jet.x.x - s;
      if (!(size(off) > enough)) break;
      u = u - off / jet.first.x;
      u = u < Real(0) ? Real(0) : Real(1) < u ? Real(1) : u;
      jet = jet_at(u);
    }
    return {jet.x.y, jet.first.y / jet.first.x,
            cross(jet.first, jet.second) / (jet.first.x * jet.first.x * jet.first.x)};
  }

 private:
  struct Jet {
    Vector x, first, second;  ///< and derivatives by u
  };
  /// De Casteljau.
  Jet jet_at(const Real& u) const {
    std::array<Vector, geometry::Bezier::most + 1> p = control;
    const auto pass = [&](int last) {
      for (std::size_t k = 0; k < static_cast<std::size_t>(last); ++k)
        p[k] = (Real(1) - u) * p[k] + u * p[k + 1];
    };
    for (int last = degree; last > 2; --last) pass(last);
    Vector second{Real(0), Real(0)};
    if (degree > 1) {
      second = Real(degree * (degree - 1)) * ((p[2] - p[1]) - (p[1] - p[0]));
      pass(2);
    }
    const Vector first = Real(degree) * (p[1] - p[0]);
    pass(1);
    return {p[0], first, second};
  }
  Place beyond(const Real& s, const Vector& end, const Real& u) const {
    const Vector along = jet_at(u).first;
    const Real rate = along.y / along.x;
    return {end.y + rate * (s - end.x), rate, Real(0)};
  }
};

/// A part in the frame of its chord. Points are from the curve's nearer end, so that those beside
/// it are fine.
template <class Real>
struct FramedGraph {
  using Vector = geometry::BasicVector<Real>;

  CurveGraph<Real> graph;
  geometry::Vector base;                                  ///< that end
  std::array<Vector, geometry::Bezier::most + 1> points;  ///< the part's control points
  Vector along, across;                                   ///< unit vectors of the chord

  FramedGraph(const geometry::Bezier& curve, const CurvePart& part)
      : base(part.from < 0.5 ? curve.from : curve.to) {
    using std::sqrt;
    const std::size_t d = static_cast<std::size_t>(curve.degree);
    const auto exact = [](const geometry::Vector& a) { return Vector{Real(a.x), Real(a.y)}; };
    std::array<Vector, geometry::Bezier::most + 1> all;
    for (std::size_t k = 0; k <= d; ++k) {
      all[k] = exact(curve.control(static_cast<int>(k))) - exact(base);
      graph.extent = larger(graph.extent, norm(all[k]));
    }
    // The curve's polar form at the part's ends, as often the one as the other.
    for (std::size_t k = 0; k <= d; ++k) {
      std::array<Vector, geometry::Bezier::most + 1> p = all;
      for (std::size_t last = d; last > 0; --last) {
        const Real t(last > k ? part.from : part.to);
        for (std::size_t i = 0; i < last; ++i) p[i] = (Real(1) - t) * p[i] + t * p[i + 1];
      }
      points[k] = p[0];
    }
    if (part.straight) points[1] = points[d];
    graph.degree = part.straight ? 1 : curve.degree;
    const Vector chord = end() - points[0];
    along = (Real(1) / sqrt(dot(chord, chord))) * chord;
    across = left(along);
    for (std::size_t k = 0; k <= static_cast<std::size_t>(graph.degree); ++k) {
      const Vector e = points[k] - points[0];
      graph.control[k] = {dot(along, e), dot(across, e)};
    }
    bound();
  }
  const Vector& end() const { return points[static_cast<std::size_t>(graph.degree)]; }
  /// As CurveGraph's steps of Newton's ask for.
  bool is_short() const {
    return Real(0) < least_rate_ && Real(2) * largest_rate_ < Real(3) * least_rate_ &&
           Real(2) * largest_climb_ < least_rate_;
  }

 private:
  static Real size(const Real& a) { return a < Real(0) ? -a : a; }
  static Real norm(const Vector& a) { return size(a.x) + size(a.y); }
  static Real larger(const Real& a, const Real& b) { return a < b ? b : a; }

  /// By the coefficients of the derivatives. With X' >= a and the largest sizes of the others,
  /// |h'| <= Y'/a, h'' = (X'Y'' - Y'X'') / X'^3 and
  /// h''' = ((X'Y''' - Y'X''') X' - 3 X'' (X'Y'' - Y'X'')) / X'^5.
  void bound() {
    std::array<Vector, geometry::Bezier::most + 1> p = graph.control;
    std::array<Vector, 4> most{};  // sizes of each derivative's coordinates
    int degree = graph.degree;
    for (std::size_t order = 1; order < most.size() && degree > 0; ++order, --degree)
      for (std::size_t k = 0; k < static_cast<std::size_t>(degree); ++k) {
        p[k] = Real(degree) * (p[k + 1] - p[k]);
        most[order] = {larger(most[order].x, size(p[k].x)), larger(most[order].y, size(p[k].y))};
        if (order == 1 && (k == 0 || p[k].x < least_rate_)) least_rate_ = p[k].x;
      }
    for (std::size_t k = 0; k <= static_cast<std::size_t>(graph.degree); ++k) {
      const Real& y = graph.control[k].y;
      graph.lowest = y < graph.lowest ? y : graph.lowest;
      graph.highest = larger(graph.highest, y);
    }
    largest_rate_ = most[1].x;
    largest_climb_ = most[1].y;
    const auto area = [&](std::size_t order) {
      return most[1].x * most[order].y + most[1].y * most[order].x;
    };
    // All terms are positive, and rounded less than 64 times.
    const Real more = Real(1) + Real(64) * std::numeric_limits<Real>::epsilon();
    const Real &a = least_rate_, square = a * a, cube = a * square;
    graph.slope = more * most[1].y / a;
    graph.bend = more * area(2) / cube;
    graph.turn = more * (most[1].x * area(3) + Real(3) * most[2].x * area(2)) / (square * cube);
  }

  Real least_rate_{0}, largest_rate_{0}, largest_climb_{0};
};

}  // namespace carom::events
