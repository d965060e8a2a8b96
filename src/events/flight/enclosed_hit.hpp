// Flights in a convex table without obstacles, and from cell to cell among discs: the frequent
// cases, in which signs alone name the wall.
#pragma once

#include <cmath>

#include "events/flight/crossing.hpp"
#include "events/flight/enclosure.hpp"
#include "events/flight/next_hit.hpp"

namespace carom::events {

namespace detail {

/// One fraction for b <= 0, another for b > 0, chosen without a branch; and its inverse.
[[gnu::always_inline]] inline base::Pair quotients(double b, base::Pair falling,
                                                   base::Pair rising) {
  const base::Pair p = base::both(b) <= 0.0 ? falling : rising;
  return p / base::Pair{p[1], p[0]};
}

/// Squares below this lose digits, and the root of b^2 is not |b|: for the general formulas.
inline constexpr double least_square = 0x1p-900;

}  // namespace detail

/// Without field.
[[gnu::always_inline]] inline bool HitFinder::line_in_enclosure(const Flight& f,
                                                                Ahead& ahead) const {
  const double bound = norm_1(f.velocity) * t_.side_bound;
  if (t_.enclosure.meets_all()) {
    double duration;
    const int wall = t_.enclosure.exit_of_line(f.start, f.velocity, bound, duration);
    if (wall < 0 || wall == t_.enclosure.size() || !put(wall, duration, ahead)) return false;
    ahead.kappa = kappa_of_line(f, wall);
    return true;
  }
  int wall = 0;
  if (t_.enclosure.size() > 1) {
    wall = t_.enclosure.exit_of_line(f.start, f.velocity, bound);
    if (wall < 0) return false;
    if (wall == t_.enclosure.size()) {  // all joints on one side: through the arc that it is on
      wall = f.start_piece;
      if (wall < 0 || !t_.enclosure.bent(wall)) return false;
    }
  }
  return line_to(f, wall, ahead);
}

/// A hit on a wall. False: too short a way for doubles.
[[gnu::always_inline]] inline bool HitFinder::put(int wall, double duration, Ahead& ahead) {
  if (!(duration > 0.0 && duration < HUGE_VAL)) return false;
  ahead.kind = Ahead::Kind::wall;
  ahead.piece = wall;
  ahead.root = 0;
  ahead.duration = duration;
  return true;
}

/// Kappa of a hit on a segment.
[[gnu::always_inline]] inline double HitFinder::kappa_of_line(const Flight& f, int wall) const {
  const geometry::PreparedCurve& w = t_.curves[static_cast<std::size_t>(wall)];
  return -geometry::fused_cross(w.tangent, f.velocity) /
         geometry::fused_cross(w.tangent, f.start - w.from);
}

/// The hit of a line on the wall that it leaves through; of conics those about the domain.
[[gnu::always_inline]] inline bool HitFinder::line_to(const Flight& f, int wall,
                                                      Ahead& ahead) const {
  using geometry::Vector;
  const Vector v = f.velocity, origin = f.start;
  const geometry::PreparedCurve& w = t_.curves[static_cast<std::size_t>(wall)];
  base::Pair found;  // duration and kappa
  if (w.kind == geometry::CurveKind::segment) {
    const base::Pair p{geometry::fused_cross(w.tangent, origin - w.from),
                       -geometry::fused_cross(w.tangent, v)};
    found = p / base::Pair{p[1], p[0]};
  } else {
    // A conic about the domain: all signs turned.
    const bool on_wall = wall == f.start_piece;
    geometry::Quadratic<double> q;
    if (w.kind == geometry::CurveKind::circle) {
      q = geometry::circle_quadratic(origin - w.centre, w.r2, v, f.square_speed);
      if (on_wall) q.a = 0.0;
    } else {
      q = ellipse_quadratic(w, origin - w.centre, v, on_wall);
    }
    const double n = std::fabs(q.b) + (on_wall ? std::fabs(q.b) : std::sqrt(discriminant_of(q)));
    found = detail::quotients(-q.b, base::Pair{-q.a, n}, base::Pair{n, q.c});
  }
  ahead.kappa = found[1];
  return put(wall, found[0], ahead);
}

/// A Larmor circle against segments and circular arcs.
[[gnu::always_inline]] inline bool HitFinder::circle_in_enclosure(const Flight& f,
                                                                  Ahead& ahead) const {
  using geometry::Vector;
  const Vector v = f.velocity, origin = f.start;
  int wall = f.start_piece;
  if (wall < 0) return false;
  if (t_.enclosure.size() > 1) {
    const geometry::CentreError error = geometry::centre_error(
        {f.start_error, norm_1(v), std::fabs(f.omega), t_.options.filter_inflation},
        t_.enclosure.diameter());
    const Enclosure::Order order =
        t_.enclosure.exits_of_circle(wall, origin, v, f.omega, f.square_speed, error);
    if (!order.decided) return false;
    for (std::uint64_t walls = order.walls;;) {
      const int first = t_.enclosure.first_of(walls, wall, f.omega);
      if (first == t_.enclosure.size()) break;  // comes back to the wall it started on
      if ((order.surely >> first & 1) != 0) {
        wall = first;
        break;
      }
      const Flight copy = f;  // or the flight would live in memory
      const Sign leaves = t_.crossed_twice(copy, first, t_.origin_of(copy, 0));
      if (leaves == Sign::undecided) return false;
      if (leaves == Sign::positive) {
        wall = first;
        break;
      }
      walls &= ~(std::uint64_t{1} << first);
    }
  }
  const geometry::PreparedCurve& w = t_.curves[static_cast<std::size_t>(wall)];
  const bool on_wall = wall == f.start_piece;
  geometry::Quadratic<double> q;
  if (w.kind == geometry::CurveKind::segment) {
    const Vector d = origin - w.from;
    const base::Pair e = base::keep_if(!on_wall, base::Pair{d.x, d.y});
    q = geometry::line_quadratic(Vector{e[0], e[1]}, w.tangent, v, f.omega, 0.5);
  } else {
    q = -circle_quadratic<true>(w, origin - w.centre, v, f.square_speed, f.omega, on_wall);
  }
  if (!on_wall && w.kind == geometry::CurveKind::segment) {
    // Twice the rounding of lengths exceeds 8u of them.
    const double bound =
        t_.options.filter_inflation * (1.42 * f.start_error + 2.0 * t_.enclosure_rounding);
    if (!(std::fabs(q.a) > bound)) [[unlikely]]
      return false;
  } else {
    const geometry::FlightScale scale{f.start_error, norm_1(v), std::fabs(f.omega),
                                      t_.options.filter_inflation};
    if (on_wall ? !(q.b > 0.0)
                : !far_root_certain(q, quadratic_error(w, origin, scale, false), false))
        [[unlikely]]
      return false;
  }
  const double discriminant = discriminant_of(q);
  const double n = std::fabs(q.b) + std::sqrt(discriminant > 0.0 ? discriminant : 0.0);
  const double kappa = detail::quotients(q.b, base::Pair{n, q.a}, base::Pair{-q.c, n})[0];
  if (!(n * n > detail::least_square) || !(std::fabs(kappa) < HUGE_VAL)) return false;
  ahead.kind = Ahead::Kind::wall;
  ahead.piece = wall;
  ahead.root = 0;
  ahead.kappa = kappa;
  ahead.duration = duration_at(kappa, f.omega);
  return true;
}

/// The disc that a line meets. Undecided: the bounds do not tell, or it meets two.
[[gnu::always_inline]] inline Sign HitFinder::meets_one_disc(const Flight& f, const Origin& o,
                                                             int& met, Quotient& at) const {
  Sign meets = Sign::negative;
  for (const int disc : t_.discs) {
    if (disc == f.start_piece) continue;  // a line leaves a disc for good
    const geometry::PreparedCurve& w = *t_.data[static_cast<std::size_t>(disc)].shape;
    const geometry::Vector e = o.point - w.centre;
    const geometry::Quadratic<double> q =
        geometry::circle_quadratic(e, w.r2, f.velocity, f.square_speed);
    const double discriminant = discriminant_of(q);
    const geometry::QuadraticError error =
        geometry::circle_error(o.scale, norm_1(e), w.centre_error, w.r2);
    const double margin = geometry::discriminant_error(q, error);
    // Outside the disc, as the particle is, the line's crossings are ahead exactly when b < 0.
    if ((q.b < 0.0) & (discriminant > 0.0)) {
      if (!((q.b < -error.b) & (discriminant > margin))) return Sign::undecided;
      if (meets == Sign::positive) return Sign::undecided;  // two: by comparing them
      meets = Sign::positive;
      met = disc;
      at = {q.a, std::sqrt(discriminant) - q.b};
    } else if (!((q.b > error.b) | (discriminant < -margin))) {
      return Sign::undecided;
    }
  }
  return meets;
}

/// A line leaves a convex region once: between a joint on its right and the next one on its left,
/// or, with all joints on one side, through the arc that it is on. -1: not decided.
[[gnu::always_inline]] inline int HitFinder::exit_of_enclosure(const Flight& f,
                                                               const Origin& o) const {
  const Enclosure& loop = t_.enclosure;
  if (loop.size() == 1) return t_.enclosure_first;
  const double bound = 0.5 * side_error(o.scale, t_.reach + norm_1(o.point));
  const int exit = loop.exit_of_line(o.point, f.velocity, bound);
  if (exit < 0) return -1;
  if (exit < loop.size()) return t_.enclosure_first + exit;
  const int start = f.start_piece - t_.enclosure_first;
  return start >= 0 && start < loop.size() && loop.bent(start) ? f.start_piece : -1;
}

/// The same on any piece, at a fraction of time.
[[gnu::always_inline]] inline bool HitFinder::put(int piece, Ahead::Kind kind, const Quotient& at,
                                                  Ahead& ahead) {
  if (!put(piece, at.time / at.unit, ahead)) return false;
  ahead.kappa = at.unit / at.time;
  ahead.kind = kind;
  return true;
}

/// From cell to cell: nothing is asked of an edge but that the line leaves through it.
[[gnu::always_inline]] inline bool HitFinder::over_edges(Flight& f, Ahead& ahead,
                                                         DecisionCounts& counts) const {
  constexpr int most_edges = 16;
  for (int edges = 0; edges < most_edges; ++edges) {
    const Origin o = t_.origin_of(f, 0);
    int piece = -1;
    Quotient at{0.0, 1.0};
    const Sign disc = meets_one_disc(f, o, piece, at);
    if (disc == Sign::undecided) return false;
    if (disc == Sign::positive) {
      if (!put(piece, Ahead::Kind::wall, at, ahead)) return false;
      ++counts.filter;
      return true;
    }
    piece = exit_of_enclosure(f, o);
    if (piece < 0) return false;
    ++counts.filter;
    t_.cross_edge(f, piece);
    f.start_piece = -1;  // its disc is in the cell behind
  }
  return false;
}

[[gnu::always_inline]] inline bool HitFinder::next_in_convex(const Flight& f, Ahead& ahead,
                                                             DecisionCounts& counts) const {
  if (!t_.convex || f.start_previous >= 0) [[unlikely]]
    return false;  // from a joint: by algebra
  const bool found = f.omega == 0.0 ? line_in_enclosure(f, ahead)
                                    : t_.without_ellipses && circle_in_enclosure(f, ahead);
  if (found) ++counts.filter;
  return found;
}

[[gnu::always_inline]] inline bool HitFinder::next_in_four(const Flight& f, Ahead& ahead,
                                                           DecisionCounts& counts) const {
  double duration;
  const double bound = norm_1(f.velocity) * t_.side_bound;
  const int wall = t_.enclosure.exit_of_four(f.start, f.velocity, bound, duration);
  if (wall < 0 || wall == t_.enclosure.size() || !put(wall, duration, ahead)) return false;
  ++counts.filter;
  return true;
}

[[gnu::always_inline]] inline void HitFinder::next(const Flight& flight, Ahead& ahead,
                                                   DecisionCounts& counts) {
  if (!next_in_convex(flight, ahead, counts)) next_in_any(flight, ahead, counts);
}

}  // namespace carom::events
