#include "events/flight/next_hit.hpp"

#include <cmath>

#include "base/index.hpp"
#include "events/flight/bounded.hpp"
#include "events/flight/crossing.hpp"

namespace carom::events {

using namespace geometry;

HitFinder::HitFinder(const PieceTable& pieces)
    : t_(pieces), origins_(t_.offsets.size()), left_(t_.data.size()) {
  const int signs = t_.signs.size();
  if (signs > 0) exits_.resize(static_cast<std::size_t>(signs) << signs, unknown_exit);
  if (!t_.grid) return;
  seen_.resize(t_.data.size());
  seen_offsets_.resize(t_.offsets.size());
}

void HitFinder::look_from_all(const Flight& f) {
  for (std::size_t k = 0; k < origins_.size(); ++k)
    origins_[k] = t_.origin_of(f, static_cast<int>(k));
}

namespace {

using base::at;

/// A flight and a piece that it may leave the domain through.
struct Meeting {
  const PieceTable& table;
  const Flight& flight;
  const Origin& origin;
  const PreparedCurve& curve;
  int piece;
  bool on_wall;    ///< the particle is on it
  bool same_side;  ///< both its joints lie on one side of the flight; not of closed curves …
  bool left;       ///< … on the left

  QuadraticError error() const {
    return quadratic_error(curve, origin.point, origin.scale, on_wall);
  }
  /// Does the flight meet the whole line or conic at all?
  Sign is_cut(const Crossing& c) const {
    return sign_within(c.root.discriminant, discriminant_error(c.quadratic, error()));
  }
};

/// Without field: certain that no flight from here leaves through the arc when both its joints lie
/// on one side. The foot of the centre on the line is the middle of its chord in the circle: if
/// both crossings lay on the arc, so would the foot lie on the arc's side of the chord of its
/// joints.
[[gnu::always_inline]] inline bool foot_off_arc(const PreparedCurve& w, Vector origin, Vector v,
                                                const FlightScale& s) {
  const ChordSide foot = foot_beyond_chord(w, origin, v, s);
  return foot.value > foot.bound;
}

/// Is the foot of the Larmor circle's centre on a segment's line between its ends?
[[gnu::always_inline]] inline Sign foot_between(const PreparedCurve& w, Vector origin, Vector v,
                                                double omega, const FlightScale& s) {
  const Feet feet = feet_of_centre(w, origin, v, omega, s);
  if ((feet.first < -feet.bound) | (feet.last < -feet.bound)) return Sign::negative;
  return ((feet.first > feet.bound) & (feet.last > feet.bound)) ? Sign::positive : Sign::undecided;
}

/// Without field: is the rising crossing ahead (kappa > 0)?
[[gnu::always_inline]] inline Sign ahead_of_start(const Quadratic<double>& q,
                                                  const QuadraticError& e) {
  // A line's constant coefficient is exactly zero: its other crossing, at kappa = 0, is never
  // reached.
  if (q.b > e.b) return q.c == 0.0 && e.c == 0.0 ? Sign::negative : -sign_within(q.c, e.c);
  if (q.b < -e.b) return sign_within(q.a, e.a);
  if (q.a > e.a && q.c < -e.c) return Sign::positive;
  if (q.a < -e.a && q.c > e.c) return Sign::negative;
  return Sign::undecided;
}

/// Is a flight from `origin` to a conic so long that hits on it were misplaced, had the curve not
/// been made for that (table/thin_walls.hpp)? It is on a lattice, or from far off in the plane.
bool is_far(const PreparedCurve& w, Vector origin, double start) {
  const double way = norm_1(origin - w.centre), small = w.parametrisation.minor;
  return 8.0 * unit_roundoff * way * (way + start + w.extent) > 0x1p-16 * small * small;
}

// Does a flight leave the domain through a piece, and where? One function for each kind of flight
// and piece, at most one of them for each piece of a table. Positive: it does, at `c`. Negative: it
// does not. Undecided: the bounds do not tell.

[[gnu::always_inline]] inline Sign line_through_segment(const Meeting& m, Crossing& c) {
  if (m.same_side) return Sign::negative;
  const Vector e = m.origin.point - m.curve.from;
  c.time = geometry::fused_cross(m.curve.tangent, e);
  c.unit = -geometry::fused_cross(m.curve.tangent, m.flight.velocity);
  return sign_within(c.time, line_error(m.origin.scale, norm_1(e)).a);  // else it lies behind
}

[[gnu::always_inline]] inline Sign line_through_conic(const Meeting& m, Crossing& c) {
  const PreparedCurve& w = m.curve;
  const Flight& f = m.flight;
  if (m.same_side && !m.on_wall) {
    if (w.kind == CurveKind::circle && foot_off_arc(w, m.origin.point, f.velocity, m.origin.scale))
      return Sign::negative;
    const Sign leaves = m.table.crossed_twice(f, m.piece, m.origin);
    if (leaves != Sign::positive) return leaves;
  }
  // Standing on the wall: the other crossing of the conic lies ahead exactly when the particle is
  // inside it.
  if (m.on_wall && w.orientation < 0) return Sign::negative;
  Quadratic<double>& q = c.quadratic;
  q = quadratic<false>(w, m.origin.point, f.velocity, f.square_speed, 0.0, m.on_wall);
  c.root = m.on_wall ? Root{q.b * q.b, std::fabs(q.b), 0.0} : rising_root(q);
  const Quotient quotient = straight_time(q, c.root.root);
  c.time = quotient.time;
  c.unit = quotient.unit;
  if (m.on_wall) return Sign::positive;
  if (w.closed) {
    const Sign cut = m.is_cut(c);
    if (cut != Sign::positive) return cut;
  }
  const QuadraticError e = m.error();
  return w.orientation > 0 && q.a > e.a ? Sign::positive  // from inside a conic: always
                                        : ahead_of_start(q, e);
}

/// The crossing of a Larmor circle with a line or a circle, if there is one.
[[gnu::always_inline]] inline void cross_larmor(const Meeting& m, Crossing& c) {
  const Flight& f = m.flight;
  Quadratic<double>& q = c.quadratic;
  q = quadratic<true>(m.curve, m.origin.point, f.velocity, f.square_speed, f.omega, m.on_wall);
  c.root = m.on_wall ? Root{q.b * q.b, std::fabs(q.b), -q.c / (2.0 * q.b)} : rising_root(q);
}

[[gnu::always_inline]] inline Sign larmor_through_segment(const Meeting& m, Crossing& c) {
  const bool twice = m.same_side && !m.on_wall;
  if (twice) {
    const double omega = m.flight.omega;
    if (m.left == (omega < 0.0)) return Sign::negative;  // inside the Larmor circle: it is convex
    const Sign between =
        foot_between(m.curve, m.origin.point, m.flight.velocity, omega, m.origin.scale);
    if (between != Sign::positive) return between;
  }
  cross_larmor(m, c);
  return twice ? m.is_cut(c) : Sign::positive;
}

[[gnu::always_inline]] inline Sign larmor_through_circle(const Meeting& m, Crossing& c) {
  if (m.same_side && !m.on_wall) {
    const Sign leaves = m.table.crossed_twice(m.flight, m.piece, m.origin);
    if (leaves != Sign::positive) return leaves;
  }
  cross_larmor(m, c);
  return m.curve.closed && !m.on_wall ? m.is_cut(c) : Sign::positive;
}

inline Sign larmor_through_ellipse(const Meeting& m, Crossing& c) {
  return m.table.first_exit(m.flight, m.piece, m.origin, m.origin.scale.inflation, c);
}

// By value: an origin or a crossing whose address is given away lives in memory, and all walls wait
// for it.
[[gnu::noinline]] std::pair<Sign, Crossing> bezier_crossing(const PieceTable& table,
                                                            const Flight& flight, int piece,
                                                            Origin origin) {
  std::pair<Sign, Crossing> found;
  found.first = table.bezier_exit(flight, piece, origin, origin.scale.inflation, found.second);
  return found;
}

inline Sign through_bezier(const Meeting& m, Crossing& c) {
  const std::pair<Sign, Crossing> found = bezier_crossing(m.table, m.flight, m.piece, m.origin);
  c = found.second;
  return found.first;
}

template <bool larmor>
[[gnu::always_inline]] inline Sign leaves_through(const Meeting& m, Crossing& c) {
  const bool segment = m.curve.kind == CurveKind::segment;
  if constexpr (larmor)
    return segment                              ? larmor_through_segment(m, c)
           : m.curve.kind == CurveKind::ellipse ? larmor_through_ellipse(m, c)
           : m.curve.kind == CurveKind::bezier  ? through_bezier(m, c)
                                                : larmor_through_circle(m, c);
  else
    return segment                             ? line_through_segment(m, c)
           : m.curve.kind == CurveKind::bezier ? through_bezier(m, c)
                                               : line_through_conic(m, c);
}

/// Fills in what two crossings are compared by: kappa, which is kept as a quotient without field,
/// and its error.
template <bool larmor>
[[gnu::always_inline]] inline void complete(const Meeting& m, Crossing& c) {
  if (!larmor) c.root.kappa = c.unit / c.time;
  if (c.error >= 0) return;
  c.error = !larmor && m.curve.kind == CurveKind::segment
                ? straight_line_error(m.curve, m.origin.point, m.origin.scale, c.root.kappa, c.time)
                : kappa_error(c.quadratic, m.error(), c.root);
}

}  // namespace

/// On which side of the flight are the joints of all pieces? False: the bounds do not tell.
template <bool larmor, bool cells>
bool HitFinder::see_all_joints(const Flight& f, const Origin& single) {
  const auto side_of = [&](Vector d) {
    return larmor ? side_of_flight(f.velocity, d, f.omega) : 2.0 * geometry::cross(f.velocity, d);
  };
  const double farthest = cells ? 0.0 : side_error(single.scale, t_.reach + norm_1(single.point));
  bool decided = true;
  for (const int piece : t_.open) {
    const Origin& origin = cells ? origins_[at(t_.data[at(piece)].offset)] : single;
    const Vector d = t_.joints[at(piece)] - origin.point;
    const double side = side_of(d);
    const double bound = cells ? side_error(origin.scale, norm_1(d)) : farthest;
    left_[at(piece)] = side > 0.0;
    decided &= std::fabs(side) > bound;
  }
  if (decided || cells) return decided;
  for (const int piece : t_.open) {  // once more with a bound for each joint
    const Vector d = t_.joints[at(piece)] - single.point;
    if (!(std::fabs(side_of(d)) > side_error(single.scale, norm_1(d)))) return false;
  }
  return true;
}

template <bool larmor, bool cells, bool listed>
bool HitFinder::filtered_of(const Flight& f, Ahead& ahead, std::span<const int> list,
                            double& found_error) {
  if (f.start_previous >= 0) return false;  // from a joint: by algebra
  // Without a lattice there is one origin: kept in registers.
  const Origin single{f.start,
                      {f.start_error, norm_1(f.velocity), larmor ? std::fabs(f.omega) : 0.0,
                       t_.options.filter_inflation}};
  if (!(listed ? see_joints<larmor, cells>(f, list) : see_all_joints<larmor, cells>(f, single)))
    return false;
  const auto meeting = [&](int piece) {
    const PieceTable::PieceData& p = t_.data[at(piece)];
    const bool from = left_[at(piece)] != 0, to = left_[at(p.next)] != 0;
    return Meeting{t_,
                   f,
                   cells ? origins_[at(p.offset)] : single,
                   *p.shape,
                   piece,
                   piece == f.start_piece,
                   !p.closed && from == to,
                   from};
  };

  // On a cell's edges nothing counts before the flight came in.
  const bool entered = larmor && cells && f.entry >= 0;
  double since = 0.0, since_error = 0.0;
  if (entered) {
    const Origin& origin = origins_[0];
    const Crossing entry = t_.crossing_of(f, f.entry, origin, false);
    const PreparedCurve& edge = *t_.data[at(f.entry)].shape;
    const Root root = falling_root(entry.quadratic);
    since = root.kappa;
    since_error = kappa_error(-entry.quadratic,
                              quadratic_error(edge, origin.point, origin.scale, false), root);
  }

  int best = -1;
  Crossing first;
  const int pieces = static_cast<int>(listed ? list.size() : t_.data.size());
  for (int k = 0; k < pieces; ++k) {
    const int piece = listed ? list[at(k)] : k;
    const PieceTable::PieceData& p = t_.data[at(piece)];
    // At most two crossings, so the sides of its joints tell, except for a Larmor circle that may
    // cross an ellipse four times, and for Bézier curves.
    const bool known =
        !p.closed && !(larmor && p.kind == CurveKind::ellipse) && p.kind != CurveKind::bezier;
    if (known && left_[at(piece)] != 0 && left_[at(p.next)] == 0) continue;  // it enters
    const Meeting m = meeting(piece);
    Crossing c;
    const Sign leaves = leaves_through<larmor>(m, c);
    if (leaves == Sign::undecided) return false;
    if (leaves != Sign::positive) continue;
    if (entered && p.edge) {
      complete<larmor>(m, c);
      const Sign after = sign_within(since - c.root.kappa, since_error + c.error);
      if (after == Sign::undecided) return false;
      if (after == Sign::negative) continue;
    }
    if (best >= 0) {
      complete<larmor>(meeting(best), first);
      complete<larmor>(m, c);
      // Two questions, so that the processor need not wait for the errors to go on with the first
      // wall.
      const double gap = c.root.kappa - first.root.kappa;
      if (!(std::fabs(gap) > c.error + first.error)) return false;
      if (gap < 0.0) continue;
    }
    best = piece;
    first = c;
  }

  if (larmor && best >= 0) {
    const Meeting m = meeting(best);
    if (m.curve.kind == CurveKind::bezier) {
      // Its number is certain already.
    } else if (!t_.is_quartic(f, best)) {
      if (!far_root_certain(first.quadratic, m.error(), m.on_wall)) return false;
    } else if (t_.options.filter_inflation != 1.0) {
      // Bounds are allowed to change where a quartic's root is looked for, not the number that is
      // found.
      Crossing c;
      if (t_.first_exit(f, best, m.origin, 1.0, c) != Sign::positive) return false;
      first.root.kappa = c.root.kappa;
    }
  }
  if (t_.thin && best >= 0) [[unlikely]] {
    const double duration = first.time / first.unit;
    if (t_.is_rough(f, best) || (!larmor && !(duration > 0.0 && duration < HUGE_VAL))) return false;
  }
  if constexpr (listed) {
    if (best >= 0) complete<larmor>(meeting(best), first);
    found_error = first.error;
  }
  ahead.piece = best;
  ahead.root = 0;
  ahead.u = first.u;
  ahead.kappa = larmor ? first.root.kappa : first.unit / first.time;
  ahead.duration = larmor ? duration_at(first.root.kappa, f.omega) : first.time / first.unit;
  ahead.kind = best < 0                 ? Ahead::Kind::none
               : t_.data[at(best)].edge ? Ahead::Kind::edge
                                        : Ahead::Kind::wall;
  return true;
}
template bool HitFinder::filtered_of<false, false, true>(const Flight&, Ahead&,
                                                         std::span<const int>, double&);
template bool HitFinder::filtered_of<false, true, true>(const Flight&, Ahead&, std::span<const int>,
                                                        double&);
template bool HitFinder::filtered_of<true, false, true>(const Flight&, Ahead&, std::span<const int>,
                                                        double&);
template bool HitFinder::filtered_of<true, true, true>(const Flight&, Ahead&, std::span<const int>,
                                                       double&);

template <bool larmor>
bool HitFinder::filtered_alone(const Flight& f, int piece, Ahead& ahead) const {
  if (f.start_previous >= 0 || piece == f.start_piece || t_.thin) return false;
  const PieceTable::PieceData& p = t_.data[at(piece)];
  if (p.kind != CurveKind::segment && p.kind != CurveKind::bezier) return false;
  const Meeting m{t_, f, origins_[0], *p.shape, piece, false, false, false};
  Crossing c;
  if (p.kind == CurveKind::bezier) {
    if (t_.bezier_exit(f, piece, m.origin, m.origin.scale.inflation, c) != Sign::positive)
      return false;
  } else if constexpr (larmor) {
    cross_larmor(m, c);
    if (!far_root_certain(c.quadratic, m.error(), false)) return false;
  } else {
    if (line_through_segment(m, c) != Sign::positive) return false;
  }
  ahead.kind = Ahead::Kind::wall;
  ahead.piece = piece;
  ahead.root = 0;
  ahead.u = c.u;
  ahead.kappa = larmor ? c.root.kappa : c.unit / c.time;
  ahead.duration = larmor ? duration_at(c.root.kappa, f.omega) : c.time / c.unit;
  return true;
}
template bool HitFinder::filtered_alone<false>(const Flight&, int, Ahead&) const;
template bool HitFinder::filtered_alone<true>(const Flight&, int, Ahead&) const;

Ahead HitFinder::exact_next(const Flight& f, const std::vector<int>& pieces) const {
  const ExactFlight::First first =
      t_.exact_flight(f).first(pieces, f.cell, f.entry, f.start_piece, f.start_previous);
  Ahead ahead;
  ahead.piece = first.piece;
  ahead.root = first.root;
  switch (first.kind) {
    case ExactFlight::First::Kind::none:
      return ahead;
    case ExactFlight::First::Kind::joint:
      ahead.kind = Ahead::Kind::joint;
      break;
    case ExactFlight::First::Kind::cusp:
      ahead.kind = Ahead::Kind::cusp;
      break;
    case ExactFlight::First::Kind::exit:
      ahead.kind = t_.data[at(first.piece)].edge ? Ahead::Kind::edge : Ahead::Kind::wall;
      break;
  }
  const Origin origin = t_.origin_of(f, t_.data[at(ahead.piece)].offset);
  if (ahead.kind == Ahead::Kind::joint) {
    const Vector d = t_.joints[at(ahead.piece)] - origin.point;
    ahead.kappa = dot(d, f.velocity) / dot(d, d);
  } else if (t_.is_rough(f, ahead.piece)) {
    ahead.kappa = first.kappa;
  } else if (t_.piece(ahead.piece).kind == CurveKind::bezier) {
    Crossing c;
    const bool same = t_.bezier_exit(f, ahead.piece, origin, 1.0, c) == Sign::positive;
    ahead.u = same ? c.u : first.u;
    ahead.kappa = same ? c.root.kappa : first.kappa;
    if (f.omega == 0.0) {
      ahead.duration = same ? c.time / c.unit : 1.0 / first.kappa;
      return ahead;
    }
  } else if (t_.is_quartic(f, ahead.piece)) {
    Crossing c;
    const bool same = t_.first_exit(f, ahead.piece, origin, 1.0, c) == Sign::positive;
    ahead.kappa = same ? c.root.kappa : first.kappa;
  } else {
    const bool on_wall = PieceTable::is_on(f, ahead.piece);
    const Crossing c = t_.crossing_of(f, ahead.piece, origin, on_wall);
    ahead.kappa = c.root.kappa;
    if (f.omega == 0.0) {
      const Quotient quotient = straight_time(c.quadratic, c.root.root);
      ahead.duration = quotient.time / quotient.unit;
    }
    // A flight along a wall to the last digit, or of no length: the formula in doubles may have
    // lost the sign, and in a field a full turn with it. Else its number is good enough, if
    // cancelled: a root that errs much belongs to a graze or to a start beside the wall, and the
    // place of the hit to few ulps either way, as tables have no flat arcs. It must be the filter's
    // number, as results do not depend on the stage; so this question does not on the inflation.
    FlightScale scale = origin.scale;
    scale.inflation = 1.0;
    const QuadraticError error =
        quadratic_error(*t_.data[at(ahead.piece)].shape, origin.point, scale, on_wall);
    // So does one from so far that the sign of the discriminant is not known in doubles: the
    // filter, which asks it of closed curves, did not decide, and the hit would be anywhere on the
    // curve.
    const PreparedCurve& w = *t_.data[at(ahead.piece)].shape;
    const bool hidden = w.closed && !on_wall && is_far(w, origin.point, norm_1(f.start)) &&
                        !(c.root.discriminant > discriminant_error(c.quadratic, error));
    const bool lost =
        hidden || (f.omega == 0.0 ? !(ahead.duration > 0.0) || !std::isfinite(ahead.duration)
                                  : !std::isfinite(ahead.kappa) ||
                                        !far_root_certain(c.quadratic, error, on_wall));
    if (lost) ahead.kappa = first.kappa;
    if (f.omega == 0.0 && !lost) return ahead;
  }
  ahead.duration = duration_at(ahead.kappa, f.omega);
  return ahead;
}

void HitFinder::next_of_all(const Flight& f, Ahead& ahead, DecisionCounts& counts) {
  const bool cells = t_.cells;
  if (cells) look_from_all(f);
  if (f.omega == 0.0 ? (cells ? filtered<false, true>(f, ahead) : filtered<false, false>(f, ahead))
                     : (cells ? filtered<true, true>(f, ahead) : filtered<true, false>(f, ahead))) {
    ++counts.filter;
  } else {
    ++counts.exact;
    ahead = exact_next(f, t_.all());
  }
  if (ahead.kind == Ahead::Kind::none) ahead.duration = 0.0;
}

}  // namespace carom::events
