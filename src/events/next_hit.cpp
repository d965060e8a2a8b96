#include "events/next_hit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "carom/base/elementary.hpp"
#include "carom/base/error.hpp"
#include "events/bounded.hpp"
#include "events/crossing.hpp"

namespace carom {

using namespace geometry;

namespace {

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

double kappa_after(double duration, double omega) {
  if (omega == 0.0) return 1.0 / duration;
  const double h = 0.5 * omega;
  const auto [s, c] = elementary::sincos(h * duration);
  return h * c / s;
}

ExactFlight HitFinder::exact_flight(const Flight& f) const {
  return ExactFlight(*exact_, f.wall, f.u, f.start, f.velocity, f.omega);
}

void HitFinder::look_at_cells(const Flight& f) const {
  const double speed_1 = norm_1(f.velocity), omega = std::fabs(f.omega);
  const Lattice& l = *table_.lattice;
  for (std::size_t k = 0; k < offsets_.size(); ++k) {
    const Cell c{f.cell.first + offsets_[k].first, f.cell.second + offsets_[k].second};
    const Vector by = l.translation(c);
    Origin& o = origins_[k];
    o.point.x = f.start.x - by.x;
    o.point.y = f.start.y - by.y;
    // Two products and a sum for the translation, one difference.
    const double m = std::fabs(static_cast<double>(c.first)), n = std::fabs(static_cast<double>(c.second));
    const double size = m * norm_1(l.first) + n * norm_1(l.second);
    const double rounding = unit_roundoff * (2.1 * size + norm_1(o.point));
    o.scale.delta = c == Cell{} ? f.start_error : f.start_error + rounding;
    o.scale.speed_1 = speed_1;
    o.scale.omega = omega;
    o.scale.inflation = options_.filter_inflation;
  }
}

HitFinder::Candidate HitFinder::candidate(const Flight& f, int piece, bool stands) const {
  const PieceData& p = data_[at(piece)];
  const PreparedCurve& w = curves_[at(p.curve)];
  const Origin& origin = origins_[at(p.offset)];
  Candidate c;
  c.quadratic = f.omega == 0.0 ? quadratic<false>(w, origin.point, f.velocity, f.square_speed, 0.0, stands)
                               : quadratic<true>(w, origin.point, f.velocity, f.square_speed, f.omega, stands);
  c.error = quadratic_error(w, origin.point, origin.scale, stands);
  c.root = rising_root(c.quadratic);
  if (stands && f.omega != 0.0) c.root.kappa = -c.quadratic.c / (2.0 * c.quadratic.b);
  return c;
}

namespace {

/// Does the flight to kappa end on the ellipse to half of the digits? e: its start seen from the centre. Where roots of the
/// quartic cannot be told apart an interval may hold one root and be of no use as a number.
bool ends_on_ellipse(const PreparedCurve& w, Vector e, Vector v, double omega, double kappa) {
  const Vector d = e + displacement(flight_factors(kappa, omega, 0.5), v);
  const geometry::OnEllipse<double> on = geometry::on_ellipse(d, w.first_axis, w.second_axis);
  constexpr double of_measure = 0.75;  // on the ellipse
  return std::fabs(on.measure - of_measure) <= 0x1p-26 * norm_1(on.gradient) * (norm_1(e) + norm_1(d));
}

}  // namespace

Sign HitFinder::quartic_candidate(const Flight& f, int piece, bool stands, double inflation,
                                  Candidate& c) const {
  const PieceData& p = data_[at(piece)];
  const PreparedCurve& w = curves_[at(p.curve)];
  FlightScale s = origins_[at(p.offset)].scale;
  s.inflation = inflation;
  const Vector origin = origins_[at(p.offset)].point;
  const Vector e = origin - w.centre, j = right(f.velocity);
  const Vector em{dot(w.first_axis, e), dot(w.second_axis, e)};
  const Vector vm{dot(w.first_axis, f.velocity), dot(w.second_axis, f.velocity)};
  const Vector jm{dot(w.first_axis, j), dot(w.second_axis, j)};
  const double row = std::max(norm_1(w.first_axis), norm_1(w.second_axis));
  Quartic<double> q = ellipse_quartic(em, stands ? dot(em, em) : 1.0, vm, jm, f.omega, 0.5);
  if (w.orientation > 0)
    for (double& x : q.q) x = -x;
  const RisingRoots found =
      rising_roots(q, quartic_error(s, norm_1(e), w.centre_error, row, stands), stands ? 3 : 4,
                   std::max(0.5 * s.omega, row * s.speed_1), w.closed ? 1 : 4);
  for (int i = 0; i < found.count; ++i) {
    c.root.kappa = found.roots[i].kappa;
    c.kappa_error = found.roots[i].error;
    const Sign on = w.closed ? Sign::positive : on_part(f, piece, c, inflation);
    if (on == Sign::positive && !ends_on_ellipse(w, e, f.velocity, f.omega, c.root.kappa)) return Sign::undecided;
    if (on != Sign::negative) return on;
  }
  return found.decided ? Sign::negative : Sign::undecided;
}

/// Is the crossing of a conic, with its error known, on the arc's side of its chord?
Sign HitFinder::on_part(const Flight& f, int piece, const Candidate& c, double inflation) const {
  const PieceData& p = data_[at(piece)];
  const PreparedCurve& w = curves_[at(p.curve)];
  FlightScale s = origins_[at(p.offset)].scale;
  s.inflation = inflation;
  return side_of_chord(w, origins_[at(p.offset)].point, f.velocity, f.omega, c.root.kappa, c.kappa_error, s).sign();
}

namespace {

/// Without field: certain that no flight from here leaves through the arc when both its joints lie on one
/// side. The foot of the centre on the line is the middle of its chord in the circle: if both crossings lay
/// on the arc, so would the foot lie on the arc's side of the chord of its joints.
[[gnu::always_inline]] inline bool foot_off_arc(const PreparedCurve& w, Vector origin, Vector v,
                                                const FlightScale& s) {
  const Bounded foot = foot_beyond_chord(w, origin, v, s);
  return foot.value > foot.bound;
}

}  // namespace

/// Both joints of an arc lie on one side: does the flight leave through it all the same?
Sign HitFinder::crossed_twice(const Flight& f, int piece) const {
  if (!cells_) look_from(f);
  Candidate c = candidate(f, piece, false);
  const Sign cut = sign_within(c.root.discriminant, discriminant_error(c.quadratic, c.error));
  if (cut != Sign::positive) return cut;
  c.kappa_error = kappa_error(c.quadratic, c.error, c.root);
  return on_part(f, piece, c, options_.filter_inflation);
}

namespace {

/// Is the foot of the Larmor circle's centre on a segment's line between its ends?
[[gnu::always_inline]] inline Sign foot_between(const PreparedCurve& w, Vector origin, Vector v, double omega,
                                                const FlightScale& s) {
  const Feet feet = feet_of_centre(w, origin, v, omega, s);
  if ((feet.first < -feet.bound) | (feet.last < -feet.bound)) return Sign::negative;
  return (feet.first > feet.bound) & (feet.last > feet.bound) ? Sign::positive : Sign::undecided;
}

/// Without field: is the rising crossing ahead (kappa > 0)?
Sign ahead_of_start(const Quadratic<double>& q, const QuadraticError& e) {
  // A line's constant coefficient is exactly zero: its other crossing, at kappa = 0, is never reached.
  if (q.b > e.b) return q.c == 0.0 && e.c == 0.0 ? Sign::negative : -sign_within(q.c, e.c);
  if (q.b < -e.b) return sign_within(q.a, e.a);
  if (q.a > e.a && q.c < -e.c) return Sign::positive;
  if (q.a < -e.a && q.c > e.c) return Sign::negative;
  return Sign::undecided;
}

}  // namespace

double HitFinder::kappa_error_of(const Flight& f, int piece) const {
  if (!cells_) look_from(f);
  const bool stands = stands_on(f, piece);
  Candidate c;
  if (is_quartic(f, piece))
    return quartic_candidate(f, piece, stands, options_.filter_inflation, c) == Sign::positive ? c.kappa_error
                                                                                               : HUGE_VAL;
  c = candidate(f, piece, stands);
  return kappa_error(c.quadratic, c.error, c.root);
}

template <bool larmor, bool cells, bool listed>
bool HitFinder::filtered_of(const Flight& f, Ahead& ahead, std::span<const int> list, double& found_error) const {
  if (f.start_previous >= 0) return false;  // from a joint: by algebra
  const Vector v = f.velocity;
  const double omega = larmor ? f.omega : 0.0;
  const int start = f.start_piece;
  // Without a lattice there is one origin: kept in registers.
  const Origin single{f.start, {f.start_error, norm_1(v), std::fabs(omega), options_.filter_inflation}};
  const auto origin_of = [&](const PieceData& p) -> const Origin& { return cells ? origins_[at(p.offset)] : single; };

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
  const auto error_of = [&](int piece, const Quadratic<double>& f2, const Root& r, double kappa, double time) {
    const PieceData& p = data_[at(piece)];
    const Origin& origin = origin_of(p);
    if (!larmor && p.kind == CurveKind::segment)
          return straight_line_error(*p.shape, origin.point, origin.scale, kappa, time);
    return kappa_error(f2, quadratic_error(*p.shape, origin.point, origin.scale, piece == start),
                       {r.discriminant, r.root, kappa});
  };
  double best_time = 0.0, best_unit = 1.0;     // without field: kappa = unit / time, divided only if needed
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
    // At most two crossings: the joints' sides tell. (A Larmor circle may cross an ellipse four times.)
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
        if (!larmor && p.kind == CurveKind::circle && foot_off_arc(w, origin.point, v, origin.scale)) continue;
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
      const Sign leaves = quartic_candidate(f, piece, stands, options_.filter_inflation, c);
      if (leaves == Sign::undecided) return false;
      if (leaves != Sign::positive) continue;
      kappa = c.root.kappa;
      error = c.kappa_error;
    } else if (!larmor && w.kind == CurveKind::segment) {
      const Vector e = origin.point - w.from;
      const double a = geometry::cross(w.tangent, e);
      const double bound = line_error(origin.scale, norm_1(e)).a;
      if (a < -bound) continue;  // behind
      if (!(a > bound)) return false;
      time = a;
      unit = -geometry::cross(w.tangent, v);
    } else {
      // Standing on the wall, without field: the other crossing of the circle lies ahead exactly when the
      // particle is inside it.
      if (!larmor && stands && w.orientation < 0) continue;
      q = quadratic<larmor>(w, origin.point, v, f.square_speed, omega, stands);
      root = stands ? Root{q.b * q.b, std::fabs(q.b), larmor ? -q.c / (2.0 * q.b) : 0.0} : rising_root(q);
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
      // Two questions, so that the processor need not wait for the errors to go on with the first wall.
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
  // Bounds are allowed to change where a quartic's root is looked for, not the number that is found.
  if (larmor && best >= 0 && options_.filter_inflation != 1.0 && is_quartic(f, best)) {
    Candidate c;
    if (quartic_candidate(f, best, best == start, 1.0, c) != Sign::positive) return false;
    best_kappa = c.root.kappa;
  }
  ahead.piece = best;
  ahead.root = 0;
  ahead.kappa = larmor ? best_kappa : best_unit / best_time;
  ahead.duration = larmor ? duration_at(best_kappa, f.omega) : best_time / best_unit;
  ahead.kind = best < 0 ? Ahead::Kind::none : data_[at(best)].edge ? Ahead::Kind::edge : Ahead::Kind::wall;
  if constexpr (listed) {
    if (best >= 0 && best_error < 0) best_error = error_of(best, best_q, best_root, ahead.kappa, best_time);
    found_error = best_error;
  }
  return true;
}
template bool HitFinder::filtered_of<false, false, true>(const Flight&, Ahead&, std::span<const int>, double&) const;
template bool HitFinder::filtered_of<false, true, true>(const Flight&, Ahead&, std::span<const int>, double&) const;
template bool HitFinder::filtered_of<true, false, true>(const Flight&, Ahead&, std::span<const int>, double&) const;
template bool HitFinder::filtered_of<true, true, true>(const Flight&, Ahead&, std::span<const int>, double&) const;

Ahead HitFinder::exact_next(const Flight& f, const std::vector<int>& pieces) const {
  look_from(f);
  const ExactFlight::First first =
      exact_flight(f).first(pieces, f.cell, f.entry, f.start_piece, f.start_previous);
  Ahead ahead;
  ahead.piece = first.piece;
  ahead.root = first.root;
  switch (first.kind) {
    case ExactFlight::First::Kind::none: return ahead;
    case ExactFlight::First::Kind::joint: ahead.kind = Ahead::Kind::joint; break;
    case ExactFlight::First::Kind::cusp: ahead.kind = Ahead::Kind::cusp; break;
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
    const bool same = quartic_candidate(f, ahead.piece, stands_on(f, ahead.piece), 1.0, c) == Sign::positive;
    ahead.kappa = same ? c.root.kappa : first.kappa;
  } else {
    const Candidate c = candidate(f, ahead.piece, stands_on(f, ahead.piece));
    ahead.kappa = c.root.kappa;
    if (f.omega == 0.0) {
      const Quotient quotient = straight_time(c.quadratic, c.root.root);
      ahead.duration = quotient.time / quotient.unit;
    }
    // A flight along a wall to the last digit, or of no length: the formula in doubles may have lost the sign, and in a
    // field a full turn with it. Else its number is good enough, if cancelled: a root that errs much belongs to a graze
    // or to a start beside the wall, and the place of the hit to few ulps either way, as tables have no flat arcs. It must
    // be the filter's number, as results do not depend on the stage; so this question does not on the inflation.
    const PieceData& p = data_[at(ahead.piece)];
    FlightScale scale = origins_[at(p.offset)].scale;
    scale.inflation = 1.0;
    const bool stands = stands_on(f, ahead.piece);
    const QuadraticError error = quadratic_error(*p.shape, origins_[at(p.offset)].point, scale, stands);
    const bool lost = f.omega == 0.0 ? !(ahead.duration > 0.0) || !std::isfinite(ahead.duration)
                                     : !std::isfinite(ahead.kappa) || !far_root_certain(c.quadratic, error, stands);
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
