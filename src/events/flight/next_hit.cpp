#include "events/flight/next_hit.hpp"

#include <cmath>
#include <limits>

#include "events/flight/bounded.hpp"
#include "events/flight/crossing.hpp"

namespace carom {

using namespace geometry;

namespace {

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

ExactFlight HitFinder::exact_flight(const Flight& f) const {
  return ExactFlight(*exact_, f.wall, f.u, f.start, f.velocity, f.omega);
}

namespace {

/// Without field: certain that no flight from here leaves through the arc when both its joints lie
/// on one side. The foot of the centre on the line is the middle of its chord in the circle: if
/// both crossings lay on the arc, so would the foot lie on the arc's side of the chord of its
/// joints.
[[gnu::always_inline]] inline bool foot_off_arc(const PreparedCurve& w, Vector origin, Vector v,
                                                const FlightScale& s) {
  const Bounded foot = foot_beyond_chord(w, origin, v, s);
  return foot.value > foot.bound;
}

/// Is the foot of the Larmor circle's centre on a segment's line between its ends?
[[gnu::always_inline]] inline Sign foot_between(const PreparedCurve& w, Vector origin, Vector v,
                                                double omega, const FlightScale& s) {
  const Feet feet = feet_of_centre(w, origin, v, omega, s);
  if ((feet.first < -feet.bound) | (feet.last < -feet.bound)) return Sign::negative;
  return (feet.first > feet.bound) & (feet.last > feet.bound) ? Sign::positive : Sign::undecided;
}

/// Without field: is the rising crossing ahead (kappa > 0)?
Sign ahead_of_start(const Quadratic<double>& q, const QuadraticError& e) {
  // A line's constant coefficient is exactly zero: its other crossing, at kappa = 0, is never
  // reached.
  if (q.b > e.b) return q.c == 0.0 && e.c == 0.0 ? Sign::negative : -sign_within(q.c, e.c);
  if (q.b < -e.b) return sign_within(q.a, e.a);
  if (q.a > e.a && q.c < -e.c) return Sign::positive;
  if (q.a < -e.a && q.c > e.c) return Sign::negative;
  return Sign::undecided;
}

}  // namespace

template <bool larmor, bool cells, bool listed>
bool HitFinder::filtered_of(const Flight& f, Ahead& ahead, std::span<const int> list,
                            double& found_error) const {
  if (f.start_previous >= 0) return false;  // from a joint: by algebra
  const Vector v = f.velocity;
  const double omega = larmor ? f.omega : 0.0;
  const int start = f.start_piece;
  // Without a lattice there is one origin: kept in registers.
  const Origin single{f.start,
                      {f.start_error, norm_1(v), std::fabs(omega), options_.filter_inflation}};
  const auto origin_of = [&](const PieceData& p) -> const Origin& {
    return cells ? origins_[at(p.offset)] : single;
  };

  if constexpr (listed) {
    if (!see_joints<larmor, cells>(f, list)) return false;
  } else {
    const double farthest = cells ? 0.0 : side_error(single.scale, reach_ + norm_1(single.point));
    bool decided = true;
    for (const int piece : open_) {
      const Origin& origin = origin_of(data_[at(piece)]);
      const Vector d = joints_[at(piece)] - origin.point;
      const double side = larmor ? side_of_flight(v, d, omega) : 2.0 * geometry::cross(v, d);
      const double bound = cells ? side_error(origin.scale, norm_1(d)) : farthest;
      left_[at(piece)] = side > 0.0;
      decided &= std::fabs(side) > bound;
    }
    if (!decided && cells) return false;
    if (!decided) {  // once more with a bound for each joint
      for (const int piece : open_) {
        const Vector d = joints_[at(piece)] - single.point;
        const double side = larmor ? side_of_flight(v, d, omega) : 2.0 * geometry::cross(v, d);
        if (!(std::fabs(side) > side_error(single.scale, norm_1(d)))) return false;
      }
    }
  }

  int best = -1;
  double best_kappa = 0.0, best_error = -1.0;  // negative: not computed yet
  Quadratic<double> best_q;
  Root best_root;
  const auto error_of = [&](int piece, const Quadratic<double>& f2, const Root& r, double kappa,
                            double time) {
    const PieceData& p = data_[at(piece)];
    const Origin& origin = origin_of(p);
    if (!larmor && p.kind == CurveKind::segment)
      return straight_line_error(*p.shape, origin.point, origin.scale, kappa, time);
    return kappa_error(f2, quadratic_error(*p.shape, origin.point, origin.scale, piece == start),
                       {r.discriminant, r.root, kappa});
  };
  double best_time = 0.0,
         best_unit = 1.0;  // without field: kappa = unit / time, divided only if needed
  double entered = std::numeric_limits<double>::infinity(), entered_error = 0.0;
  if (larmor && cells && f.entry >= 0) {
    const Candidate entry = candidate(f, f.entry, false);
    const Root root = falling_root(entry.quadratic);
    entered = root.kappa;
    entered_error = kappa_error(-entry.quadratic, entry.error, root);
  }
  const int pieces = static_cast<int>(listed ? list.size() : data_.size());
  for (int k = 0; k < pieces; ++k) {
    const int piece = listed ? list[at(k)] : k;
    const PieceData& p = data_[at(piece)];
    const bool stands = piece == start;
    bool twice = false;
    // At most two crossings: the joints' sides tell. (A Larmor circle may cross an ellipse four
    // times.)
    if (!p.closed && !(larmor && p.kind == CurveKind::ellipse)) {
      const bool from = left_[at(piece)] != 0, to = left_[at(p.next)] != 0;
      if (from && !to) continue;
      if (from == to && !larmor && p.kind == CurveKind::segment) continue;
      twice = from == to && !stands;
      if (larmor && twice && p.kind == CurveKind::segment) {
        if (from == (omega < 0.0)) continue;  // both inside the Larmor circle: never, by convexity
        const Origin& origin = origin_of(p);
        const Sign between = foot_between(*p.shape, origin.point, v, omega, origin.scale);
        if (between == Sign::undecided) return false;
        if (between == Sign::negative) continue;
      } else if (twice) {
        const PreparedCurve& w = *p.shape;
        const Origin& origin = origin_of(p);
        if (!larmor && p.kind == CurveKind::circle &&
            foot_off_arc(w, origin.point, v, origin.scale))
          continue;
        const Sign leaves = crossed_twice(f, piece);
        if (leaves == Sign::undecided) return false;
        if (leaves != Sign::positive) continue;
      }
    }
    const PreparedCurve& w = *p.shape;
    const Origin& origin = origin_of(p);
    double kappa = 0.0, error = -1.0, time = 0.0, unit = 1.0;
    Quadratic<double> q;
    Root root;
    if (larmor && w.kind == CurveKind::ellipse) {
      if (!cells) look_from(f);
      Candidate c;
      const Sign leaves = quartic_candidate(f, piece, options_.filter_inflation, c);
      if (leaves == Sign::undecided) return false;
      if (leaves != Sign::positive) continue;
      kappa = c.root.kappa;
      error = c.kappa_error;
    } else if (!larmor && w.kind == CurveKind::segment) {
      const Vector e = origin.point - w.from;
      const double a = geometry::fused_cross(w.tangent, e);
      const double bound = line_error(origin.scale, norm_1(e)).a;
      if (a < -bound) continue;  // behind
      if (!(a > bound)) return false;
      time = a;
      unit = -geometry::fused_cross(w.tangent, v);
    } else {
      // Standing on the wall, without field: the other crossing of the circle lies ahead exactly
      // when the particle is inside it.
      if (!larmor && stands && w.orientation < 0) continue;
      q = quadratic<larmor>(w, origin.point, v, f.square_speed, omega, stands);
      root = stands ? Root{q.b * q.b, std::fabs(q.b), larmor ? -q.c / (2.0 * q.b) : 0.0}
                    : rising_root(q);
      kappa = root.kappa;
      if (!larmor) {
        const Quotient quotient = straight_time(q, root.root);
        time = quotient.time;
        unit = quotient.unit;
      }
      const bool may_miss = w.closed || (larmor && twice && w.kind == CurveKind::segment);
      if (!stands && (!larmor || may_miss)) {
        const QuadraticError e = quadratic_error(w, origin.point, origin.scale, stands);
        if (may_miss) {
          const Sign cut = sign_within(root.discriminant, discriminant_error(q, e));
          if (cut == Sign::undecided) return false;
          if (cut != Sign::positive) continue;
        }
        if (!larmor && !(w.orientation > 0 && q.a > e.a)) {  // from inside a circle: always
          const Sign forward = ahead_of_start(q, e);
          if (forward == Sign::undecided) return false;
          if (forward == Sign::negative) continue;
        }
      }
    }
    if (larmor && cells && p.edge && f.entry >= 0) {
      error = kappa_error_of(f, piece);
      const Sign after = sign_within(entered - kappa, entered_error + error);
      if (after == Sign::undecided) return false;
      if (after == Sign::negative) continue;
    }
    if (best >= 0) {
      if (!larmor) {
        kappa = unit / time;
        best_kappa = best_unit / best_time;
      }
      if (best_error < 0) best_error = error_of(best, best_q, best_root, best_kappa, best_time);
      if (error < 0) error = error_of(piece, q, root, kappa, time);
      // Two questions, so that the processor need not wait for the errors to go on with the first
      // wall.
      const double gap = kappa - best_kappa;
      if (!(std::fabs(gap) > error + best_error)) return false;
      if (gap < 0.0) continue;
    }
    best = piece;
    best_kappa = kappa;
    best_error = error;
    best_time = time;
    best_unit = unit;
    best_q = q;
    best_root = root;
  }
  if (larmor && best >= 0 && !is_quartic(f, best)) {
    const PieceData& p = data_[at(best)];
    const Origin& origin = origin_of(p);
    const QuadraticError e = quadratic_error(*p.shape, origin.point, origin.scale, best == start);
    if (!far_root_certain(best_q, e, best == start)) return false;
  }
  // Bounds are allowed to change where a quartic's root is looked for, not the number that is
  // found.
  if (larmor && best >= 0 && options_.filter_inflation != 1.0 && is_quartic(f, best)) {
    Candidate c;
    if (quartic_candidate(f, best, 1.0, c) != Sign::positive) return false;
    best_kappa = c.root.kappa;
  }
  ahead.piece = best;
  ahead.root = 0;
  ahead.kappa = larmor ? best_kappa : best_unit / best_time;
  ahead.duration = larmor ? duration_at(best_kappa, f.omega) : best_time / best_unit;
  ahead.kind = best < 0               ? Ahead::Kind::none
               : data_[at(best)].edge ? Ahead::Kind::edge
                                      : Ahead::Kind::wall;
  if constexpr (listed) {
    if (best >= 0 && best_error < 0)
      best_error = error_of(best, best_q, best_root, ahead.kappa, best_time);
    found_error = best_error;
  }
  return true;
}
template bool HitFinder::filtered_of<false, false, true>(const Flight&, Ahead&,
                                                         std::span<const int>, double&) const;
template bool HitFinder::filtered_of<false, true, true>(const Flight&, Ahead&, std::span<const int>,
                                                        double&) const;
template bool HitFinder::filtered_of<true, false, true>(const Flight&, Ahead&, std::span<const int>,
                                                        double&) const;
template bool HitFinder::filtered_of<true, true, true>(const Flight&, Ahead&, std::span<const int>,
                                                       double&) const;

Ahead HitFinder::exact_next(const Flight& f, const std::vector<int>& pieces) const {
  look_from(f);
  const ExactFlight::First first =
      exact_flight(f).first(pieces, f.cell, f.entry, f.start_piece, f.start_previous);
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
      ahead.kind = data_[at(first.piece)].edge ? Ahead::Kind::edge : Ahead::Kind::wall;
      break;
  }
  if (ahead.kind == Ahead::Kind::joint) {
    const PieceData& p = data_[at(ahead.piece)];
    const Vector d = joints_[at(ahead.piece)] - origins_[at(p.offset)].point;
    ahead.kappa = dot(d, f.velocity) / dot(d, d);
  } else if (is_quartic(f, ahead.piece)) {
    Candidate c;
    const bool same = quartic_candidate(f, ahead.piece, 1.0, c) == Sign::positive;
    ahead.kappa = same ? c.root.kappa : first.kappa;
  } else {
    const Candidate c = candidate(f, ahead.piece, stands_on(f, ahead.piece));
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
    const PieceData& p = data_[at(ahead.piece)];
    FlightScale scale = origins_[at(p.offset)].scale;
    scale.inflation = 1.0;
    const bool stands = stands_on(f, ahead.piece);
    const QuadraticError error =
        quadratic_error(*p.shape, origins_[at(p.offset)].point, scale, stands);
    const bool lost = f.omega == 0.0 ? !(ahead.duration > 0.0) || !std::isfinite(ahead.duration)
                                     : !std::isfinite(ahead.kappa) ||
                                           !far_root_certain(c.quadratic, error, stands);
    if (lost) ahead.kappa = first.kappa;
    if (f.omega == 0.0 && !lost) return ahead;
  }
  ahead.duration = duration_at(ahead.kappa, f.omega);
  return ahead;
}

void HitFinder::next_of_all(const Flight& f, Ahead& ahead, DecisionCounts& counts) const {
  const bool cells = cells_;
  if (cells) look_from(f);
  if (f.omega == 0.0 ? (cells ? filtered<false, true>(f, ahead) : filtered<false, false>(f, ahead))
                     : (cells ? filtered<true, true>(f, ahead) : filtered<true, false>(f, ahead))) {
    ++counts.filter;
  } else {
    ++counts.exact;
    ahead = exact_next(f, all_);
  }
  if (ahead.kind == Ahead::Kind::none) ahead.duration = 0.0;
}

}  // namespace carom
