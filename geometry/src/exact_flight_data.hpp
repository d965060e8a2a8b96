// The inside of ExactFlight.
#pragma once

#include <utility>
#include <vector>

#include "algebraic_root.hpp"
#include "carom/geometry/exact_flight.hpp"
#include "carom/geometry/formulas.hpp"
#include "exact_bezier.hpp"
#include "exact_boundary.hpp"
#include "exact_crossing.hpp"

namespace carom::geometry {

inline const Dyadic& one_half() {
  static const Dyadic half(0.5);
  return half;
}

struct ExactFlight::Data {
  const ExactBoundary::Data& boundary;
  ExactPoint start;
  DyadicVector v;
  Dyadic omega;
  double u;  // on the piece where it starts

  /// The start seen from a cell: the pieces stay where they are and the flight is displaced.
  struct View {
    Dyadic x, y, w;
  };
  View view(int piece, Cell cell) const {
    const Cell o = boundary.pieces[static_cast<std::size_t>(piece)].offset;
    const Cell c{cell.first + o.first, cell.second + o.second};
    if (c == Cell{}) return {start.x, start.y, start.w};
    const DyadicVector t = boundary.translation(c);
    return {start.x - start.w * t.x, start.y - start.w * t.y, start.w};
  }
  const ExactCurve& curve(int piece) const { return boundary.curve(piece); }

  /// Point minus start, times the positive factor start.w point.w, and that factor.
  static std::pair<DyadicVector, Dyadic> offset(const View& s, const ExactPoint& at) {
    return {{at.x * s.w - s.x * at.w, at.y * s.w - s.y * at.w}, s.w * at.w};
  }
  int side(const View& s, const ExactPoint& at) const {
    const auto [d, f] = offset(s, at);
    return side_of_flight(f * v, d, omega).sign();
  }
  /// kappa of a point that lies on the flight.
  Crossing through(const View& s, const ExactPoint& at) const {
    const auto [d, f] = offset(s, at);
    return rational_crossing(f * dot(d, v), dot(d, d));
  }

  /// F N w^2 (or w) > 0 on the domain's side, as a quadratic in kappa.
  Quadratic<Dyadic> quadratic(const ExactCurve& c, const View& s) const {
    const DyadicVector e{s.x - s.w * (c.segment ? c.from.x : c.centre.x),
                         s.y - s.w * (c.segment ? c.from.y : c.centre.y)};
    const DyadicVector wv = s.w * v;
    if (c.segment) return line_quadratic(e, c.direction, wv, omega, one_half());
    const Dyadic r2 = s.w * s.w * c.r2;
    Quadratic<Dyadic> f;
    if (c.metric.euclidean)
      f = circle_quadratic(e, r2, wv, dot(wv, wv), omega, one_half());
    else  // without field only
      f = {c.metric(e, e) - r2, c.metric(e, wv), c.metric(wv, wv)};
    return c.orientation > 0 ? -f : f;
  }
  Polynomial quartic(const ExactCurve& c, const View& s) const {
    const DyadicVector e{s.x - s.w * c.centre.x, s.y - s.w * c.centre.y};
    const DyadicVector jv = right(v);
    const Dyadic h = c.metric(e, e) - s.w * s.w * c.r2;
    const Dyadic n = one_half() * omega * one_half() * omega;
    const Dyadic ev = s.w * c.metric(e, v), ew = omega * s.w * c.metric(e, jv);
    const Dyadic w2 = s.w * s.w, two(2);
    Polynomial f{n * (n * h + ew + w2 * c.metric(jv, jv)),
                 two * n * ev + omega * w2 * c.metric(v, jv),
                 two * n * h + ew + w2 * c.metric(v, v), two * ev, h};
    if (c.orientation > 0)
      for (Dyadic& q : f) q = -q;
    return f;
  }
  bool needs_quartic(const ExactCurve& c) const {
    return !c.segment && !c.metric.euclidean && omega.sign() != 0;
  }

  /// Sign of cross(b - a, x - a) at a crossing, for two exact points of the plane.
  int side_of_chord(const View& s, const ExactPoint& a, const ExactPoint& b,
                    const Crossing& k) const {
    const DyadicVector chord{b.x * a.w - a.x * b.w, b.y * a.w - a.y * b.w};
    const DyadicVector e{s.x * a.w - a.x * s.w, s.y * a.w - a.y * s.w};  // (P - a) s.w a.w
    return sign_at_crossing(line_quadratic(e, chord, s.w * a.w * v, omega, one_half()), k);
  }
  /// Is the crossing, a point of the conic, on its part from a to b?
  bool on_part(const ExactCurve& c, const View& s, const ExactPoint& a, const ExactPoint& b,
               const Crossing& k) const {
    return side_of_chord(s, a, b, k) * c.orientation < 0;
  }

  std::vector<Crossing> exits(int piece, Cell cell, bool starts_here, bool ends_here,
                              bool start_at_joint, std::vector<int>* zero_joints) const;
  std::vector<Crossing> touches(int piece, Cell cell, bool starts_here, bool ends_here) const;
  FlightAtCurve at_curve(const ExactCurve& c, const View& s, bool starts_here,
                         bool ends_here) const {
    FlightAtCurve flight{c, {s.x, s.y, s.w}, v, omega, {}};
    if (starts_here) flight.known.emplace_back(u);
    if (ends_here) flight.known.emplace_back(1);
    return flight;
  }
  /// The velocity at a crossing, times a positive factor.
  DyadicVector velocity_at(const Crossing& k) const {
    const Dyadic h = one_half() * omega;
    const Dyadic cosine = k.p * k.p - h * h * k.r * k.r, sine = Dyadic(2) * k.p * k.r * h;
    const DyadicVector jv = right(v);
    return {cosine * v.x + sine * jv.x, cosine * v.y + sine * jv.y};
  }
  bool segment_crossed_twice(const ExactCurve& c, const View& s, int side,
                             const Quadratic<Dyadic>& f) const;
  /// Is the foot of the Larmor circle's centre strictly between the ends of a segment?
  bool foot_between_ends(const ExactCurve& c, const View& s) const;
  /// On which side of a piece's carrier the flight is just before and after it meets its end at k
  /// (rational).
  AroundEnd around(int piece, bool at_end, Cell cell, const Crossing& k) const;
  /// Does the flight, which passes through the start of a piece at k, come to it through the domain
  /// and not merely touch?
  bool hits_joint(int piece, Cell cell, const Crossing& k) const;
};

}  // namespace carom::geometry
